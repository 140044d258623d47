// Dispersion's tables: indices over the wavelength, the film's matrix, wavelengths by their density, the pupil.

#include <array>
#include <bit>
#include <cmath>
#include <string>
#include <utility>

#include "camera/effects/dispersion/dispersed_rays.hpp"
#include "camera/effects/dispersion/film_spectrum.hpp"
#include "doctest/doctest.h"
#include "io/lens/lens_file.hpp"
#include "io/lens/lens_text.hpp"
#include "measurement.hpp"
#include "optics/centred_lenses.hpp"
#include "optics/pupil/pupil.hpp"
#include "optics/trace/lens_dispersion.hpp"
#include "render/path/render_samples.hpp"

namespace {

using namespace realcam;
using namespace realcam::test;

DispersionView view_of(const FilmSpectrum& spectrum) {
    return {spectrum.cells().data(),
            static_cast<int>(spectrum.cells().size()),
            variable_over(spectrum.range()),
            nullptr,
            nullptr,
            nullptr,
            {}};
}

std::vector<IndexCubic> cubics_of(const LensSystem& lens, LightDirection direction, const FilmSpectrum& spectrum) {
    return index_cubics(lens, direction, spectrum.even_wavelengths(), variable_over(spectrum.range()));
}

/// Errors of index that the cubics of a lens leave, as an index of glass in air.
struct IndexErrors {
    double rms = 0;  ///< over the wavelengths of a picture's samples, of the worst surface; a share of n_F - n_C of
                     ///< the lens's strongest dispersion
    double worst = 0;
};

IndexErrors index_errors(const LensSystem& lens, const FilmSpectrum& spectrum) {
    const std::vector<IndexCubic> cubics = cubics_of(lens, LightDirection::to_film, spectrum);
    const DispersionView view = view_of(spectrum);
    constexpr int kSamples = 2000;
    std::vector<double> squares(cubics.size());
    IndexErrors errors;
    for (int i = 0; i < kSamples; ++i) {
        const float nm =
            wavelength_at(view, (static_cast<float>(i) + 0.5f) / kSamples * static_cast<float>(view.cell_count));
        const std::vector<double> n = lens.indices(static_cast<double>(nm));
        for (std::size_t k = 0; k < cubics.size(); ++k) {
            const double change = static_cast<double>(cubics[k].at(view.variable.at(nm)));
            const double error = n[k] * std::sqrt(1 + change) - n[k + 1];
            squares[k] += error * error / kSamples;
            errors.worst = std::max(errors.worst, std::fabs(error));
        }
    }
    const std::vector<double> blue = lens.indices(486.13), red = lens.indices(656.27);
    double dispersion = 0;
    for (std::size_t k = 0; k < blue.size(); ++k) dispersion = std::max(dispersion, std::fabs(blue[k] - red[k]));
    if (dispersion > 0) errors.rms = std::sqrt(*std::max_element(squares.begin(), squares.end())) / dispersion;
    return errors;
}

}  // namespace

TEST_CASE("cubics give the indices of all lenses") {
    IndexErrors worst;
    const FilmSpectrum spectrum(Illuminant::named("D65"));
    for (const std::string& name : centred_lens_names()) {
        const IndexErrors errors = index_errors(io::read_lens(name), spectrum);
        worst = {std::max(worst.rms, errors.rms), std::max(worst.worst, errors.worst)};
    }
    // An achromat's lateral colour is a twentieth of the dispersion of each of its glasses, and so correct to 2%.
    hold({"Effects", "dispersion from a cubic over the wavelength, rms",
          "all lenses, wavelengths as in a picture under D65", "core", "float32", worst.rms, 1e-3, ""});
    // The largest error is at the ends of the spectrum, where there is hardly any light.
    hold({"Effects", "index of refraction from a cubic over the wavelength", "the same", "core", "float32", worst.worst,
          1.5e-3, ""});
}

TEST_CASE("cubics of both directions are each other's inverse") {
    const LensSystem lens = io::read_lens("double-gauss-100mm");
    const FilmSpectrum spectrum(Illuminant::named("D65"));
    const auto film = cubics_of(lens, LightDirection::to_film, spectrum);
    const auto scene = cubics_of(lens, LightDirection::to_scene, spectrum);
    REQUIRE(film.size() == scene.size());
    for (std::size_t k = 0; k < film.size(); ++k)
        for (const float x : {-1.0f, -0.3f, 0.4f, 1.0f})
            CHECK(std::fabs((1 + film[k].at(x)) * (1 + scene[scene.size() - 1 - k].at(x)) - 1) < 3e-4f);
}

TEST_CASE("the film's matrix over all wavelengths is the identity for D65, and shows white as white for all") {
    for (const char* name :
         {"D65", "D50", "A", "FL2", "400:1,500:0.3,700:2", "380:1,780:1", "435:0,435.8:5,436.6:0,450:1,650:1"}) {
        CAPTURE(name);
        const FilmSpectrum spectrum(Illuminant::parse(name));
        double mean[9] = {};
        for (const WavelengthCell& cell : spectrum.cells()) {
            CHECK(cell.last_nm >= cell.first_nm);
            for (int k = 0; k < 9; ++k) mean[k] += static_cast<double>(cell.film[k]) / FilmSpectrum::kCells;
        }
        for (int row = 0; row < 3; ++row) {
            // The mean of 256 floats of up to 3, whose rounding errors add up to some 1e-7.
            CHECK(std::fabs(mean[3 * row] + mean[3 * row + 1] + mean[3 * row + 2] - 1) < 1e-6);
            if (std::string(name) == "D65")
                for (int column = 0; column < 3; ++column)
                    CHECK(std::fabs(mean[3 * row + column] - (row == column ? 1.0 : 0.0)) < 1e-6);
        }
    }
}

TEST_CASE("named illuminants have the chromaticities that CIE 15 prints") {
    struct White {
        const char* name;
        double x, y;
    };
    // To four digits, the fewest that are printed; sums of 5 nm are what CIE 15 takes.
    for (const White& white : {White{"D65", 0.3127, 0.3290}, White{"D50", 0.3457, 0.3585}, White{"A", 0.4476, 0.4074},
                               White{"FL2", 0.3721, 0.3751}}) {
        CAPTURE(white.name);
        const Illuminant light = Illuminant::named(white.name);
        double sum[3] = {};
        for (std::size_t i = 0; i < kObserverX.size(); ++i) {
            const double power = light.power(kFirstWavelength_nm + static_cast<double>(i) * kSpectrumStep_nm);
            sum[0] += power * kObserverX[i];
            sum[1] += power * kObserverY[i];
            sum[2] += power * kObserverZ[i];
        }
        const double all = sum[0] + sum[1] + sum[2];
        CHECK(std::fabs(sum[0] / all - white.x) < 1e-4);
        CHECK(std::fabs(sum[1] / all - white.y) < 1e-4);
    }
}

TEST_CASE("wavelengths rise with their places, and shared ones are the same from each of them") {
    const FilmSpectrum spectrum(Illuminant::named("D65"));
    const DispersionView view = view_of(spectrum);
    float last = 0;
    for (int i = 0; i < 4096; ++i) {
        const float place = (static_cast<float>(i) + 0.5f) / 4096 * static_cast<float>(view.cell_count);
        const float nm = wavelength_at(view, place);
        CHECK(nm > last);
        last = nm;
        const float next = shared_cell_position(view, place, 1), after = shared_cell_position(view, place, 2);
        CHECK(std::fabs(shared_cell_position(view, next, 1) - after) < 1e-4f);
        CHECK(std::fabs(shared_cell_position(view, after, 1) - place) < 1e-4f);
    }
    CHECK(last < 780);
}

TEST_CASE("three wavelengths that share a sample differ from white by what the density leaves") {
    const FilmSpectrum spectrum(Illuminant::named("D65"));
    const DispersionView view = view_of(spectrum);
    double squares[3] = {}, alone[3] = {};
    for (int cell = 0; cell < view.cell_count; ++cell) {
        const float place = static_cast<float>(cell) + 0.5f;
        const Color one = film_color(view, place, {1, 1, 1});
        Color three = {0, 0, 0};
        for (int step = 0; step < kSharedWavelengths; ++step)
            three += (1.0f / kSharedWavelengths) * film_color(view, shared_cell_position(view, place, step), {1, 1, 1});
        const double of_three[] = {static_cast<double>(three.r), static_cast<double>(three.g),
                                   static_cast<double>(three.b)};
        const double of_one[] = {static_cast<double>(one.r), static_cast<double>(one.g), static_cast<double>(one.b)};
        for (int c = 0; c < 3; ++c) {
            squares[c] += (of_three[c] - 1) * (of_three[c] - 1) / view.cell_count;
            alone[c] += (of_one[c] - 1) * (of_one[c] - 1) / view.cell_count;
        }
    }
    for (int c = 0; c < 3; ++c) {
        CHECK(std::sqrt(squares[c]) < 0.30);
        CHECK(std::sqrt(alone[c]) > 1.3);
    }
}

TEST_CASE("a sample's light is divided in equal parts among the pixels where its wavelengths end") {
    const FilmSpectrum spectrum(Illuminant::named("D65"));
    const DispersionView view = view_of(spectrum);
    constexpr Effects kDispersion = {.dispersion = true};
    const Color light = {0.3f, 2.0f, 0.7f};
    SampleWavelengths<1> of;
    of.cell_position[0] = 2.25f;
    // Which steps count, and where further ones do: in the own pixel, to the left, and below the latter.
    for (const auto& [shares, away] :
         {std::pair(1, std::array{0, 0}), std::pair(7, std::array{0, 0}), std::pair(5, std::array{0, -1}),
          std::pair(7, std::array{-1, 31}), std::pair(3, std::array{-1, 99})}) {
        of.shares[0] = shares;
        for (std::size_t further = 0; further < away.size(); ++further) of.away[further][0] = away[further];
        PathResultsWith<1, kDispersion> results;
        results.irradiance.set(0, light);
        count_wavelengths<false>(view, of, 0, results);
        Color own = {0, 0, 0};
        for (int step = 0; step < kSharedWavelengths; ++step) {
            const bool counts = (shares >> step & 1) != 0;
            const Color part = 1.0f / static_cast<float>(std::popcount(static_cast<unsigned>(shares))) *
                               film_color(view, shared_cell_position(view, of.cell_position[0], step), light);
            const int pixel = step > 0 ? of.away[step - 1][0] : 0;
            if (counts && pixel == 0) own += part;
            if (step == 0) continue;
            CHECK(results.shared.away[step - 1][0] == (counts ? pixel : 0));
            if (counts && pixel != 0) CHECK(results.shared.irradiance[step - 1][0] == part);
        }
        CHECK(std::fabs(results.irradiance[0].r - own.r) < 1e-6f);
        CHECK(std::fabs(results.irradiance[0].g - own.g) < 1e-6f);
        CHECK(std::fabs(results.irradiance[0].b - own.b) < 1e-6f);
    }
}

TEST_CASE("pixels share samples with those of their tile in a part of the film, and no others") {
    const SampleSharing sharing = {{5, 7, 70, 40}, 70};
    // Tiles of 32 pixels begin at the part's corner; the last ones are cut off at its edges.
    const auto both = [&](int column, int row, int other_column, int other_row) {
        const bool is_shared = sharing.has_both(column, row, other_column, other_row);
        CHECK(is_shared == sharing.has_both(other_column, other_row, column, row));
        return is_shared;
    };
    CHECK(both(5, 7, 36, 38));
    CHECK_FALSE(both(36, 7, 37, 7));
    CHECK_FALSE(both(5, 38, 5, 39));
    CHECK(both(69, 39, 74, 46));
    for (const auto& [column, row] : {std::pair(4, 7), std::pair(5, 6), std::pair(75, 7), std::pair(5, 47)})
        CHECK_FALSE(sharing.has_both(5, 7, column, row));
    CHECK_FALSE(SampleSharing{}.has_both(0, 0, 0, 0));
}

TEST_CASE("a line is one wavelength, and shows all colours in grey") {
    const FilmSpectrum spectrum(Illuminant::line(546.1));
    CHECK(std::fabs(wavelength_at(view_of(spectrum), 0.7f) - 546.1f) < 1e-4f);
    const Color film = film_color(view_of(spectrum), 0.7f, {0.2f, 0.9f, 0.4f});
    CHECK(film.r == film.g);
    CHECK(film.g == film.b);
}

TEST_CASE("the pupil of many wavelengths holds what passes at any of them") {
    const LensSystem lens = io::read_lens("sonnar-50mm");
    const std::vector<double> ends = {587.6, 400, 700};
    const Pupil pupil(lens, 20, {}, ends);
    for (const double nm : {400.0, 480.0, 587.6, 700.0}) {
        const LensPath<float> path(lens, LightDirection::to_scene, nm);
        int passed = 0, outside = 0;
        for (std::uint32_t i = 0; i < 20000; ++i) {
            const Vec2f film = sample_2d(1, i, 0), direction = sample_2d(2, i, 1);
            const float radius = 19.0f * film.x, l = 1.2f * direction.x - 0.6f, m = 0.8f * direction.y - 0.4f;
            LensRays<float, 1> ray;
            ray.origin.set(0, {radius, 0, static_cast<float>(lens.film_distance)});
            ray.direction.set(0, {l, m, -std::sqrt(1 - l * l - m * m)});
            ray.status[0] = 0;
            trace_lens(path.view(), ray);
            if (ray.status[0] != 0) continue;
            ++passed;
            outside += !(pupil_pdf(pupil.view(), radius, 0, l, m) > 0);
        }
        CAPTURE(nm);
        CHECK(passed > 1000);
        CHECK(outside <= passed / 1000);
    }
}
