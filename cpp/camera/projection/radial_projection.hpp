#pragma once
#include <optional>
#include <vector>

#include "../../math/curves.hpp"
#include "../../optics/analysis/scene_bundle.hpp"
#include "../../optics/trace/ray_loop.hpp"
#include "centroid_ray.hpp"
#include "projection.hpp"

namespace REALCAM_NAMESPACE {

/// Projection ray of a film point, in the meridional plane. Lengths in mm.
struct MeridionalRay {
    double angle;  ///< to the axis, rad; positive if the ray leads away from the axis on the side of the scene that the
                   ///< picture shows on the film point's side
    double offset;  ///< signed perpendicular distance of the ray from the reference point
    double start;  ///< where it leaves the lens, along the ray from the foot of the perpendicular from the reference
                   ///< point
    double light;  ///< irradiance for a uniform scene, relative to the film centre
};

/// Projection rays by film radius, in front of the camera's lens or of the ideal model that replaces it. The lens is
/// rotationally symmetric, and an iris with blades is replaced by a circle of equal area, so one meridional plane
/// represents all azimuths.
class RadialProjection : public ProjectionRays {
public:
    /// `setup`: set-up of the camera. Rays are computed out to the corners of its film. Throws InputError.
    RadialProjection(const CameraSetup& setup, ProjectionRay ray, const RayLoop& loop = {});

    bool ends_in_film() const override { return ends_in_film_; }
    bool is_in_front(Vec3d point) const override { return -point.z > reference_; }
    std::optional<FilmProjection> ray(Vec2<double> film) const override;
    std::optional<Vec2<double>> project(Vec3d point) const override;

private:
    static constexpr int kSteps = 256;  ///< uniform steps of the film radius, from 0 to max_radius_

    /// Thin lens: position of its pupil, from the front vertex; and image distance, mm.
    struct ThinLensPosition {
        double position, image_distance;
    };

    /// Point in the meridional plane: distance from the axis, and distance from the reference point towards the scene,
    /// mm.
    struct MeridionalPoint {
        double away, ahead;
    };

    /// Ray of a film radius from 0 to max_radius_. Returns std::nullopt if no light reaches it.
    std::optional<MeridionalRay> at(double film_radius) const;

    /// Film radius whose ray passes through a point in front of the lens; the smallest one if there are several, and
    /// std::nullopt if there is none.
    std::optional<double> film_radius_of(MeridionalPoint point) const;

    /// Film radius of a step, mm.
    double radius_of(double step) const { return max_radius_ * step / kSteps; }

    /// Interpolates a member of the rays over the steps. `rises`: see OddCurve.
    OddCurve curve_of(double MeridionalRay::* value, bool rises = false) const;

    /// Stores the ray of step k; std::nullopt if no light reaches it. A film point at +y sees scene points at -y.
    void set_ray(int k, const std::optional<SceneRay>& ray, double light);

    /// Traces the centroid rays of as many film radii as accurate cubic interpolation requires.
    void trace_centroid_rays(const CentroidRays& centroid_rays, const PupilView& pupil, const RayLoop& loop);

    /// Replaces the rays by chief rays; keeps their light.
    void trace_chief_rays(const LensSystem& lens);

    /// Sets the ray of step k for a camera model without surfaces: it passes through the centre of the pupil.
    void set_ideal_ray(int k, const CameraView& view, ThinLensPosition thin);

    /// Discards the rays from the film radius on at which the angle stops increasing outwards. At the edge of the
    /// image, where rims leave little of the light, the centroid ray may point farther inwards again, at points that
    /// already have a smaller film radius. Also orients all rays to the side on which they lead away from the axis.
    void discard_rays_turning_inwards();

    /// Fraction of the step from k to k + 1 at which the interpolated ray passes through the point: Newton's method,
    /// safeguarded by bisection.
    double fraction_through(int k, MeridionalPoint point) const;

    /// Position of the reference point, the centre of the paraxial entrance pupil, or the front vertex if the pupil is
    /// far away: mm from the film towards the scene, and mm from the front vertex.
    double reference_, vertex_;
    double focus_;  ///< distance from the reference point to the plane in focus, mm
    double max_radius_ = 0;  ///< largest film radius with a known ray, mm
    bool ends_in_film_ = false;
    int sign_ = 1;  ///< -1 if the picture is upside down, as behind a lens with an intermediate image
    std::vector<MeridionalRay> rays_;  ///< one for each step
    OddCurve angle_, offset_;
    std::vector<double> cosines_, sines_;  ///< cosines and sines of the rays' angles
};

}  // namespace REALCAM_NAMESPACE
