#include "radial_projection.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <utility>

#include "../../math/hypotenuse.hpp"
#include "../../math/local_cubic.hpp"
#include "../../optics/analysis/film_bundle.hpp"
#include "../../optics/lens/chief_ray.hpp"
#include "../camera_setup.hpp"
#include "../models/generate_rays.hpp"
#include "mean_ray.hpp"

namespace realcam {

namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// Projection ray of a film radius, and the film radius at which it is shown: the centroid of the light of the ray's
/// point in focus. Radii are in steps.
struct Seen {
    MeridionalRay line;
    double shown;
};

/// Projection rays at some of the steps, with cubic interpolation in between.
class KnownLines {
public:
    explicit KnownLines(const std::vector<std::optional<Seen>>& steps) {
        for (std::size_t k = 0; k < steps.size(); ++k) {
            if (!steps[k]) continue;
            radii_.push_back(static_cast<double>(k));
            light_.push_back(steps[k]->line.light);
            const double shown = steps[k]->shown;
            if (!std::isfinite(shown) || (!shown_.empty() && !(shown > shown_.back()))) continue;
            shown_.push_back(shown);
            lines_.push_back(steps[k]->line);
        }
    }

    /// Ray that is shown at a radius, without its light.
    MeridionalRay shown_at(double radius) const {
        const std::optional<LocalCubic> cubic = LocalCubic::at(shown_, radius);
        if (!cubic) return {kUnknown, kUnknown, kUnknown, kUnknown};
        return {cubic->odd([&](std::size_t i) { return lines_[i].angle; }),
                cubic->odd([&](std::size_t i) { return lines_[i].offset; }),
                cubic->even([&](std::size_t i) { return lines_[i].start; }), kUnknown};
    }

    double light_at(double radius) const {
        if (!radii_.empty() && radius == radii_.back()) return light_.back();
        const std::optional<LocalCubic> cubic = LocalCubic::at(radii_, radius);
        return cubic ? cubic->even([&](std::size_t i) { return light_[i]; }) : kUnknown;
    }

private:
    std::vector<double> radii_, light_;
    std::vector<double> shown_;  ///< strictly increasing
    std::vector<MeridionalRay> lines_;
};

}  // namespace

RadialProjection::RadialProjection(const CameraSetup& setup, ProjectionRay ray, const RayLoop& loop)
    : lines_(kSteps + 1) {
    const Camera& camera = setup.camera();
    const LensSystem& lens = camera.lens;
    const FirstOrder data = first_order(lens, lens.wavelength_nm);
    const double pupil = data.entrance_pupil_position;
    constexpr double kFar = 1e6;
    vertex_ = std::fabs(pupil) < kFar ? pupil : 0;
    reference_ = lens.film_position() - vertex_;
    focus_ = lens.focus_distance - reference_;
    const CameraView view = setup.view(camera.pose.position_m);
    // Margin that keeps the film's corners inside despite rounding.
    reach_ = camera.film.radius_mm() * (1 + 1e-7);
    if (has_real_pupil(camera.model)) {
        const auto lit = static_cast<double>(view.pupil.image_radius);
        ends_in_film_ = lit < reach_;
        if (ends_in_film_) reach_ = (1 - 1e-4) * lit;  // at the very edge the bundle has no width
        follow_light(with_round_stop(lens), view.pupil, loop);
        if (ray == ProjectionRay::chief) follow_chief_rays(with_round_stop(lens), view.pupil);
    } else {
        const double image_distance = camera_detail::ideal_lens_of(lens, data).image_distance;
        for (int k = 0; k <= kSteps; ++k) set_ideal(k, view, {pupil, image_distance});
    }
    end_where_lines_turn_back();
    const double middle = lines_[0].light > 0 ? lines_[0].light : lines_[1].light;
    for (MeridionalRay& line : lines_) line.light /= middle;
    angle_ = curve_of(&MeridionalRay::angle, true);
    offset_ = curve_of(&MeridionalRay::offset);
    for (const MeridionalRay& line : lines_) {
        cosines_.push_back(std::cos(line.angle));
        sines_.push_back(std::sin(line.angle));
    }
}

std::optional<FilmProjection> RadialProjection::ray(Vec2<double> film) const {
    const auto [x, y] = film;
    const double radius = hypotenuse(x, y);
    if (!(radius <= reach_)) return std::nullopt;
    const std::optional<MeridionalRay> line = at(radius);
    if (!line) return std::nullopt;
    const double c = radius > 0 ? sign_ * x / radius : 1, s = radius > 0 ? sign_ * y / radius : 0;
    const double cosine = std::cos(line->angle), sine = std::sin(line->angle);
    const double away = line->offset * cosine + line->start * sine;
    const double ahead = reference_ + line->start * cosine - line->offset * sine;
    return FilmProjection{{c * away, s * away, -ahead}, {c * sine, s * sine, -cosine}, line->light};
}

std::optional<Vec2<double>> RadialProjection::project(Vec3d point) const {
    const double away = hypotenuse(point.x, point.y);
    const std::optional<double> radius = radius_towards({away, -point.z - reference_});
    if (!radius) return std::nullopt;
    const double share = away > 0 ? sign_ * *radius / away : 0;
    return Vec2<double>{share * point.x, share * point.y};
}

std::optional<MeridionalRay> RadialProjection::at(double film_radius) const {
    const double step = film_radius / reach_ * kSteps;
    const auto k = static_cast<std::size_t>(std::min(static_cast<int>(step), kSteps - 1));
    const double share = step - static_cast<double>(k), angle = angle_.at(step).value;
    if (!std::isfinite(angle)) return std::nullopt;
    const MeridionalRay &a = lines_[k], &b = lines_[k + 1];
    return MeridionalRay{angle, offset_.at(step).value, a.start + share * (b.start - a.start),
                         a.light + share * (b.light - a.light)};
}

std::optional<double> RadialProjection::radius_towards(MeridionalPoint point) const {
    if (point.away == 0 && point.ahead > lines_[0].start) return 0.0;
    double before = point.away;
    for (int k = 1; k <= kSteps; ++k) {
        const auto i = static_cast<std::size_t>(k);
        const double here = point.away * cosines_[i] - point.ahead * sines_[i] - offset_[k];
        if (before > 0 && here <= 0 && point.away * sines_[i] + point.ahead * cosines_[i] > lines_[i].start)
            return reach_ / kSteps * (k - 1 + root(k - 1, point));
        before = here;
    }
    return std::nullopt;
}

OddCurve RadialProjection::curve_of(double MeridionalRay::* value, bool rises) const {
    std::vector<double> values;
    for (const MeridionalRay& line : lines_) values.push_back(line.*value);
    return OddCurve(std::move(values), rises);
}

void RadialProjection::set(int k, const std::optional<SceneRay>& ray, double light) {
    MeridionalRay& line = lines_[static_cast<std::size_t>(k)];
    line = {kNone, kNone, kNone, light};
    if (!ray) return;
    const double away = -ray->origin.y, ahead = vertex_ - ray->origin.z;
    line.angle = k == 0 ? 0 : std::atan2(-ray->direction.y, -ray->direction.z);
    const double cosine = std::cos(line.angle), sine = std::sin(line.angle);
    line.offset = k == 0 ? 0 : away * cosine - ahead * sine;
    line.start = away * sine + ahead * cosine;
}

void RadialProjection::follow_light(const LensSystem& lens, const PupilView& pupil, const RayLoop& loop) {
    // Adaptive refinement: the step halfway between two known ones is traced, too. If the cubics through the known
    // steps predict its ray, cubics that include it are some ten times more accurate, and the interval is not refined
    // further.
    constexpr int kWidestStep = 16;
    constexpr double kPrecision = 5e-6;  // rad; relative to the film's radius or to the light
    const MeanRays mean(lens, focus_);
    std::vector<std::optional<Seen>> seen(lines_.size());
    const auto is_foretold = [&](const KnownLines& known, int k) {
        const auto& [line, shown] = *seen[static_cast<std::size_t>(k)];
        const MeridionalRay foretold = known.shown_at(shown);
        const double light = known.light_at(k);
        return std::fabs(foretold.angle - line.angle) < kPrecision &&
               std::fabs(foretold.offset - line.offset) < kPrecision * reach_ &&
               std::fabs(light - line.light) < kPrecision * line.light;
    };
    std::set<int> wanted;
    for (int k = 0; k <= kSteps; k += kWidestStep) wanted.insert(k);
    for (int step = kWidestStep; !wanted.empty(); step /= 2) {
        const KnownLines known(seen);
        const std::vector<int> looks(wanted.begin(), wanted.end());
        loop.for_all(looks.size(), [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) {
                const std::optional<MeanRay> ray = mean.of(mean.bundle(pupil, radius_of(looks[i])));
                set(looks[i], ray ? std::optional(ray->ray) : std::nullopt, ray ? ray->light : 0);
                const auto k = static_cast<std::size_t>(looks[i]);
                seen[k] = {lines_[k], k == 0 ? 0 : ray ? ray->shows_at.y * kSteps / reach_ : kNone};
            }
        });
        wanted.clear();
        if (step == 1) break;
        for (const int k : looks) {
            if (is_foretold(known, k)) continue;
            for (const int halves : {-3, -1, 1, 3}) {  // a cubic also depends on the neighbouring intervals
                const int beside = k + halves * step / 2;
                if (beside > 0 && beside < kSteps && !seen[static_cast<std::size_t>(beside)]) wanted.insert(beside);
            }
        }
    }
    const KnownLines known(seen);
    for (int k = 1; k <= kSteps; ++k) {
        MeridionalRay& line = lines_[static_cast<std::size_t>(k)];
        line = known.shown_at(k);
        line.light = known.light_at(k);
    }
}

void RadialProjection::follow_chief_rays(const LensSystem& lens, const PupilView& pupil) {
    const RaysFromFilm from_film(lens, lens.wavelength_nm);
    double cosine = 0, change = 0;
    for (int k = 0; k <= kSteps; ++k) {
        // First guess: extrapolated from the last two rays. Second guess, for the axis and after a gap: the centre of
        // the pupil.
        const PupilRowPosition row = pupil_lookup(pupil, static_cast<float>(radius_of(k)), 0);
        const double guesses[2] = {cosine + change, static_cast<double>(row.centre)};
        const double light = lines_[static_cast<std::size_t>(k)].light;
        set(k, std::nullopt, light);
        for (const double guess : guesses) {
            const std::optional<ChiefRay> ray = chief_ray_near(from_film, {0, radius_of(k)}, {0, guess});
            if (!ray) continue;
            set(k, SceneRay{ray->scene, -ray->scene_direction}, light);
            const double found = -from_film.film_index() * ray->film_direction.y;
            change = found - cosine;
            cosine = found;
            break;
        }
    }
}

void RadialProjection::set_ideal(int k, const CameraView& view, ThinLensPosition thin) {
    const Vec2f film = {0, static_cast<float>(radius_of(k))}, middle = {0, 0};
    if (view.model == CameraModel::thick_lens) {
        const LensFrameRay ray = thick_lens_ray(view, film, middle);
        set(k, SceneRay{static_cast<Vec3d>(ray.origin_mm), normalized(static_cast<Vec3d>(ray.direction))},
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
    set(k, light > 0 ? std::optional(ray) : std::nullopt, light);
}

void RadialProjection::end_where_lines_turn_back() {
    const auto first = std::find_if(lines_.begin() + 1, lines_.end(),
                                    [](const MeridionalRay& line) { return std::isfinite(line.angle); });
    sign_ = first != lines_.end() && (first->angle < 0 || (first->angle == 0 && first->offset < 0)) ? -1 : 1;
    for (MeridionalRay& line : lines_) line = {sign_ * line.angle, sign_ * line.offset, line.start, line.light};
    const double distance = std::min(focus_, 1e9);
    for (std::size_t k = 1; k < lines_.size(); ++k) {
        const MeridionalRay& line = lines_[k - 1];
        const double cosine = std::cos(line.angle), sine = std::sin(line.angle);
        const MeridionalPoint point = {line.offset * cosine + distance * sine, distance * cosine - line.offset * sine};
        const double beside = point.away * std::cos(lines_[k].angle) - point.ahead * std::sin(lines_[k].angle);
        if (!(beside >= lines_[k].offset)) continue;
        for (; k < lines_.size(); ++k) lines_[k].angle = lines_[k].offset = lines_[k].start = kNone;
        ends_in_film_ = true;
    }
}

double RadialProjection::root(int k, MeridionalPoint point) const {
    double low = 0, high = 1, share = 0.5;
    for (int i = 0; i < 60 && high - low > 1e-15; ++i) {
        const OddCurve::Point angle = angle_.between(k, share), offset = offset_.between(k, share);
        const double cosine = std::cos(angle.value), sine = std::sin(angle.value);
        const double beside = point.away * cosine - point.ahead * sine - offset.value;
        (beside > 0 ? low : high) = share;
        const double slope = -(point.away * sine + point.ahead * cosine) * angle.slope - offset.slope;
        const double next = share - beside / slope;
        if (std::fabs(next - share) < 1e-14) return next;
        share = next > low && next < high ? next : 0.5 * (low + high);
    }
    return share;
}

}  // namespace realcam
