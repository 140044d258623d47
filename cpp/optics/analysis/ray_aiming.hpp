#pragma once
#include <optional>

#include "../../math/hypotenuse.hpp"
#include "../trace/aiming_path.hpp"
#include "../trace/film_frame.hpp"
#include "aim_request.hpp"
#include "object_point.hpp"

namespace REALCAM_NAMESPACE {

/// Finds the rays of one object point that meet given places on the real aperture stop.
///
/// Newton's method in the two coordinates of the entry plane, with the Jacobian by differences; a step that does not
/// come nearer is halved. The chief ray is followed from the axis out to its field angle in steps of at most 5 degrees.
/// So of several rays through the middle of the stop, the one that belongs to the lens's image is found. The other rays
/// start from the chief ray. Where that fails they go out to their place in 4, then in 16 steps. Each search has at
/// most 40 Newton steps of at most 24 halvings; a ray that is not within 2.5e-11 of the stop's radius then is no ray.
/// Places on the very edge of the stop's opening are aimed at 5e-11 further in, so that no rounding blocks the ray,
/// here or where it is traced again.
class RayAimer {
public:
    using Entry = ObjectPoint::Entry;

    /// Throws InputError where the field point makes no sense, or no ray from it reaches the middle of the stop.
    RayAimer(const LensSystem& lens, double wavelength_nm, const FieldPoint& field);

    /// The real ray through the middle of the stop, whether or not a rim or an obstruction blocks it.
    AimedRay chief_ray() const { return through(open_.view(), chief_); }

    /// The ray through a place on the stop, mm, by the lens as it is: blocked rays have the status that ended them.
    AimedRay operator()(Vec2<double> place) const;

    /// Where a place on the stop, mm, is aimed at.
    Vec2<double> off_the_edge(Vec2<double> place) const;

    /// For rays that are aimed together, as nearly as one by one. Valid as long as this and the map; without places.
    AimRequest request(const StopMap& map) const;

    ObjectPoint object;

    /// A point of the object's frame, in the lens frame.
    Vec3d in_lens_frame(Vec3d point) const { return point + frame_; }

private:
    struct Probe {
        Vec2<double> at;  ///< on the stop
        Vec2<double> by_x, by_y;  ///< its derivatives by the entry
    };
    static constexpr int kMaxSteps = 40, kMaxHalvings = 24;
    static constexpr double kMiss = 2.5e-11, kEdge = 2 * kMiss;  ///< shares of the stop's radius

    AimedRay through(LensView<double> view, Entry entry) const;

    /// Nothing where the ray, or one of its two neighbours, does not reach the stop.
    std::optional<Probe> probe(const ObjectPoint& from, Entry entry) const;

    static double miss(const Probe& probe, Vec2<double> place) {
        return hypotenuse(probe.at.x - place.x, probe.at.y - place.y);
    }

    std::optional<Entry> aimed(const ObjectPoint& from, Vec2<double> place, Entry entry) const;

    /// Starts from the chief ray at once. Where that fails, it goes outwards to the place in shorter and shorter steps.
    std::optional<Entry> aimed_from_chief(Vec2<double> place) const;

    void find_chief_ray(const LensSystem& lens, const FieldPoint& field);
    void follow_chief_ray(const LensSystem& lens, double wavelength_nm, const FieldPoint& field);

    LensPath<double> path_;
    int stop_;
    AimingPath open_, real_;
    double reach_;  ///< of the stop's opening, which may have blades
    double stop_radius_, step_;
    Entry chief_{0, 0};
    Vec3d frame_{0, 0, 0};  ///< origin of the object's frame, in the lens frame
};

}  // namespace REALCAM_NAMESPACE
