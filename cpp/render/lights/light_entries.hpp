#pragma once
#include <array>
#include <optional>
#include <vector>

#include "../../camera/camera_setup.hpp"
#include "light_groups.hpp"

namespace REALCAM_NAMESPACE {

/// Traced light whose entrance-pupil bounds (TracedLight::entries) are known.
struct FoundLight {
    TracedLight light;
    double pixels;  ///< number of pixels of the film that its image, blurred by the lens, covers
};

/// Entrance-pupil search for lights: finds the rectangle in which the light of a lamp enters the lens, by tracing rays
/// from the lamp to the film. The search begins around the area in which rays of the camera's own pupil leave the lens
/// in that direction, and is repeated in the rectangle that contains the hits. If the hits reach the border of the
/// searched rectangle, it is enlarged.
class LightEntries {
public:
    /// `camera`: view of the camera of `setup`, in the render space of `scene`. All arguments must outlive this object.
    LightEntries(const SceneView& scene, const CameraView& camera, const CameraSetup& setup, const PupilTracer& tracer);

    /// Finds the bounds of a group of lights. Returns std::nullopt if none of its light reaches the film.
    std::optional<FoundLight> find(const LightGroup& group) const;

private:
    /// Result of rays through a rectangle: those that reach the film are hits.
    struct Probe {
        int hits = 0;
        PlaneRectangle entries{}, film{};  ///< bounds of the hits: at the entry, mm, and on the film, pixels
    };

    /// Point on a light.
    struct LightPosition {
        Vec3f
            from_front;  ///< in the lens frame relative to the front vertex, mm; for a sun, the unit vector towards it
        Vec2f chief_film;  ///< film point of its chief ray (LensPlacement), mm
    };
    /// Points on the lights of a group, as sample_position returns them.
    using Positions = std::array<LightPosition, 64>;

    /// Samples a point on the group's lights. `index`: of the sample.
    LightPosition sample_position(const LightGroup& group, std::uint32_t index) const;
    /// Traces `rays` rays from the positions through random points of the rectangle `in` of the light's entry plane.
    Probe probe(const Positions& positions, const TracedLight& light, const PlaneRectangle& in, int rays) const;

    const SceneView& scene_;
    const CameraView& camera_;
    LensView<float> to_film_;  ///< surfaces of the direct path, from the scene to the film
    const PupilTracer& tracer_;
    const PupilEntryBounds* pupil_entries_;  ///< for a rotationally symmetric lens; otherwise null
    float front_reach_;  ///< radius of a circle that contains all points at which light enters the lens, mm
};

}  // namespace REALCAM_NAMESPACE
