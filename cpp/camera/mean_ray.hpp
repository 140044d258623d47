#pragma once
#include <optional>
#include <vector>

#include "../optics/analysis/film_bundle.hpp"
#include "../optics/analysis/scene_bundle.hpp"
#include "../optics/pupil/pupil_grid_view.hpp"

namespace REALCAM_NAMESPACE {

/// The mean of the rays that a film point gets. What it sees in planes across that ray are spots of light, whose
/// middles lie on this straight line, since each ray is one.
struct MeanRay {
    SceneRay ray;  ///< from where it leaves the lens
    Vec2<double> shows_at;  ///< film point at which the light of the ray's point in focus has its middle, mm
    double light;  ///< irradiance of the film point for unit radiance
};

/// Finds mean rays of film points.
class MeanRays {
public:
    /// `focus`: from the entrance pupil to the plane in focus, mm; may be infinite.
    MeanRays(const LensSystem& lens, double focus);

    /// The light of a film point on the +y axis, of a centred lens of revolution with a round stop.
    FilmBundle bundle(const PupilView& pupil, double film_radius) const;
    /// That of a film point of any lens. Bundles must not outlive this.
    FilmBundle bundle(const PupilGridView& pupil, Vec2<double> film) const;

    /// Nothing where no light arrives.
    std::optional<MeanRay> of(const FilmBundle& bundle) const;

    /// Irradiance of the film point for unit radiance.
    static double light_of(const FilmBundle& bundle);

private:
    struct Part {
        SceneRay ray;
        double area;
    };
    /// Aspheres of a phone lens bend light at the rim so much more that fewer places along a radius would be off by 0.1
    /// um.
    static constexpr BundleSampling kSampling = {24, 12};

    static std::vector<Part> parts_of(const FilmBundle& bundle);

    /// The middle of the light of the point in focus on the ray. Its light enters about where that of the film point
    /// left.
    Vec2<double> middle_of_light(const SceneRay& ray, const std::vector<Part>& parts, bool mirrored) const;

    LensPath<double> to_scene_, to_film_;
    FilmSurface<double> film_;
    double focus_;
};

}  // namespace REALCAM_NAMESPACE
