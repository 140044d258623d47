#pragma once
#include <array>
#include <optional>
#include <vector>

#include "../../camera/camera_setup.hpp"
#include "light_groups.hpp"

namespace REALCAM_NAMESPACE {

/// A light with its entry rectangle.
struct FoundLight {
    TracedLight light;
    double pixels;  ///< pixels of the film that its light covers
};

/// Searches for the area in which the light of lamps enters the lens, by tracing rays from them: first around the area
/// in which rays of the pupil leave the lens in their direction, then in the rectangle that contains the hits. If the
/// hits reach the border of the searched rectangle, it is enlarged.
class LightEntries {
public:
    /// `camera`: that of `setup`.
    LightEntries(const SceneView& scene, const CameraView& camera, const CameraSetup& setup, const PupilTracer& tracer);

    /// Returns std::nullopt if no light of the group reaches the film.
    std::optional<FoundLight> of(const LightGroup& group) const;

private:
    /// Hits of rays through a rectangle.
    struct Probe {
        int hits = 0;
        PlaneRectangle entries{}, film{};  ///< bounds of the hits: at the entry, mm, and on the film, pixels
    };

    using Positions = std::array<Vec3f, 64>;

    /// Point of the group in the lens's frame, mm; for a sun, the direction towards it.
    Vec3f sample_position(const LightGroup& group, std::uint32_t number) const;
    Probe probe(const Positions& positions, const TracedLight& light, const PlaneRectangle& in, int rays) const;

    const SceneView& scene_;
    const CameraView& camera_;
    LensView<float> to_film_;
    const PupilTracer& tracer_;
    const PupilEntries* pupil_entries_;  ///< for a rotationally symmetric lens; otherwise null
    float front_reach_;  ///< radius of a circle that contains all points at which light enters the lens, mm
};

}  // namespace REALCAM_NAMESPACE
