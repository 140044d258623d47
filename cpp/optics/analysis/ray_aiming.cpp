#include "ray_aiming.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "../../math/hypotenuse.hpp"
#include "../../math/least_squares.hpp"
#include "../lens/paraxial.hpp"
#include "../pupil/pupil_pattern.hpp"

namespace realcam {

RayAimer::RayAimer(const LensSystem& lens, double wavelength_nm, const FieldPoint& field)
    : object(lens, wavelength_nm, field),
      path_(lens, LightDirection::to_film, wavelength_nm, film_path_ends(lens, LightDirection::to_film)),
      stop_(lens.stop_index()),
      open_(AimingPath::open(path_)),
      real_(AimingPath::real(path_)),
      stop_bounding_radius_(stop_bounding_radius(lens)),
      stop_radius_(lens.open_stop_radius()) {
    const FirstOrder data = first_order(lens, wavelength_nm);
    step_ = 1e-6 * data.entrance_pupil_diameter;
    if (const PathEnds ends = film_path_ends(lens, LightDirection::to_film); ends.entry) frame_ = ends.entry->origin;
    if (field.film || !lens.is_rotational())
        find_chief_ray(lens, field);  // starts with that of the design wavelength
    else
        follow_chief_ray(lens, wavelength_nm, field);
}

AimedRay RayAimer::operator()(Vec2<double> target) const {
    const std::optional<Entry> entry = aimed_from_chief(moved_inside_edge(target));
    if (!entry) {
        constexpr double nan = std::numeric_limits<double>::quiet_NaN();
        return {RayStatus::no_convergence, {nan, nan}, {nan, nan, nan}, {nan, nan, nan}, nan};
    }
    return traced(real_.view(), *entry);
}

Vec2<double> RayAimer::moved_inside_edge(Vec2<double> target) const {
    const double fraction = hypotenuse(target.x, target.y) / stop_bounding_radius_;
    const double factor = std::fabs(fraction - 1) < kEdgeMargin ? (1 - kEdgeMargin) / fraction : 1.0;
    return {factor * target.x, factor * target.y};
}

AimRequest RayAimer::request(const StopMap& map) const {
    return {open_.first(stop_ + 1),
            real_.view(),
            object.centre - Vec3d{0, 0, path_.entry_position},
            object.towards,
            object.across,
            object.upwards,
            object.inverse_distance,
            path_.entry_index,
            kTolerance * stop_radius_,
            &map,
            0,
            nullptr,
            nullptr};
}

AimedRay RayAimer::traced(LensView<double> view, Entry entry) const {
    LensRays<double, 1> ray;
    const Vec3d origin = object.at(entry) - Vec3d{0, 0, path_.entry_position};
    ray.origin.set(0, origin);
    ray.direction.set(0, path_.entry_index * object.direction(entry));
    ray.status[0] = 0;
    PathRecord<double, 1> record{};
    trace_lens(view, ray, record);
    return {static_cast<RayStatus>(ray.status[0]), entry, ray.origin[0], ray.direction[0],
            record.optical_path[0] + path_.entry_index * object.path_difference(entry)};
}

std::optional<RayAimer::Probe> RayAimer::probe(const ObjectPoint& from, Entry entry) const {
    const LensView<double> to_stop = open_.first(stop_ + 1);
    const Entry entries[3] = {entry, {entry.x + step_, entry.y}, {entry.x, entry.y + step_}};
    LensRays<double, 3> rays;
    for (int i = 0; i < 3; ++i) {
        rays.origin.set(i, from.at(entries[i]) - Vec3d{0, 0, path_.entry_position});
        rays.direction.set(i, path_.entry_index * from.direction(entries[i]));
        rays.status[i] = 0;
    }
    PathRecord<double, 3> record{};
    trace_lens(to_stop, rays, record);
    for (const int status : rays.status)
        if (status != 0) return {};
    const auto slope = [&](int i) {
        return Vec2<double>{(rays.origin.x[i] - rays.origin.x[0]) / step_,
                            (rays.origin.y[i] - rays.origin.y[0]) / step_};
    };
    return Probe{{rays.origin.x[0], rays.origin.y[0]}, slope(1), slope(2)};
}

std::optional<RayAimer::Entry> RayAimer::aimed(const ObjectPoint& from, Vec2<double> target, Entry entry) const {
    std::optional<Probe> current = probe(from, entry);
    if (!current) return {};
    for (int i = 0; i < kMaxSteps; ++i) {
        const double error = miss(*current, target);
        if (error <= kTolerance * stop_radius_) return entry;
        const double dx = target.x - current->at.x, dy = target.y - current->at.y;
        const double determinant = current->by_x.x * current->by_y.y - current->by_y.x * current->by_x.y;
        Entry change = {(dx * current->by_y.y - dy * current->by_y.x) / determinant,
                        (dy * current->by_x.x - dx * current->by_x.y) / determinant};
        std::optional<Probe> next;
        for (int halving = 0; halving <= kMaxHalvings; ++halving) {
            next = probe(from, {entry.x + change.x, entry.y + change.y});
            if (next && miss(*next, target) < error) break;
            next.reset();
            change = {0.5 * change.x, 0.5 * change.y};
        }
        if (!next) return {};
        entry = {entry.x + change.x, entry.y + change.y};
        current = next;
    }
    return {};
}

std::optional<RayAimer::Entry> RayAimer::aimed_from_chief(Vec2<double> target) const {
    for (const int parts : {1, 4, 16}) {
        std::optional<Entry> entry = chief_;
        for (int k = 1; k <= parts && entry; ++k) {
            const double fraction = static_cast<double>(k) / parts;
            entry = aimed(object, {fraction * target.x, fraction * target.y}, *entry);
        }
        if (entry) return entry;
    }
    return {};
}

void RayAimer::find_chief_ray(const LensSystem& lens, const FieldPoint& field) {
    const std::optional<Entry> entry = aimed(object, {0, 0}, chief_);
    if (!entry)
        throw InputError("no ray " + field.text() + " reaches the centre of the stop of lens \"" + lens.name + "\"");
    chief_ = *entry;
}

void RayAimer::follow_chief_ray(const LensSystem& lens, double wavelength_nm, const FieldPoint& field) {
    constexpr double kMaxStep = 0.09, kMinStep = 1e-3;  // rad
    double current_angle = 0, step = std::min(kMaxStep, std::fabs(field.angle_rad));
    while (std::fabs(field.angle_rad) > current_angle) {
        const double next = std::min(current_angle + step, std::fabs(field.angle_rad));
        FieldPoint intermediate = field;
        intermediate.angle_rad = std::copysign(next, field.angle_rad);
        const ObjectPoint from(lens, wavelength_nm, intermediate);
        if (const std::optional<Entry> entry = aimed(from, {0, 0}, chief_)) {
            chief_ = *entry;
            current_angle = next;
        } else if ((step *= 0.5) < kMinStep) {
            throw InputError("no ray at a field angle of " + object_point_detail::degrees(field.angle_rad) +
                             " reaches the centre of the stop of lens \"" + lens.name + "\"");
        }
    }
}

namespace {

/// Fits a map from the stop to the entry plane to rays that are aimed one by one at Gauss nodes. Returns std::nullopt
/// if some of these points cannot be reached, because the map cannot be extrapolated to them. `reach`: radius of the
/// map, mm.
std::optional<StopMap> stop_map(const RayAimer& aim, double reach, const RayLoop& loop) {
    const std::vector<PupilPoint> nodes = gauss_rings(8);
    std::vector<AimedRay> rays;
    loop.append_all(rays, nodes.size(), [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) rays[i] = aim({reach * nodes[i].x, reach * nodes[i].y});
    });
    std::vector<std::vector<double>> powers(StopMap::kTerms), entries(2);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (!std::isfinite(rays[i].entry.x + rays[i].entry.y)) return {};
        entries[0].push_back(rays[i].entry.x);
        entries[1].push_back(rays[i].entry.y);
        std::size_t term = 0;
        double x_power = 1;
        for (int a = 0; a <= StopMap::kDegree; ++a, x_power *= nodes[i].x) {
            double product = x_power;
            for (int b = 0; a + b <= StopMap::kDegree; ++b, product *= nodes[i].y) powers[term++].push_back(product);
        }
    }
    const auto coefficients = least_squares(powers, std::move(entries));
    StopMap map{};
    map.reach = reach;
    std::copy(coefficients[0].begin(), coefficients[0].end(), map.x);
    std::copy(coefficients[1].begin(), coefficients[1].end(), map.y);
    return map;
}

}  // namespace

std::vector<AimedRay> aim_all(const RayAimer& aim, const std::vector<PupilPoint>& pattern, double reach,
                              const RayLoop& loop) {
    constexpr std::size_t kMinForMap = 1000;  // fitting the map takes as long as aiming some 500 rays
    std::vector<AimedRay> rays;
    const std::optional<StopMap> map = pattern.size() < kMinForMap ? std::nullopt : stop_map(aim, reach, loop);
    loop.append_all(rays, pattern.size(), [&](std::size_t first, std::size_t last) {
        const auto target = [&](std::size_t i) { return Vec2<double>{reach * pattern[i].x, reach * pattern[i].y}; };
        if (map) {
            std::vector<Vec2<double>> targets;
            targets.reserve(last - first);
            for (std::size_t i = first; i < last; ++i) targets.push_back(aim.moved_inside_edge(target(i)));
            AimRequest request = aim.request(*map);
            request.count = static_cast<std::int64_t>(targets.size());
            request.targets = targets.data();
            request.rays = rays.data() + first;
            loop.aim_rays ? loop.aim_rays(request) : aim_rays<16>(request);
        }
        for (std::size_t i = first; i < last; ++i)
            if (!map || !std::isfinite(rays[i].entry.x)) rays[i] = aim(target(i));
    });
    return rays;
}

}  // namespace realcam
