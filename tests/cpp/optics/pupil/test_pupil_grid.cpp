// Pupil tables over both film coordinates. For a centred lens they agree with the radial table.

#include <cmath>
#include <string>

#include "doctest/doctest.h"
#include "math/random.hpp"
#include "optics/pupil/pupil_grid.hpp"
#include "pupil_region.hpp"

using namespace realcam;
using namespace realcam::test;

namespace {

constexpr int kGridSamples = 1 << 16;

struct GridCase {
    std::string lens;
    double f_number;  // 0: wide open
    MirrorPlanes planes;
    double least_passing;  // share of the samples
};

// The whole film without a symmetry, and with each. At f/16 the pupil is small beside the way that it moves.
const GridCase kCases[] = {{"double-gauss-50mm", 0, {}, 0.95},
                           {"double-gauss-50mm", 0, {true, false}, 0.95},
                           {"wide-24mm", 0, {true, true}, 0.95},
                           {"wide-24mm", 16, {false, true}, 0.95},
                           {"mirror-telephoto-500mm", 0, {true, true}, 0.95},
                           {"phone-4mm", 0, {true, true}, 0.95}};

struct Traced {
    double irradiance = 0;  // for a field of radiance 1, mean over the film
    int sampled = 0, passed = 0;
};

/// sample(x, y, u, v) for film points all over the film.
template <class Sample>
Traced trace_samples(const LensSystem& lens, Sample&& sample) {
    constexpr int kBlock = 256;
    const LensPath<float> path(lens, LightDirection::to_scene, lens.wavelength_nm);
    Traced traced;
    for (std::uint32_t first = 0; first < kGridSamples; first += kBlock) {
        LensRays<float, kBlock> rays;
        float weights[kBlock];
        for (int i = 0; i < kBlock; ++i) {
            const std::uint32_t number = first + static_cast<std::uint32_t>(i);
            const Vec2f film = sample_2d(5, number, 0), u = sample_2d(5, number, 1);
            const float x = (film.x - 0.5f) * static_cast<float>(lens.film_width);
            const float y = (film.y - 0.5f) * static_cast<float>(lens.film_height);
            const PupilSample drawn = sample(x, y, u.x, u.y);
            weights[i] = drawn.weight;
            rays.origin.set(i, {x, y, static_cast<float>(lens.film_distance)});
            rays.direction.set(i, drawn.direction);
            rays.status[i] = drawn.weight > 0 ? 0 : static_cast<int>(RayStatus::vignetted);
            traced.sampled += rays.status[i] == 0;
        }
        trace_lens(path.view(), rays);
        for (int i = 0; i < kBlock; ++i) {
            if (rays.status[i] != 0) continue;
            traced.irradiance += static_cast<double>(weights[i]) / kGridSamples;
            ++traced.passed;
        }
    }
    return traced;
}

LensSystem lens_in_state(const GridCase& state) {
    const LensSystem lens = io::read_lens(state.lens);
    return state.f_number > 0 ? stopped_down(lens, state.f_number) : lens;
}

FilmArea film_of(const LensSystem& lens) {
    return {{-0.5 * lens.film_width, -0.5 * lens.film_height}, {0.5 * lens.film_width, 0.5 * lens.film_height}};
}

}  // namespace

TEST_CASE("the pupil over the film gives the irradiance that the radial table gives, and most of its samples pass") {
    for (const GridCase& state : kCases) {
        CAPTURE(state.lens);
        CAPTURE(state.f_number);
        const LensSystem lens = lens_in_state(state);
        const PupilGrid grid(lens, film_of(lens), state.planes);
        REQUIRE(grid.is_lit());
        const Pupil rows(lens, half_diagonal(lens));
        const PupilGridView view = grid.view();
        const PupilView row_view = rows.view();
        const Traced by_place =
            trace_samples(lens, [&](float x, float y, float u, float v) { return sample_pupil(view, x, y, u, v); });
        const Traced by_radius =
            trace_samples(lens, [&](float x, float y, float u, float v) { return sample_pupil(row_view, x, y, u, v); });
        // A share p of samples of equal weight passes, with a deviation of sqrt((1 - p) / (p n)): 9e-4 at 95%. The
        // points are stratified, which only makes it less. Four of them, of both.
        CHECK(by_place.irradiance == doctest::Approx(by_radius.irradiance).epsilon(5e-3));
        CHECK(by_place.passed >= state.least_passing * by_place.sampled);
    }
}

TEST_CASE("no ray that passes lies outside the pupil over the film") {
    for (const GridCase& state : kCases) {
        CAPTURE(state.lens);
        const LensSystem lens = lens_in_state(state);
        const PupilGrid grid(lens, film_of(lens), state.planes);
        const PupilGridView view = grid.view();
        int strays = 0;
        // All over 1.6 boxes around the region.
        const Traced all = trace_samples(lens, [&](float x, float y, float u, float v) -> PupilSample {
            const PupilLookup place(view, x, y);
            const float l = place.at.frame.sign_l * (place.box.centre_l + 1.6f * (2 * u - 1) * place.box.half_width);
            const float m = place.at.frame.sign_m * (place.box.centre_m + 1.6f * (2 * v - 1) * place.box.half_height);
            const float rest = view.index_squared - l * l - m * m;
            // Those that the table holds are of no interest: left out here, the others alone are traced.
            if (rest <= 0 || pupil_pdf(view, x, y, l, m) > 0) return {{l, m, 0}, 0};
            return {{l, m, -std::sqrt(rest)}, 1};
        });
        strays = all.passed;
        // The table is made of 1e5 rays; slivers of 1e-4 of the region's area may fall between them.
        CHECK(strays <= 1e-4 * kGridSamples / (1.6 * 1.6));
        CHECK(all.sampled > kGridSamples / 4);
    }
}

TEST_CASE("the weight of a sample of the pupil over the film is one over its density") {
    for (const GridCase& state : kCases) {
        const LensSystem lens = lens_in_state(state);
        const PupilGrid grid(lens, film_of(lens), state.planes);
        const PupilGridView view = grid.view();
        int apart = 0;
        trace_samples(lens, [&](float x, float y, float u, float v) {
            const PupilSample drawn = sample_pupil(view, x, y, u, v);
            const float density = pupil_pdf(view, x, y, drawn.direction.x, drawn.direction.y);
            apart += std::fabs(density * drawn.weight - 1) > 1e-4f;
            return PupilSample{drawn.direction, 0};
        });
        // Rounding moves some of those on an edge between two sectors into the other one, or out.
        CHECK(apart <= 1e-4 * kGridSamples);
    }
}

TEST_CASE("a film that no light reaches has a pupil without weight") {
    LensSystem lens = io::read_lens("double-gauss-50mm");
    lens.stop_semi_diameter = 0;
    const PupilGrid grid(lens, film_of(lens));
    CHECK_FALSE(grid.is_lit());
    CHECK(sample_pupil(grid.view(), 3.0f, 2.0f, 0.3f, 0.6f).weight == 0.0f);
}
