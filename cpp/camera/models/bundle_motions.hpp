#pragma once
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "../../optics/pupil/pupil_tracer.hpp"
#include "../film/camera.hpp"
#include "bundle_motion_view.hpp"

namespace REALCAM_NAMESPACE {

/// Motions of the bundles of a calibrated camera's lens, for its film, focus and camera model. Owns the memory of its
/// view.
class BundleMotions {
public:
    /// `camera`: has a geometry; `view`: its view without motions; `tracer`: has the parallel loop. Throws InputError
    /// if the geometry differs from that of the lens by more than kMaxAngle.
    BundleMotions(const Camera& camera, const CameraView& view, const PupilTracer& tracer);

    BundleMotionsView view() const;

    /// Largest angle by which a bundle may be rotated, degrees. Beyond it a bundle no longer resembles one that a lens
    /// with this geometry could have.
    static constexpr double kMaxAngle = 45;

private:
    BundleMotionsView view_{};  ///< without pointers
    std::vector<BundleMotion> nodes_;
    std::vector<LandingDerivatives> derivatives_;
    std::vector<Vec2f> positions_;
    std::shared_ptr<const CalibratedGeometry> geometry_;  ///< owns the mask
};

/// Film point, mm in the lens's axes, at which a calibrated camera images a point, by iteration. `point`: in the axes
/// of the camera, metres from the centre of the unshifted film; or, if `is_direction`, the unit vector towards a point
/// at infinity. `lens_film_point(point)`: the same for the lens without a calibration, as a std::optional.
template <class LensFilmPoint>
std::optional<Vec2<double>> calibrated_film_point(const BundleMotionsView& view, Vec3d point, bool is_direction,
                                                  LensFilmPoint&& lens_film_point) {
    constexpr int kMaxIterations = 20;
    constexpr double kPrecision_mm = 1e-7;
    const auto in_float = [](Vec2<double> film) {
        return Vec2f{static_cast<float>(film.x), static_cast<float>(film.y)};
    };
    const Vec3d towards = is_direction ? point : normalized(point - static_cast<Vec3d>(view.centre));
    const Vec2f start = film_point_seeing(view, static_cast<Vec3f>(towards));
    Vec2<double> film = {static_cast<double>(start.x), static_cast<double>(start.y)};
    for (int i = 0; i < kMaxIterations; ++i) {
        const BundleMotion motion = bundle_motion(view, in_float(film));
        const std::optional<Vec2<double>> landing = lens_film_point(
            is_direction ? rotated(-motion.rotation(), point) : point_before_motion(view, motion, point));
        if (!landing) return std::nullopt;
        const Vec2<double> off = {landing->x - film.x, landing->y - film.y};
        const Vec2f shift = landing_derivatives(view, in_float(film)).of(in_float(off));
        film = {film.x + static_cast<double>(shift.x), film.y + static_cast<double>(shift.y)};
        if (std::fabs(off.x) + std::fabs(off.y) < kPrecision_mm) break;
    }
    return film;
}

}  // namespace REALCAM_NAMESPACE
