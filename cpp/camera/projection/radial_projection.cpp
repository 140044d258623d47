#include "radial_projection.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <set>
#include <utility>

#include "../../math/hypotenuse.hpp"
#include "../../math/local_cubic.hpp"
#include "../../optics/analysis/film_bundle.hpp"
#include "../../optics/lens/chief_ray.hpp"
#include "../camera_setup.hpp"
#include "../models/generate_rays.hpp"
#include "centroid_ray.hpp"

namespace realcam {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Centroid ray of a film radius, and its image radius: the film radius that is the centroid of the light of the ray's
/// point in focus. Radii are in steps.
struct TracedRay {
    MeridionalRay ray;
    double image_radius;
};

/// Cubic interpolation between the rays of those steps that have been traced.
class RayInterpolation {
public:
    explicit RayInterpolation(const std::vector<std::optional<TracedRay>>& steps) {
        for (std::size_t k = 0; k < steps.size(); ++k) {
            if (!steps[k]) continue;
            radii_.push_back(static_cast<double>(k));
            light_.push_back(steps[k]->ray.light);
            const double image_radius = steps[k]->image_radius;
            if (!std::isfinite(image_radius) || (!image_radii_.empty() && !(image_radius > image_radii_.back())))
                continue;
            image_radii_.push_back(image_radius);
            rays_.push_back(steps[k]->ray);
        }
    }

    /// Ray with this image radius; its light is NaN.
    MeridionalRay ray_imaged_at(double radius) const {
        const std::optional<LocalCubic> cubic = LocalCubic::at(image_radii_, radius);
        if (!cubic) return {kNaN, kNaN, kNaN, kNaN};
        return {cubic->odd([&](std::size_t i) { return rays_[i].angle; }),
                cubic->odd([&](std::size_t i) { return rays_[i].offset; }),
                cubic->even([&](std::size_t i) { return rays_[i].start; }), kNaN};
    }

    /// Light of the ray of a film radius.
    double light_at(double radius) const {
        if (!radii_.empty() && radius == radii_.back()) return light_.back();
        const std::optional<LocalCubic> cubic = LocalCubic::at(radii_, radius);
        return cubic ? cubic->even([&](std::size_t i) { return light_[i]; }) : kNaN;
    }

private:
    std::vector<double> radii_, light_;
    std::vector<double> image_radii_;  ///< strictly increasing
    std::vector<MeridionalRay> rays_;
};

}  // namespace

RadialProjection::RadialProjection(const CameraSetup& setup, ProjectionRay ray, const RayLoop& loop)
    : rays_(kSteps + 1) {
    const Camera& camera = setup.camera();
    const LensSystem& lens = camera.lens;
    const FirstOrder data = first_order(lens, lens.wavelength_nm);
    const double pupil = data.entrance_pupil_position;
    vertex_ = std::fabs(pupil) < kFarPupil_mm ? pupil : 0;
    reference_ = lens.film_position() - vertex_;
    focus_ = lens.focus_distance - reference_;
    const CameraView view = setup.view(camera.pose.position_m);
    // Margin that keeps the film's corners inside despite rounding.
    max_radius_ = camera.film.radius_mm() * (1 + 1e-7);
    if (has_real_pupil(camera.model)) {
        const auto image_radius = static_cast<double>(view.pupil.image_radius);
        ends_in_film_ = image_radius < max_radius_;
        if (ends_in_film_) max_radius_ = (1 - 1e-4) * image_radius;  // at the very edge the bundle has no width
        if (camera.ray_pairs && ray == ProjectionRay::chief)
            throw InputError("the rays of lens \"" + lens.name + "\" were measured: the chief ray is not among them");
        trace_centroid_rays(CentroidRays(with_round_stop(lens), focus_, view.polynomial), view.pupil, loop);
        if (ray == ProjectionRay::chief) trace_chief_rays(with_round_stop(lens));
    } else {
        const double image_distance = camera_detail::ideal_lens_of(lens, data).image_distance;
        for (int k = 0; k <= kSteps; ++k) set_ideal_ray(k, view, {pupil, image_distance});
    }
    discard_rays_turning_inwards();
    const double centre_light = rays_[0].light > 0 ? rays_[0].light : rays_[1].light;
    for (MeridionalRay& traced : rays_) traced.light /= centre_light;
    angle_ = curve_of(&MeridionalRay::angle, true);
    offset_ = curve_of(&MeridionalRay::offset);
    for (const MeridionalRay& traced : rays_) {
        cosines_.push_back(std::cos(traced.angle));
        sines_.push_back(std::sin(traced.angle));
    }
}

std::optional<FilmProjection> RadialProjection::ray(Vec2<double> film) const {
    const auto [x, y] = film;
    const double radius = hypotenuse(x, y);
    if (!(radius <= max_radius_)) return std::nullopt;
    const std::optional<MeridionalRay> ray = at(radius);
    if (!ray) return std::nullopt;
    const double c = radius > 0 ? sign_ * x / radius : 1, s = radius > 0 ? sign_ * y / radius : 0;
    const double cosine = std::cos(ray->angle), sine = std::sin(ray->angle);
    const double away = ray->offset * cosine + ray->start * sine;
    const double ahead = reference_ + ray->start * cosine - ray->offset * sine;
    return FilmProjection{{c * away, s * away, -ahead}, {c * sine, s * sine, -cosine}, ray->light};
}

std::optional<Vec2<double>> RadialProjection::project(Vec3d point) const {
    const double away = hypotenuse(point.x, point.y);
    const std::optional<double> radius = film_radius_of({away, -point.z - reference_});
    if (!radius) return std::nullopt;
    const double scale = away > 0 ? sign_ * *radius / away : 0;
    return Vec2<double>{scale * point.x, scale * point.y};
}

std::optional<MeridionalRay> RadialProjection::at(double film_radius) const {
    const double step = film_radius / max_radius_ * kSteps;
    const auto k = static_cast<std::size_t>(std::min(static_cast<int>(step), kSteps - 1));
    const double fraction = step - static_cast<double>(k), angle = angle_.at(step).value;
    if (!std::isfinite(angle)) return std::nullopt;
    const MeridionalRay &a = rays_[k], &b = rays_[k + 1];
    return MeridionalRay{angle, offset_.at(step).value, a.start + fraction * (b.start - a.start),
                         a.light + fraction * (b.light - a.light)};
}

std::optional<double> RadialProjection::film_radius_of(MeridionalPoint point) const {
    if (point.away == 0 && point.ahead > rays_[0].start) return 0.0;
    double before = point.away;
    for (int k = 1; k <= kSteps; ++k) {
        const auto i = static_cast<std::size_t>(k);
        // Signed distance of the point from the ray of step k; it changes its sign between the rays around the point.
        const double here = point.away * cosines_[i] - point.ahead * sines_[i] - offset_[k];
        if (before > 0 && here <= 0 && point.away * sines_[i] + point.ahead * cosines_[i] > rays_[i].start)
            return max_radius_ / kSteps * (k - 1 + fraction_through(k - 1, point));
        before = here;
    }
    return std::nullopt;
}

OddCurve RadialProjection::curve_of(double MeridionalRay::* value, bool rises) const {
    std::vector<double> values;
    for (const MeridionalRay& ray : rays_) values.push_back(ray.*value);
    return OddCurve(std::move(values), rises);
}

void RadialProjection::set_ray(int k, const std::optional<SceneRay>& ray, double light) {
    MeridionalRay& stored = rays_[static_cast<std::size_t>(k)];
    stored = {kNaN, kNaN, kNaN, light};
    if (!ray) return;
    const double away = -ray->origin.y, ahead = vertex_ - ray->origin.z;
    stored.angle = k == 0 ? 0 : std::atan2(-ray->direction.y, -ray->direction.z);
    const double cosine = std::cos(stored.angle), sine = std::sin(stored.angle);
    stored.offset = k == 0 ? 0 : away * cosine - ahead * sine;
    stored.start = away * sine + ahead * cosine;
}

void RadialProjection::trace_centroid_rays(const CentroidRays& centroid_rays, const PupilView& pupil,
                                           const RayLoop& loop) {
    // Adaptive refinement: the step halfway between two known ones is traced, too. If the cubics through the known
    // steps predict its ray, cubics that include it are some ten times more accurate, and the interval is not refined
    // further.
    constexpr int kWidestStep = 16;  // interval between the steps that are traced first
    constexpr double kPrecision = 5e-6;  // rad; relative to the film's radius or to the light
    std::vector<std::optional<TracedRay>> traced(rays_.size());
    const auto is_predicted = [&](const RayInterpolation& known, int k) {
        const auto& [ray, image_radius] = *traced[static_cast<std::size_t>(k)];
        const MeridionalRay predicted = known.ray_imaged_at(image_radius);
        const double light = known.light_at(k);
        return std::fabs(predicted.angle - ray.angle) < kPrecision &&
               std::fabs(predicted.offset - ray.offset) < kPrecision * max_radius_ &&
               std::fabs(light - ray.light) < kPrecision * ray.light;
    };
    std::set<int> pending;
    for (int k = 0; k <= kSteps; k += kWidestStep) pending.insert(k);
    for (int step = kWidestStep; !pending.empty(); step /= 2) {
        const RayInterpolation known(traced);
        const std::vector<int> steps(pending.begin(), pending.end());
        loop.for_all(steps.size(), [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) {
                const std::optional<CentroidRay> ray =
                    centroid_rays.centroid_ray(centroid_rays.bundle(pupil, radius_of(steps[i])));
                set_ray(steps[i], ray ? std::optional(ray->ray) : std::nullopt, ray ? ray->light : 0);
                const auto k = static_cast<std::size_t>(steps[i]);
                traced[k] = {rays_[k], k == 0 ? 0 : ray ? ray->light_centroid.y * kSteps / max_radius_ : kNaN};
            }
        });
        pending.clear();
        if (step == 1) break;
        for (const int k : steps) {
            if (is_predicted(known, k)) continue;
            for (const int halves : {-3, -1, 1, 3}) {  // a cubic also depends on the neighbouring intervals
                const int neighbour = k + halves * step / 2;
                if (neighbour > 0 && neighbour < kSteps && !traced[static_cast<std::size_t>(neighbour)])
                    pending.insert(neighbour);
            }
        }
    }
    const RayInterpolation known(traced);
    for (int k = 1; k <= kSteps; ++k) {
        MeridionalRay& ray = rays_[static_cast<std::size_t>(k)];
        ray = known.ray_imaged_at(k);
        ray.light = known.light_at(k);
    }
}

void RadialProjection::trace_chief_rays(const LensSystem& lens) {
    const RaysFromFilm from_film(lens, lens.wavelength_nm);
    MeridionalChiefRays chief_rays(from_film);
    for (int k = 0; k <= kSteps; ++k) {
        const std::optional<ChiefRay> ray = chief_rays.next(radius_of(k));
        set_ray(k, ray ? std::optional(SceneRay{ray->scene, -ray->scene_direction}) : std::nullopt,
                rays_[static_cast<std::size_t>(k)].light);
    }
}

void RadialProjection::set_ideal_ray(int k, const CameraView& view, ThinLensPosition thin) {
    const Vec2f film = {0, static_cast<float>(radius_of(k))}, middle = {0, 0};
    if (view.model == CameraModel::thick_lens) {
        const LensFrameRay ray = thick_lens_ray(view, film, middle);
        set_ray(k, SceneRay{static_cast<Vec3d>(ray.origin_mm), normalized(static_cast<Vec3d>(ray.direction))},
                static_cast<double>(ray.weight));
        return;
    }
    double radius = radius_of(k), light = std::pow(1 + std::pow(radius / thin.image_distance, 2), -2);
    if (view.model == CameraModel::mapped_lens) {
        const LensMapNode map = lens_map_at(view.map, film);
        radius *= static_cast<double>(map.scale);
        light = static_cast<double>(map.light);
    }
    const SceneRay ray = {{0, 0, thin.position}, normalized(Vec3d{0, -radius / thin.image_distance, -1})};
    set_ray(k, light > 0 ? std::optional(ray) : std::nullopt, light);
}

void RadialProjection::discard_rays_turning_inwards() {
    const auto first =
        std::find_if(rays_.begin() + 1, rays_.end(), [](const MeridionalRay& ray) { return std::isfinite(ray.angle); });
    sign_ = first != rays_.end() && (first->angle < 0 || (first->angle == 0 && first->offset < 0)) ? -1 : 1;
    for (MeridionalRay& ray : rays_) ray = {sign_ * ray.angle, sign_ * ray.offset, ray.start, ray.light};
    const double distance = std::min(focus_, 1e9);
    for (std::size_t k = 1; k < rays_.size(); ++k) {
        const MeridionalRay& ray = rays_[k - 1];
        const double cosine = std::cos(ray.angle), sine = std::sin(ray.angle);
        const MeridionalPoint point = {ray.offset * cosine + distance * sine, distance * cosine - ray.offset * sine};
        const double distance_from_ray = point.away * std::cos(rays_[k].angle) - point.ahead * std::sin(rays_[k].angle);
        if (!(distance_from_ray >= rays_[k].offset)) continue;
        for (; k < rays_.size(); ++k) rays_[k].angle = rays_[k].offset = rays_[k].start = kNaN;
        ends_in_film_ = true;
    }
}

double RadialProjection::fraction_through(int k, MeridionalPoint point) const {
    double low = 0, high = 1, share = 0.5;
    for (int i = 0; i < 60 && high - low > 1e-15; ++i) {
        const OddCurve::Point angle = angle_.between(k, share), offset = offset_.between(k, share);
        const double cosine = std::cos(angle.value), sine = std::sin(angle.value);
        const double distance_from_ray = point.away * cosine - point.ahead * sine - offset.value;
        (distance_from_ray > 0 ? low : high) = share;
        const double slope = -(point.away * sine + point.ahead * cosine) * angle.slope - offset.slope;
        const double next = share - distance_from_ray / slope;
        if (std::fabs(next - share) < 1e-14) return next;
        share = next > low && next < high ? next : 0.5 * (low + high);
    }
    return share;
}

}  // namespace realcam
