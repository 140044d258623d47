#pragma once
#include <optional>
#include <vector>

#include "../optics/analysis/film_chief_ray.hpp"
#include "../optics/pupil/bundle_quadrature.hpp"
#include "../optics/pupil/pupil_view.hpp"

namespace REALCAM_NAMESPACE {

/// The mean of the rays that a film point gets. What it sees in planes across that ray are spots of light, whose
/// middles lie on this straight line, since each ray is one.
struct MeanRay {
    SceneRay ray;  ///< from where it leaves the lens
    double shows_at;  ///< film radius at which the light of the ray's point in focus has its middle, mm
    double light;  ///< irradiance of the film point for unit radiance
};

/// Finds mean rays of film points on the +x axis, through a lens with a round stop.
class MeanRays {
public:
    /// `focus`: from the entrance pupil to the plane in focus, mm; may be infinite.
    MeanRays(const LensSystem& lens, const PupilView& pupil, double focus);

    /// Nothing where no light arrives.
    std::optional<MeanRay> at(double film_radius) const;

private:
    struct Part {
        SceneRay ray;
        double area;
    };
    /// Aspheres of a phone lens bend light at the rim so much more that fewer places along a radius would be off by 0.1
    /// um.
    static constexpr BundleSampling kSampling = {24, 12};

    static Vec3d across_from(Vec3d towards) { return {-towards.z, 0, towards.x}; }

    std::vector<Part> parts_at(double film_radius) const;

    /// The middle of the light of the point in focus on the ray. Its light enters about where that of the film point
    /// left.
    double middle_of_light(const SceneRay& ray, const std::vector<Part>& parts) const;

    LensPath<double> to_scene_, to_film_;
    PupilView pupil_;
    double film_distance_, focus_;
};

}  // namespace REALCAM_NAMESPACE
