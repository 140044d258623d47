#include "calibrated_projection.hpp"

#include <utility>

namespace realcam {
namespace {

/// Converts a film point between the axes of the developed picture and those of the lens, which inverts the picture.
Vec2<double> inverted(Vec2<double> film) {
    return {-film.x, -film.y};
}

Vec2f in_float(Vec2<double> film) {
    return {static_cast<float>(film.x), static_cast<float>(film.y)};
}

constexpr double kMmPerMetre = 1000;

}  // namespace

CalibratedProjection::CalibratedProjection(std::shared_ptr<const ProjectionRays> lens, BundleMotions motions)
    : lens_(std::move(lens)), motions_(std::move(motions)) {}

std::optional<FilmProjection> CalibratedProjection::ray(Vec2<double> film) const {
    const BundleMotionsView view = motions_.view();
    const Vec2f lens_film = in_float(inverted(film));
    const std::optional<FilmProjection> ray = lens_->ray(film);
    if (!ray || !is_defined(view, lens_film)) return std::nullopt;
    const BundleMotion motion = bundle_motion(view, lens_film);
    // Light is relative to that of the film's centre.
    const float central_gain = bundle_motion(view, {0, 0}).gain();
    return FilmProjection{kMmPerMetre * moved_point(view, motion, (1 / kMmPerMetre) * ray->origin),
                          rotated(motion.rotation(), ray->direction),
                          ray->light * static_cast<double>(motion.gain() / central_gain)};
}

std::optional<Vec2<double>> CalibratedProjection::project(Vec3d point) const {
    const BundleMotionsView view = motions_.view();
    constexpr bool kIsDirection = false;
    const std::optional<Vec2<double>> lens_film = calibrated_film_point(
        view, (1 / kMmPerMetre) * point, kIsDirection, [&](Vec3d moved) -> std::optional<Vec2<double>> {
            const std::optional<Vec2<double>> landing = lens_->project(kMmPerMetre * moved);
            if (!landing) return std::nullopt;
            return inverted(*landing);
        });
    if (!lens_film || !is_defined(view, in_float(*lens_film))) return std::nullopt;
    return inverted(*lens_film);
}

}  // namespace realcam
