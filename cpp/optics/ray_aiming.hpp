#pragma once
#include <optional>

#include "aim_request.hpp"
#include "lens_path.hpp"
#include "object_point.hpp"
#include "pupil_pattern.hpp"

namespace REALCAM_NAMESPACE {

/// A lens path whose rims are changed for aiming.
class AimingPath {
public:
    /// Without rims, blades and central obstructions: what a ray is aimed through. Whether the real lens lets it pass
    /// is asked afterwards. Aspheres stay searched for within their rim.
    static AimingPath open(const LensPath<double>& path) {
        AimingPath result(path);
        for (SurfaceView<double>& step : result.steps_) {
            step.rim_squared = std::numeric_limits<double>::max();
            step.hole_squared = -1;
            step.has_blades = false;
        }
        return result;
    }
    /// The lens as it is.
    static AimingPath real(const LensPath<double>& path) { return AimingPath(path); }
    LensView<double> view() const { return {steps_.data(), static_cast<int>(steps_.size()), LensKind::any, iris_}; }

private:
    explicit AimingPath(const LensPath<double>& path) {
        const LensView<double> view = path.view();
        steps_.assign(view.surfaces, view.surfaces + view.count);
        iris_ = view.iris;
    }
    std::vector<SurfaceView<double>> steps_;
    Iris<double> iris_;
};

/// Finds the rays of one object point that meet given places on the real aperture stop.
///
/// Newton's method in the two coordinates of the entry plane, with the Jacobian by differences; a step that does not
/// come nearer is halved. The chief ray is followed from the axis out to its field angle in steps of at most 5 degrees,
/// so that of several rays through the middle of the stop the one is found that belongs to the lens's image; the
/// others start from the chief ray, and where that fails go out to their place in 4, then in 16 steps. Each search has
/// at most 40 Newton steps of at most 24 halvings; a ray that is not within 2.5e-11 of the stop's radius then is no
/// ray. Places on the very edge of the stop's opening are aimed at 5e-11 further in, so that no rounding blocks the
/// ray, here or where it is traced again.
class RayAimer {
public:
    using Entry = ObjectPoint::Entry;

    /// Throws InputError where the field point makes no sense, or no ray from it reaches the middle of the stop.
    RayAimer(const LensSystem& lens, double wavelength_nm, const FieldPoint& field)
        : object(lens, wavelength_nm, field),
          path_(lens, LightDirection::to_film, wavelength_nm),
          stop_(lens.stop_index()),
          open_(AimingPath::open(path_)),
          real_(AimingPath::real(path_)),
          reach_(stop_reach(lens)),
          stop_radius_(std::min(lens.stop_semi_diameter, lens.stop().clear_semi_diameter)) {
        const FirstOrder data = first_order(lens, wavelength_nm);
        step_ = 1e-6 * data.entrance_pupil_diameter;
        follow_chief_ray(lens, wavelength_nm, field);
    }

    /// The real ray through the middle of the stop, whether or not a rim or an obstruction blocks it.
    AimedRay chief_ray() const { return through(open_.view(), chief_); }

    /// The ray through a place on the stop, mm, by the lens as it is: blocked rays have the status that ended them.
    AimedRay operator()(Vec2<double> place) const {
        const std::optional<Entry> entry = aimed_from_chief(off_the_edge(place));
        if (!entry) {
            constexpr double nan = std::numeric_limits<double>::quiet_NaN();
            return {RayStatus::no_convergence, {nan, nan}, {nan, nan, nan}, {nan, nan, nan}, nan};
        }
        return through(real_.view(), *entry);
    }

    /// Where a place on the stop, mm, is aimed at.
    Vec2<double> off_the_edge(Vec2<double> place) const {
        const double share = std::hypot(place.x, place.y) / reach_;
        const double inwards = std::fabs(share - 1) < kEdge ? (1 - kEdge) / share : 1.0;
        return {inwards * place.x, inwards * place.y};
    }

    /// For rays that are aimed together, as nearly as one by one. Valid as long as this and the map; without places.
    AimRequest request(const StopMap& map) const {
        LensView<double> to_stop = open_.view();
        to_stop.count = stop_ + 1;
        return {to_stop,
                real_.view(),
                object.centre - Vec3d{0, 0, path_.entry_position},
                object.towards,
                object.inverse_distance,
                path_.entry_index,
                kMiss * stop_radius_,
                &map,
                0,
                nullptr,
                nullptr};
    }

    ObjectPoint object;

private:
    struct Probe {
        Vec2<double> at;  ///< on the stop
        Vec2<double> by_x, by_y;  ///< its derivatives by the entry
    };
    static constexpr int kMaxSteps = 40, kMaxHalvings = 24;
    static constexpr double kMiss = 2.5e-11, kEdge = 2 * kMiss;  ///< shares of the stop's radius

    AimedRay through(LensView<double> view, Entry entry) const {
        LensRays<double, 1> ray;
        const Vec3d start = object.at(entry) - Vec3d{0, 0, path_.entry_position};
        ray.origin.set(0, start);
        ray.direction.set(0, path_.entry_index * object.direction(entry));
        ray.status[0] = 0;
        PathRecord<double, 1> record{};
        trace_lens(view, ray, record);
        return {static_cast<RayStatus>(ray.status[0]), entry, ray.origin[0], ray.direction[0],
                record.optical_path[0] + path_.entry_index * object.path_difference(entry)};
    }

    /// Nothing where the ray, or one of its two neighbours, does not reach the stop.
    std::optional<Probe> probe(const ObjectPoint& from, Entry entry) const {
        LensView<double> to_stop = open_.view();
        to_stop.count = stop_ + 1;
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

    static double miss(const Probe& probe, Vec2<double> place) {
        return std::hypot(probe.at.x - place.x, probe.at.y - place.y);
    }

    std::optional<Entry> aimed(const ObjectPoint& from, Vec2<double> place, Entry entry) const {
        std::optional<Probe> here = probe(from, entry);
        if (!here) return {};
        for (int i = 0; i < kMaxSteps; ++i) {
            const double error = miss(*here, place);
            if (error <= kMiss * stop_radius_) return entry;
            const double dx = place.x - here->at.x, dy = place.y - here->at.y;
            const double determinant = here->by_x.x * here->by_y.y - here->by_y.x * here->by_x.y;
            Entry change = {(dx * here->by_y.y - dy * here->by_y.x) / determinant,
                            (dy * here->by_x.x - dx * here->by_x.y) / determinant};
            std::optional<Probe> next;
            for (int halving = 0; halving <= kMaxHalvings; ++halving) {
                next = probe(from, {entry.x + change.x, entry.y + change.y});
                if (next && miss(*next, place) < error) break;
                next.reset();
                change = {0.5 * change.x, 0.5 * change.y};
            }
            if (!next) return {};
            entry = {entry.x + change.x, entry.y + change.y};
            here = next;
        }
        return {};
    }

    /// From the chief ray at once; where that fails, outwards to the place in shorter and shorter steps.
    std::optional<Entry> aimed_from_chief(Vec2<double> place) const {
        for (const int parts : {1, 4, 16}) {
            std::optional<Entry> entry = chief_;
            for (int k = 1; k <= parts && entry; ++k) {
                const double share = static_cast<double>(k) / parts;
                entry = aimed(object, {share * place.x, share * place.y}, *entry);
            }
            if (entry) return entry;
        }
        return {};
    }

    void follow_chief_ray(const LensSystem& lens, double wavelength_nm, const FieldPoint& field) {
        constexpr double kLargest = 0.09, kSmallest = 1e-3;  // rad
        double reached = 0, step = std::min(kLargest, std::fabs(field.angle_rad));
        while (std::fabs(field.angle_rad) > reached) {
            const double next = std::min(reached + step, std::fabs(field.angle_rad));
            FieldPoint between = field;
            between.angle_rad = std::copysign(next, field.angle_rad);
            const ObjectPoint from(lens, wavelength_nm, between);
            if (const std::optional<Entry> entry = aimed(from, {0, 0}, chief_)) {
                chief_ = *entry;
                reached = next;
            } else if ((step *= 0.5) < kSmallest) {
                throw InputError("no ray at a field angle of " + object_point_detail::degrees(field.angle_rad) +
                                 " reaches the middle of the stop of lens \"" + lens.name + "\"");
            }
        }
    }

    LensPath<double> path_;
    int stop_;
    AimingPath open_, real_;
    double reach_;  ///< of the stop's opening, which may have blades
    double stop_radius_, step_;
    Entry chief_{0, 0};
};

}  // namespace REALCAM_NAMESPACE
