#pragma once
#include <cmath>
#include <limits>

#include "../optics/lens_path.hpp"
#include "../optics/lens_trace.hpp"

namespace REALCAM_NAMESPACE {

/// Angle to the axis, in front of the lens, of the light that lands `image_height_mm` from the middle of the film,
/// radians: the mean direction of the real rays in the meridional plane. NaN where no ray from there passes the lens.
inline double field_angle(const LensSystem& lens, double image_height_mm) {
    constexpr int kRays = 512;
    const LensPath<double> path(lens, LightDirection::to_scene, lens.wavelength_nm);
    const double rim = lens.surfaces.back().clear_semi_diameter;
    LensRays<double, kRays> rays;
    for (int i = 0; i < kRays; ++i) {
        const Vec3d origin{image_height_mm, 0, lens.film_distance};
        const Vec3d target{rim * ((2 * i + 1.0) / kRays - 1), 0, 0};
        rays.origin.set(i, origin);
        rays.direction.set(i, normalized(target - origin));
        rays.status[i] = 0;
    }
    trace_lens(path.view(), rays);
    double sum = 0;
    int passed = 0;
    for (int i = 0; i < kRays; ++i) {
        if (rays.status[i] != 0) continue;
        sum += std::atan2(-rays.direction.x[i], -rays.direction.z[i]);
        ++passed;
    }
    return passed > 0 ? std::fabs(sum / passed) : std::numeric_limits<double>::quiet_NaN();
}

/// The same at the height nearest below it that gets light: a film may be larger than the lens's image.
inline double widest_field_angle(const LensSystem& lens, double image_height_mm) {
    for (int i = 0; i < 50; ++i) {
        const double angle = field_angle(lens, image_height_mm * (1 - 0.02 * i));
        if (std::isfinite(angle)) return angle;
    }
    return 0;
}

}  // namespace REALCAM_NAMESPACE
