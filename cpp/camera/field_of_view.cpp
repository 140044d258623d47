#include "field_of_view.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include "../optics/trace/lens_path.hpp"
#include "../optics/trace/lens_trace.hpp"

namespace realcam {

namespace {

/// Meridional rays of one film point, aimed at fractions of the last surface's semi-diameter.
class MeridionalRays {
public:
    MeridionalRays(const LensSystem& lens, double image_height_mm)
        : path_(lens, LightDirection::to_scene, lens.wavelength_nm),
          origin_{image_height_mm, 0, lens.film_distance},
          rim_(lens.surfaces.back().clear_semi_diameter) {
        const LensView<double> view = path_.view();
        to_stop_.assign(view.surfaces, view.surfaces + (view.count - lens.stop_index()));
        to_stop_.back().rim_squared = std::numeric_limits<double>::max();
        to_stop_.back().has_blades = false;
    }

    template <int N>
    LensRays<double, N> trace(const double (&shares)[N], bool only_to_stop) const {
        LensView<double> view = path_.view();
        if (only_to_stop) {
            view.surfaces = to_stop_.data();
            view.count = static_cast<int>(to_stop_.size());
        }
        LensRays<double, N> rays;
        for (int i = 0; i < N; ++i) {
            rays.origin.set(i, origin_);
            rays.direction.set(i, path_.entry_index * normalized(Vec3d{rim_ * shares[i], 0, 0} - origin_));
            rays.status[i] = 0;
        }
        trace_lens(view, rays);
        return rays;
    }

private:
    LensPath<double> path_;
    Vec3d origin_;
    double rim_;
    std::vector<SurfaceView<double>> to_stop_;
};

double angle_of(Vec3d direction) {
    return std::atan2(-direction.x, -direction.z);
}

}  // namespace

double field_angle(const LensSystem& lens, double image_height_mm) {
    constexpr int kRays = 512, kFew = 8, kHalvings = 60;
    const MeridionalRays meridian(lens, image_height_mm);
    double shares[kRays];
    for (int i = 0; i < kRays; ++i) shares[i] = (2 * i + 1.0) / kRays - 1;
    const LensRays<double, kRays> rays = meridian.trace(shares, false);
    double sum = 0;
    int passed = 0;
    for (int i = 0; i < kRays; ++i) {
        if (rays.status[i] != 0) continue;
        sum += angle_of(rays.direction[i]);
        ++passed;
    }
    if (passed >= kFew) return std::fabs(sum / passed);
    const LensRays<double, kRays> at_stop = meridian.trace(shares, true);
    for (int i = 1; i < kRays; ++i) {
        const bool above = at_stop.origin.x[i] > 0;
        if (at_stop.status[i - 1] != 0 || at_stop.status[i] != 0 || (at_stop.origin.x[i - 1] > 0) == above) continue;
        double low = shares[i - 1], high = shares[i];
        for (int k = 0; k < kHalvings; ++k) {
            const double middle[1] = {0.5 * (low + high)};
            const LensRays<double, 1> ray = meridian.trace(middle, true);
            ((ray.origin.x[0] > 0) == above ? high : low) = middle[0];
        }
        const double middle[1] = {high};
        const LensRays<double, 1> chief = meridian.trace(middle, false);
        if (chief.status[0] == 0) return std::fabs(angle_of(chief.direction[0]));
    }
    return passed > 0 ? std::fabs(sum / passed) : std::numeric_limits<double>::quiet_NaN();
}

double widest_field_angle(const LensSystem& lens, double image_height_mm) {
    for (int i = 0; i < 50; ++i) {
        const double angle = field_angle(lens, image_height_mm * (1 - 0.02 * i));
        if (std::isfinite(angle)) return angle;
    }
    return 0;
}

}  // namespace realcam
