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
/// It uses Newton's method in the two coordinates of the entry plane (see ObjectPoint), with the Jacobian by finite
/// differences. A step that does not reduce the distance from the target is halved. The chief ray is followed from the
/// axis to its field angle in steps of at most 5 degrees: if there are several rays through the stop's centre, this
/// finds the one that belongs to the image. Searches for other rays start from the chief ray; if this fails, they
/// approach their target in 4, then in 16 steps. A search takes at most 40 Newton steps with at most 24 halvings each,
/// and fails if its ray then misses the target by more than 2.5e-11 of the stop's radius. Targets on the edge of the
/// stop's opening are moved inside by 5e-11 of its radius, so that rounding does not block the ray, here or when it is
/// traced again.
class RayAimer {
public:
    using Entry = ObjectPoint::Entry;

    /// Throws InputError if the field point is invalid, or if no ray of it reaches the stop's centre.
    RayAimer(const LensSystem& lens, double wavelength_nm, const FieldPoint& field);

    /// Returns the real ray through the stop's centre, even if a rim or an obstruction blocks it.
    AimedRay chief_ray() const { return traced(open_.view(), chief_); }

    /// Returns the ray through a point on the stop (mm) in the real lens. If the lens blocks it, its status says how;
    /// if there is no ray, the status is no_convergence.
    AimedRay operator()(Vec2<double> target) const;

    /// Returns a target (mm) on the stop, moved inside if it lies on the edge of the opening.
    Vec2<double> moved_inside_edge(Vec2<double> target) const;

    /// Returns a request for aiming many rays together, as accurately as one by one; its count, targets, and rays are
    /// still to be set. It is valid as long as this object and the map.
    AimRequest request(const StopMap& map) const;

    ObjectPoint object;

    /// Converts a point from the object's frame to the lens frame.
    Vec3d in_lens_frame(Vec3d point) const { return point + frame_; }

private:
    /// A ray traced to the stop.
    struct Probe {
        Vec2<double> at;  ///< point on the stop, mm
        Vec2<double> by_x, by_y;  ///< derivatives of `at` by the coordinates of the entry point
    };
    static constexpr int kMaxSteps = 40, kMaxHalvings = 24;  ///< limits of the searches by Newton's method
    static constexpr double kTolerance = 2.5e-11, kEdgeMargin = 2 * kTolerance;  ///< relative to the stop's radius

    /// Traces the ray with this entry point through a view of the lens.
    AimedRay traced(LensView<double> view, Entry entry) const;

    /// Traces the ray of an object point with this entry point to the stop, and two close neighbours for the
    /// derivatives. Returns std::nullopt if one of them does not reach the stop.
    std::optional<Probe> probe(const ObjectPoint& from, Entry entry) const;

    /// Distance of a ray from its target, mm.
    static double miss(const Probe& probe, Vec2<double> target) {
        return hypotenuse(probe.at.x - target.x, probe.at.y - target.y);
    }

    /// Returns the entry point of the ray through `target` by Newton's method from `entry` on; std::nullopt if it
    /// fails.
    std::optional<Entry> aimed(const ObjectPoint& from, Vec2<double> target, Entry entry) const;

    /// Same from the chief ray on, in one step; if this fails, in 4, then in 16 steps.
    std::optional<Entry> aimed_from_chief(Vec2<double> target) const;

    /// Finds the chief ray from the centre of the entry plane on. Throws InputError if there is none.
    void find_chief_ray(const LensSystem& lens, const FieldPoint& field);
    /// Follows the chief ray from the axis to the field angle. Throws InputError if this fails.
    void follow_chief_ray(const LensSystem& lens, double wavelength_nm, const FieldPoint& field);

    LensPath<double> path_;
    int stop_;  ///< index of the stop
    AimingPath open_, real_;  ///< the lens without and with rims
    double stop_bounding_radius_;  ///< radius of the circle around the stop's opening, which may have blades
    double stop_radius_;  ///< mm
    double step_;  ///< step of finite differences on the entry plane, mm
    Entry chief_{0, 0};  ///< entry point of the chief ray
    Vec3d frame_{0, 0, 0};  ///< origin of the object's frame, in the lens frame
};

/// Returns the rays through all points of a pattern on the stop; `reach`: the unit of the pattern's points, mm. Rays of
/// large patterns are aimed together by a map that is fitted from the stop to the entry plane (StopMap), and as
/// accurately as one by one; rays for which this fails are aimed one by one. Throws Cancelled if `loop` is cancelled.
std::vector<AimedRay> aim_all(const RayAimer& aim, const std::vector<PupilPoint>& pattern, double reach,
                              const RayLoop& loop = {});

}  // namespace REALCAM_NAMESPACE
