#pragma once
#include <optional>
#include <vector>

#include "../../optics/analysis/film_bundle.hpp"
#include "../../optics/analysis/scene_bundle.hpp"
#include "../../optics/pupil/pupil_view.hpp"

namespace REALCAM_NAMESPACE {

/// Distance from the lens, mm, from which on the entrance pupil is no reference point of rays, as for a lens that is
/// telecentric on the object's side.
inline constexpr double kFarPupil_mm = 1e6;

/// Centroid ray of a film point: the mean of the rays that reach it. In each plane across it the film point sees a spot
/// of light, whose centroid lies on this straight line because each ray is straight.
struct CentroidRay {
    SceneRay ray;  ///< origin: where it leaves the lens
    Vec2<double> light_centroid;  ///< centroid on the film, mm, of the light of the scene point in focus on the ray
    double light;  ///< irradiance of the film point for unit radiance
};

/// Computes centroid rays of film points.
class CentroidRays {
public:
    /// `focus`: distance from the entrance pupil to the plane in focus, mm; may be infinite. `polynomial`: traces the
    /// rays in place of the lens, unless it has no discs; the light's centroid then counts as the film point, because
    /// polynomials trace no light from the scene.
    CentroidRays(const LensSystem& lens, double focus, const LensPolynomialView& polynomial = {});

    /// Ray bundle of a film point on the +y axis, for a centred, rotationally symmetric lens with a circular stop. Must
    /// not outlive this object.
    FilmBundle bundle(const PupilView& pupil, double film_radius) const;
    /// Ray bundle of a film point, for lenses without rotational symmetry. Must not outlive this object.
    FilmBundle bundle(const PupilGridView& pupil, Vec2<double> film) const;

    /// Centroid ray of a bundle. Returns std::nullopt if no light reaches the film point.
    std::optional<CentroidRay> centroid_ray(const FilmBundle& bundle) const;

    /// Irradiance of the bundle's film point for unit radiance; 0 if no light reaches it.
    static double irradiance_of(const FilmBundle& bundle);

private:
    /// Ray of a bundle that has left the lens, and the area that it represents in the bundle's entrance rectangle,
    /// which is its contribution to the irradiance.
    struct WeightedRay {
        SceneRay ray;
        double area;
    };
    /// With fewer nodes along a radius, errors would reach 0.1 um: aspheres of phone lenses bend light strongly at the
    /// rim.
    static constexpr BundleSampling kSampling = {24, 12};

    /// Traces a bundle; returns the rays that leave the lens.
    static std::vector<WeightedRay> trace(const FilmBundle& bundle);

    /// Centroid on the film of the light of the scene point in focus on a ray. `rays`: rays of the film point, which
    /// give the bounds of the search: that light enters the lens about where the light of the film point leaves it.
    /// `mirrored`: true if the light is symmetric in x.
    Vec2<double> centroid_on_film(const SceneRay& ray, const std::vector<WeightedRay>& rays, bool mirrored) const;

    LensPath<double> to_scene_, to_film_;
    FilmSurface<double> film_;
    double focus_;
    LensPolynomialView polynomial_;
};

}  // namespace REALCAM_NAMESPACE
