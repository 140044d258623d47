#pragma once
#include <optional>
#include <vector>

#include "../../math/hypotenuse.hpp"
#include "../pupil/pupil_pattern.hpp"
#include "../trace/aiming_path.hpp"
#include "../trace/film_frame.hpp"
#include "../trace/ray_loop.hpp"
#include "aim_request.hpp"
#include "object_point.hpp"

namespace REALCAM_NAMESPACE {

/// Finds the rays of one object point through given points on the real aperture stop.
///
/// Newton's method in the two coordinates of the entry plane, with the Jacobian by differences; a step that does not
/// come nearer is halved. The chief ray is followed from the axis out to its field angle in steps of at most 5 degrees,
/// so that of several rays through the stop's centre the one that belongs to the lens's image is found. The other rays
/// start from the chief ray; if that fails, they go out to their target in 4, then in 16 steps. Each search has at most
/// 40 Newton steps of at most 24 halvings, and fails if its ray is then not within 2.5e-11 of the stop's radius. Points
/// on the very edge of the stop's opening are replaced by ones 5e-11 further in, so that no rounding blocks the ray,
/// here or where it is traced again.
class RayAimer {
public:
    using Entry = ObjectPoint::Entry;

    /// Throws InputError if the field point is invalid, or no ray from it reaches the stop's centre.
    RayAimer(const LensSystem& lens, double wavelength_nm, const FieldPoint& field);

    /// Real ray through the stop's centre, even if a rim or an obstruction blocks it.
    AimedRay chief_ray() const { return through(open_.view(), chief_); }

    /// Returns the ray through a point on the stop, mm, in the real lens: blocked rays have the status that ended them.
    AimedRay operator()(Vec2<double> target) const;

    /// Returns the actual target for a point on the stop, mm: moved inwards if it lies on the very edge of the opening.
    Vec2<double> off_the_edge(Vec2<double> target) const;

    /// Returns a request, without rays, for aiming them together as accurately as one by one. Valid as long as this
    /// object and the map.
    AimRequest request(const StopMap& map) const;

    ObjectPoint object;

    /// Converts a point from the object's frame to the lens frame.
    Vec3d in_lens_frame(Vec3d point) const { return point + frame_; }

private:
    struct Probe {
        Vec2<double> at;  ///< point on the stop, mm
        Vec2<double> by_x, by_y;  ///< derivatives of `at` by the entry
    };
    static constexpr int kMaxSteps = 40, kMaxHalvings = 24;
    static constexpr double kMiss = 2.5e-11, kEdge = 2 * kMiss;  ///< relative to the stop's radius

    AimedRay through(LensView<double> view, Entry entry) const;

    /// Returns std::nullopt if the ray, or one of its two neighbours, does not reach the stop.
    std::optional<Probe> probe(const ObjectPoint& from, Entry entry) const;

    static double miss(const Probe& probe, Vec2<double> target) {
        return hypotenuse(probe.at.x - target.x, probe.at.y - target.y);
    }

    std::optional<Entry> aimed(const ObjectPoint& from, Vec2<double> target, Entry entry) const;

    /// Starts from the chief ray at once. If that fails, goes outwards to the target in shorter and shorter steps.
    std::optional<Entry> aimed_from_chief(Vec2<double> target) const;

    void find_chief_ray(const LensSystem& lens, const FieldPoint& field);
    void follow_chief_ray(const LensSystem& lens, double wavelength_nm, const FieldPoint& field);

    LensPath<double> path_;
    int stop_;
    AimingPath open_, real_;
    double reach_;  ///< radius of the circle around the stop's opening, which may have blades
    double stop_radius_, step_;
    Entry chief_{0, 0};
    Vec3d frame_{0, 0, 0};  ///< origin of the object's frame, in the lens frame
};

/// Returns the rays through all points of a pattern on the stop, in units of `reach`. Large patterns are aimed
/// together, starting from a fitted map from stop to entry plane, and as accurately as one by one; rays for which this
/// fails are aimed one by one. Passes on what `loop` throws to stop it.
std::vector<AimedRay> aim_all(const RayAimer& aim, const std::vector<PupilPoint>& pattern, double reach,
                              const RayLoop& loop = {});

}  // namespace REALCAM_NAMESPACE
