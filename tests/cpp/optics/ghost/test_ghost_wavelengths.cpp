// Power of ghosts at one wavelength of a polychromatic picture, against a lens that is set up for that wavelength
// alone.

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "camera/effects/ghosts/ghost_tables.hpp"
#include "doctest/doctest.h"
#include "io/lens/lens_file.hpp"
#include "io/lens/lens_text.hpp"
#include "measurement.hpp"
#include "optics/centred_lenses.hpp"
#include "optics/coated_lens.hpp"
#include "optics/coating/coated_surface.hpp"
#include "optics/ghost/ghost_coatings.hpp"
#include "optics/prescription/coating.hpp"

namespace {

using namespace realcam;
using namespace realcam::test;

constexpr int kGhostRays = 16;
constexpr std::size_t kMostPairs = 10;  ///< largest number of ghost pairs per lens, a regular subsample

/// A slanted bundle in front of the lens, or behind it.
LensRays<float, kGhostRays> bundle(const LensSystem& lens, const LensPath<float>& path, LightDirection direction) {
    const bool to_film = direction == LightDirection::to_film;
    const Surface& first = to_film ? lens.surfaces.front() : lens.surfaces.back();
    const auto reach = static_cast<float>(0.5 * std::min(first.clear_semi_diameter, lens.stop_semi_diameter));
    LensRays<float, kGhostRays> rays;
    for (int i = 0; i < kGhostRays; ++i) {
        const float x = 0.5f * static_cast<float>(i % 4) - 0.75f, y = 0.5f * static_cast<float>(i / 4) - 0.75f;
        const auto index = static_cast<float>(path.entry_index);
        const Vec3f towards = normalized(Vec3f{0.02f, 0.05f, to_film ? 1.0f : -1.0f});
        rays.origin.set(i, {reach * x, reach * y, 0});
        rays.direction.set(i, index * towards);
        rays.status[i] = 0;
    }
    return rays;
}

/// Power summed over the rays that pass the lens in both traces: for many wavelengths, and for one.
struct Passed {
    double of_many = 0, of_one = 0;
};

/// Coatings and indices at each crossing that a ghost path may have, in a picture with these wavelengths.
template <int kTerms>
struct Crossings {
    std::vector<Crossing> all;
    std::vector<GhostCoating<kTerms>> coatings;
    std::vector<IndexCubic> indices;

    Crossings(const LensSystem& lens, WavelengthRange range, const std::vector<double>& fitted_nm)
        : all(ghost_tables_detail::all_crossings(lens)),
          coatings(ghost_coatings(lens, all, fit_coatings<kTerms>(lens, all, fitted_nm, variable_over(range)),
                                  fitted_nm, variable_over(range))),
          indices(index_cubics(lens, all, fitted_nm, variable_over(range))) {}

    /// Selects the values of one path's crossings, in the order of the path.
    template <class Value>
    static std::vector<Value> along(const std::vector<Crossing>& crossings, const std::vector<Value>& of_all) {
        std::vector<Value> met;
        for (const Crossing& crossing : crossings) met.push_back(of_all[ghost_tables_detail::crossing_index(crossing)]);
        return met;
    }
};

/// Traces ghost pairs in both directions and sums their power, for a picture with wavelengths from `range`, which
/// contains `wavelength_nm`, and for this wavelength alone. Returns std::nullopt if no light passes.
std::optional<Passed> ghosts_of(const LensSystem& lens, double wavelength_nm, WavelengthRange range,
                                const std::vector<double>& fitted_nm) {
    LensSystem made_for_it = lens;
    made_for_it.wavelength_nm = wavelength_nm;
    const Crossings<kGhostSpectrumTerms> many(lens, range, fitted_nm);
    const Crossings<kOneWavelengthTerms> one(made_for_it, {wavelength_nm, wavelength_nm}, {wavelength_nm});
    float variable[kGhostRays];
    for (float& of_ray : variable) of_ray = variable_over(range).at(static_cast<float>(wavelength_nm));
    Passed passed;
    const std::vector<GhostPair> pairs = ghost_pairs(lens);
    for (std::size_t k = 0; k < pairs.size(); k += 1 + pairs.size() / kMostPairs)
        for (const LightDirection direction : {LightDirection::to_film, LightDirection::to_scene}) {
            const std::vector<Crossing> way = crossings_of(lens, pairs[k]);
            const std::vector<Crossing> met = direction == LightDirection::to_film ? way : reversed(way);
            const auto indices = many.along(met, many.indices);
            const auto coatings = many.along(met, many.coatings);
            const auto coatings_of_one = one.along(met, one.coatings);
            const LensPath<float> path(lens, way, direction, lens.wavelength_nm);
            const LensPath<float> path_of_one(made_for_it, way, direction, wavelength_nm);
            LensRays<float, kGhostRays> rays = bundle(lens, path, direction);
            LensRays<float, kGhostRays> rays_of_one = bundle(lens, path_of_one, direction);
            PassedPower<kGhostRays> power, power_of_one;
            trace_lens(path.view(), rays, NoRecord{},
                       GhostMedia<kGhostSpectrumTerms, kGhostRays>{indices.data(), coatings.data(), variable, power});
            trace_lens(
                path_of_one.view(), rays_of_one, NoRecord{},
                GhostMedia<kOneWavelengthTerms, kGhostRays>{nullptr, coatings_of_one.data(), nullptr, power_of_one});
            for (int i = 0; i < kGhostRays; ++i) {
                if (rays.status[i] != 0 || rays_of_one.status[i] != 0) continue;
                passed.of_many += static_cast<double>(power.of_unpolarised(i));
                passed.of_one += static_cast<double>(power_of_one.of_unpolarised(i));
            }
        }
    return passed.of_one > 0 ? std::optional(passed) : std::nullopt;
}

bool knows_glasses_of(const LensSystem& lens, WavelengthRange range) {
    try {
        check_glasses_known(lens, range, "test");
    } catch (const InputError&) {
        return false;
    }
    return true;
}

}  // namespace

TEST_CASE("ghosts under a line of light are those of a lens made for it") {
    struct Case {
        const char* name;
        Coating coating;
        std::vector<double> wavelengths_nm;
    };
    // Bare faces know no wavelength but by the indices, which differ most at the end of the spectrum.
    for (const auto& [name, coating, wavelengths] :
         {Case{"bare", bare_surface(), {405}}, Case{"quarter-wave", *named_coating("quarter_wave"), {405, 470, 700}}}) {
        double worst = 0;
        int lenses = 0;
        for (const std::string& lens_name : centred_lens_names()) {
            const LensSystem lens = coated(io::read_lens(lens_name), coating);
            lenses += knows_glasses_of(lens, {405, 700});
            for (const double nm : wavelengths) {
                if (!knows_glasses_of(lens, {nm, nm})) continue;
                if (const auto passed = ghosts_of(lens, nm, {nm, nm}, {nm}))
                    worst = std::max(worst, std::fabs(passed->of_many / passed->of_one - 1));
            }
        }
        CHECK(lenses > 40);
        // Roundings of float: 1e-7 of what passes is 1e-5 of a reflected hundredth, at each of two reflections.
        hold({"Effects", std::string("light of all ghosts under a line, ") + name + " lenses",
              "all lenses, 405 to 700 nm, against the lens made for it", "core", "float32", worst, 2e-4, ""});
    }
}

TEST_CASE("ghosts in white light are at each wavelength those of a lens made for it") {
    const FilmSpectrum white{Illuminant()};
    // Relative to the mean over the wavelengths, which determines the picture.
    const auto worst_with = [&](const Coating& coating) {
        double worst = 0;
        for (const char* const name : {"achromat-75mm", "double-gauss-50mm", "phone-4mm"}) {
            const LensSystem lens = coated(io::read_lens(name), coating);
            double largest = 0, mean = 0;
            constexpr std::array kWavelengths_nm = {430.0, 480.0, 550.0, 610.0, 650.0};
            for (const double nm : kWavelengths_nm) {
                const auto passed = ghosts_of(lens, nm, white.range(), white.even_wavelengths());
                REQUIRE(passed);
                largest = std::max(largest, std::fabs(passed->of_many - passed->of_one));
                mean += passed->of_one / kWavelengths_nm.size();
            }
            worst = std::max(worst, largest / mean);
        }
        return worst;
    };
    hold({"Effects", "light of all ghosts in white light", "3 lenses, bare and quarter wave, 430 to 650 nm", "core",
          "float32", std::max(worst_with(bare_surface()), worst_with(*named_coating("quarter_wave"))), 1e-3, ""});
    // Light that was reflected twice at 0.7% each, which is right within 1e-4 of the light.
    hold({"Effects", "light of all ghosts in white light, three layers", "3 lenses, 430 to 650 nm", "core", "float32",
          worst_with(three_layers()), 0.03, ""});
}
