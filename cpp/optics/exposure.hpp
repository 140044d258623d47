#pragma once
#include <cmath>
#include <numbers>

#include "lens_path.hpp"

namespace REALCAM_NAMESPACE {

/// Irradiance in the middle of the film for unit radiance: the area, in direction cosines, that passes the lens there,
/// pi sin^2(theta') less what is blocked in the middle. By real rays in the meridional plane; the iris counts as round.
inline double axis_irradiance(LensSystem lens) {
    constexpr int kRays = 4096, kBlock = 64;
    lens.iris.blades = 0;
    const LensPath<double> path(lens, LightDirection::to_scene, lens.wavelength_nm);
    const Surface& last = lens.surfaces.back();
    const double n = path.entry_index, rim = last.clear_semi_diameter;
    // The steepest ray that can meet the last surface; its rim may bulge towards the film.
    const double behind = lens.film_distance - std::max(last.sag(rim), 0.0);
    const double widest = behind > 0 ? n * std::sin(std::atan(1.02 * rim / behind)) : n;
    double area = 0;
    for (int first = 0; first < kRays; first += kBlock) {
        LensRays<double, kBlock> rays;
        for (int i = 0; i < kBlock; ++i) {
            const double sine = widest * (first + i + 0.5) / kRays;
            rays.origin.set(i, {0, 0, lens.film_distance});
            rays.direction.set(i, {sine, 0, -std::sqrt(n * n - sine * sine)});
            rays.status[i] = 0;
        }
        trace_lens(path.view(), rays);
        for (int i = 0; i < kBlock; ++i)
            if (rays.status[i] == 0) area += 2 * std::numbers::pi * widest * widest * (first + i + 0.5) / kRays / kRays;
    }
    return area;
}

}  // namespace REALCAM_NAMESPACE
