#pragma once
#include <optional>
#include <vector>

#include "../../optics/analysis/film_bundle.hpp"
#include "../../optics/analysis/scene_bundle.hpp"
#include "../../optics/pupil/pupil_grid_view.hpp"

namespace REALCAM_NAMESPACE {

/// Centroid ray of a film point: the mean of the rays that reach it. In each plane across it the film point sees a spot
/// of light, whose centroid lies on this straight line because each ray is straight.
struct MeanRay {
    SceneRay ray;  ///< origin: where it leaves the lens
    Vec2<double> shows_at;  ///< film point that is the centroid of the light of the ray's point in focus, mm
    double light;  ///< irradiance of the film point for unit radiance
};

/// Computes centroid rays of film points.
class MeanRays {
public:
    /// `focus`: distance from the entrance pupil to the plane in focus, mm; may be infinite.
    MeanRays(const LensSystem& lens, double focus);

    /// Ray bundle of a film point on the +y axis, for a centred, rotationally symmetric lens with a circular stop. Must
    /// not outlive this object.
    FilmBundle bundle(const PupilView& pupil, double film_radius) const;
    /// Ray bundle of a film point, for lenses without rotational symmetry. Must not outlive this object.
    FilmBundle bundle(const PupilGridView& pupil, Vec2<double> film) const;

    /// Centroid ray of a bundle. Returns std::nullopt if no light reaches the film point.
    std::optional<MeanRay> of(const FilmBundle& bundle) const;

    /// Irradiance of the film point for unit radiance.
    static double light_of(const FilmBundle& bundle);

private:
    struct Part {
        SceneRay ray;
        double area;
    };
    /// With fewer nodes along a radius, errors would reach 0.1 um: aspheres of phone lenses bend light strongly at the
    /// rim.
    static constexpr BundleSampling kSampling = {24, 12};

    static std::vector<Part> parts_of(const FilmBundle& bundle);

    /// Centroid on the film of the light of the ray's point in focus. `parts` gives the bounds of the search: that
    /// light enters the lens about where the light of the film point leaves it.
    Vec2<double> middle_of_light(const SceneRay& ray, const std::vector<Part>& parts, bool mirrored) const;

    LensPath<double> to_scene_, to_film_;
    FilmSurface<double> film_;
    double focus_;
};

}  // namespace REALCAM_NAMESPACE
