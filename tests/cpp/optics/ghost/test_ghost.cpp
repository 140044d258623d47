// Ghosts: against unfolded lenses and against real rays. tests/truth compares them with published figures.

#include "optics/ghost/ghost.hpp"

#include <algorithm>
#include <cmath>

#include "about.hpp"
#include "doctest/doctest.h"
#include "measurement.hpp"
#include "traced_ray.hpp"

using namespace realcam;
using namespace realcam::test;

TEST_CASE("a ghost is the image of a lens whose reflecting surfaces are mirrors") {
    // The light's way through the double Gauss written out: forward to the first mirror, back to the second, forward.
    const LensSystem lens = io::read_lens("double-gauss-50mm");
    const int count = static_cast<int>(lens.surfaces.size());
    for (int first = 1; first < count; ++first)
        for (int second = 0; second < first; ++second) {
            const auto surface = [&](int i) { return lens.surfaces[static_cast<std::size_t>(i)]; };
            if (surface(first).type == SurfaceType::stop || surface(second).type == SurfaceType::stop) continue;
            LensSystem unfolded;
            for (int i = 0; i < count; ++i) {
                Surface s = surface(i);
                if (i != first) {
                    unfolded.surfaces.push_back(s);
                    continue;
                }
                s.type = SurfaceType::mirror;
                for (int k = first; k > second; --k) {
                    s.thickness = -surface(k - 1).thickness;
                    unfolded.surfaces.push_back(s);
                    s = surface(k - 1);
                    // For reversed light, the medium behind the surface is the one in front of it.
                    s.material = k - 1 > 0 ? surface(k - 2).material : Glass::air();
                    if (k - 1 > 0 && surface(k - 2).type == SurfaceType::stop) s.material = Glass::air();
                }
                s.type = SurfaceType::mirror;
                s.thickness = surface(second).thickness;
                unfolded.surfaces.push_back(s);
                for (int k = second + 1; k <= first; ++k) unfolded.surfaces.push_back(surface(k));
            }
            for (Surface& s : unfolded.surfaces)
                if (s.type == SurfaceType::stop) s.type = SurfaceType::aperture;
            unfolded.surfaces.insert(unfolded.surfaces.begin(), stop_plane(0, 1));
            unfolded.stop_semi_diameter = 1;
            CAPTURE(first);
            CAPTURE(second);
            const FirstOrder data = first_order(unfolded, kLineD_nm);
            const GhostPath ghost = ghost_path(lens, kLineD_nm, {first, second});
            CHECK(ghost.effective_focal_length == about(data.effective_focal_length, 1e-11));
            CHECK(ghost.back_focal_distance == about(data.back_focal_distance, 1e-11));
        }
}

TEST_CASE("real rays near the axis make every ghost where first order puts it, and as large") {
    double worst = 0;
    int count = 0;
    for (const char* name : {"double-gauss-50mm", "phone-4mm", "telephoto-200mm-inner-focus", "fisheye-10mm"}) {
        const LensSystem lens = io::read_lens(name), with_film = with_film_mirror(lens, 1, 100);
        std::vector<GhostPair> pairs = ghost_pairs(lens);
        for (const GhostPair pair : film_ghost_pairs(lens)) pairs.push_back(pair);
        for (const GhostPair pair : pairs) {
            const LensPath<double> path(with_film, crossings_of(lens, pair), LightDirection::to_film,
                                        lens.wavelength_nm);
            const GhostPath ghost = ghost_path(lens, lens.wavelength_nm, pair);
            const double f = ghost.effective_focal_length, focus = ghost.back_focal_distance;
            // So near to the axis that the third order is less than 1e-6 of the first, also in a fisheye, whose ghosts
            // go through it at angles that are ten thousand times as large.
            const double height = 1e-6 * std::fabs(f) / (1 + std::fabs(f)), slope = 1e-7 / (1 + std::fabs(f));
            LensRays<double, 2> rays;
            rays.origin.set(0, {height, 0, -1});
            rays.direction.set(0, {0, 0, 1});
            rays.origin.set(1, {-slope, 0, -1});
            rays.direction.set(1, normalized(Vec3d{slope, 0, 1}));
            rays.status[0] = rays.status[1] = 0;
            trace_lens(path.view(), rays);
            REQUIRE(rays.status[0] == 0);
            REQUIRE(rays.status[1] == 0);
            const auto slope_of = [&](int i) { return rays.direction[i].x / rays.direction[i].z; };
            const auto at_focus = [&](int i) { return rays.origin[i].x + (focus - rays.origin[i].z) * slope_of(i); };
            // The bundle's size, by the angle at which it closes; where it closes; where that of another direction
            // does.
            const double reach = height * (1 + std::fabs(focus / f));
            worst = std::max({worst, std::fabs(slope_of(0) * f / height + 1), std::fabs(at_focus(0)) / reach,
                              std::fabs(at_focus(1) / (slope * f) - 1)});
            ++count;
        }
    }
    hold({"Effects", "place and size of ghosts by real rays near the axis", "against first order, 4 lenses, all pairs",
          "core", "float64", worst, 1e-6, ""});
    CHECK(count > 300);
}
