// The sampled region of directions: it holds every ray that passes, little else, and is sampled evenly.

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "about.hpp"
#include "doctest/doctest.h"
#include "optics/centred_lenses.hpp"
#include "pupil_region.hpp"

namespace {

using namespace realcam;
using namespace realcam::test;

struct Leak {
    long passing = 0, outside = 0;
    double worst_radius = 0;
};

// Random directions to the whole last surface, and more of them around the region itself (stopped down it is
// a thousandth of the surface): which of those that pass lie outside the region?
Leak find_leaks(const LensSystem& lens, const Pupil& pupil, unsigned seed) {
    constexpr int kRadii = 18, kRays = 2048;
    const FilmPointTracer trace(lens);
    Random random(seed);
    Leak leak;
    std::vector<Vec3f> directions(kRays);
    for (int k = 0; k < kRadii; ++k) {
        // From the axis to past the corner of the film; the table's own rows lie elsewhere.
        double radius = half_diagonal(lens) * (k == 0 ? 0.0 : k == 1 ? 1.0 : random());
        if (k >= 12) radius = pupil.image_radius() * (1 - std::pow(10.0, 8.0 - k));  // towards the edge of the image
        if (k == 17) radius = pupil.image_radius() * 1.002;
        if (radius > half_diagonal(lens)) continue;
        const PupilRegion region(pupil.view(), radius);
        const Vec3d film{radius, 0, lens.film_position()};
        for (int i = 0; i < kRays; ++i) {
            Vec3d d = normalized(point_on_last_surface(lens, random) - film);
            if (i % 4 != 0) {
                d.x = region.centre + region.half_width * random.between(-1.3, 1.3);
                d.y = region.half_height * random.between(-1.3, 1.3);
                d.z = -std::sqrt(std::max(0.0, 1 - d.x * d.x - d.y * d.y));
                if (d.z == 0) d = {0, 0, -1};
            }
            directions[static_cast<std::size_t>(i)] = static_cast<Vec3f>(d);
        }
        trace(
            static_cast<float>(radius), 0, kRays, [&](int i) { return directions[static_cast<std::size_t>(i)]; },
            [&](int i, bool passes) {
                if (!passes) return;
                ++leak.passing;
                const Vec3f d = directions[static_cast<std::size_t>(i)];
                // 1e-5 of the box, from directions with 24 bits in boxes down to 0.01 wide.
                if (region.contains(static_cast<double>(d.x), static_cast<double>(d.y), 1e-5)) return;
                ++leak.outside;
                leak.worst_radius = radius;
            });
    }
    return leak;
}

void check_no_leaks(const LensState& state, const Pupil& pupil) {
    CAPTURE(state.description);
    const Leak leak = find_leaks(state.lens, pupil, 17);
    CAPTURE(leak.passing);
    CAPTURE(leak.worst_radius);
    // The mirror lens's hole is larger than its stop at f/22: it is dark.
    const bool dark = state.lens.name == "mirror-telephoto-500mm" && state.lens.stop_semi_diameter < 15;
    CHECK((dark ? leak.passing == 0 : leak.passing > 2000));
    CHECK(leak.outside == 0);
}

// Share of the sampled rays of a whole frame that pass.
double passing_share(const LensSystem& lens, const Pupil& pupil) {
    const FilmPointTracer trace(lens);
    Random random(23);
    long sampled = 0, passed = 0;
    constexpr int kSamples = 64;
    for (int k = 0; k < 400; ++k) {
        const Vec3f film = static_cast<Vec3f>(point_on_film(lens, random));
        std::vector<PupilSample> samples(kSamples);
        for (PupilSample& s : samples)
            s = sample_pupil(pupil.view(), film.x, film.y, static_cast<float>(random()), static_cast<float>(random()));
        if (!(samples[0].weight > 0)) continue;
        trace(
            film.x, film.y, kSamples, [&](int i) { return samples[static_cast<std::size_t>(i)].direction; },
            [&](int, bool passes) {
                ++sampled;
                passed += passes;
            });
    }
    REQUIRE(sampled > 10000);
    return static_cast<double>(passed) / static_cast<double>(sampled);
}

}  // namespace

TEST_CASE("no ray that passes lies outside the sampled region, and wide open at least 95% of the sampled rays pass") {
    for (const std::string& name : centred_lens_names())
        for (const LensState& state : states_of(name)) {
            const Pupil pupil(state.lens, half_diagonal(state.lens));
            check_no_leaks(state, pupil);
            CAPTURE(state.description);
            if (state.is_open) CHECK(passing_share(state.lens, pupil) >= 0.95);
        }
}

TEST_CASE("the same with blades, whose corners reach past the circle of their area") {
    for (const int blades : {3, 5, 9})
        for (const double f_number : {2.2, 2.8, 8.0}) {
            LensSystem lens = stopped_down(focused(io::read_lens("double-gauss-50mm"), kInfinity), f_number);
            lens.iris = {blades, 0, 0.35};
            const Pupil pupil(lens, half_diagonal(lens));
            check_no_leaks({lens, false, std::to_string(blades) + " blades at f/" + std::to_string(f_number)}, pupil);
        }
}

TEST_CASE("a pupil found near that of a similar state holds all that passes, and as little else" *
          doctest::test_suite("slow")) {
    int moved_pupils = 0;
    for (const std::string& name : centred_lens_names())
        for (LensState state : states_of(name)) {
            const double radius = half_diagonal(state.lens);
            const Pupil before(state.lens, radius);
            // A change of aperture and focus from one frame to the next.
            state.lens.stop_semi_diameter *= 0.99;
            state.lens.film_distance *= 1.0005;
            state.description += ", a little later";
            const Pupil pupil(state.lens, radius, {}, {}, &before);
            if (!pupil.was_found_near_similar()) continue;
            ++moved_pupils;
            CHECK(pupil.is_continuous());
            check_no_leaks(state, pupil);
            // It may keep the edge of the image where it was, by as much as the searches allow.
            const Pupil anew(state.lens, radius);
            CHECK(pupil.image_radius() == about(anew.image_radius(), 2e-4));
            if (state.is_open) CHECK(passing_share(state.lens, pupil) >= 0.95);
        }
    CHECK(moved_pupils >= 150);
}

TEST_CASE("a pupil that has changed much is the same as without the one before") {
    const LensSystem lens = focused(io::read_lens("double-gauss-50mm"), 4000);
    const Pupil before(lens, 21.6);
    const auto is_as_without = [&](const LensSystem& changed, double radius) {
        const Pupil pupil(changed, radius, {}, {}, &before), anew(changed, radius);
        const PupilView a = pupil.view(), b = anew.view();
        return !pupil.was_found_near_similar() && a.image_radius == b.image_radius &&
               std::equal(a.outline, a.outline + a.rows * PupilView::kSectors, b.outline,
                          [](const PupilSector& s, const PupilSector& t) {
                              return s.x == t.x && s.y == t.y && s.dx == t.dx && s.dy == t.dy &&
                                     s.hole_squared == t.hole_squared;
                          });
    };
    CHECK(is_as_without(stopped_down(lens, 8), 21.6));
    CHECK(is_as_without(focused(lens, 400), 21.6));
    CHECK(is_as_without(io::read_lens("fisheye-10mm"), 21.6));
    CHECK(is_as_without(lens, 20));
}

TEST_CASE("the lens ends the image, whatever the size of the film that it is on") {
    for (const char* name : {"eye-22mm", "fisheye-6mm-220deg", "phone-4mm", "phone-4mm-three-elements"}) {
        CAPTURE(name);
        LensSystem lens = io::read_lens(name);
        const double open = lens.stop_semi_diameter;
        for (const double share : {1.0, 0.1, 0.01, 0.001}) {
            CAPTURE(share);
            lens.stop_semi_diameter = share * open;
            const double edge = Pupil(lens, 21.6).image_radius();
            REQUIRE(edge < 21.6);
            // The search ends on the dark side, at relative steps of 1e-5.
            CHECK(Pupil(lens, 80).image_radius() == about(edge, 3e-5));
            CHECK(Pupil(lens, 1.2 * edge).image_radius() == about(edge, 3e-5));
        }
    }
}
