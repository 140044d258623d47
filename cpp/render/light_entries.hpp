#pragma once
#include <array>
#include <optional>
#include <vector>

#include "../camera/camera_setup.hpp"
#include "light_groups.hpp"

namespace REALCAM_NAMESPACE {

/// A light with its rectangle of entries.
struct FoundLight {
    TracedLight light;
    double pixels;  ///< of the film, that its light covers
};

/// Looks for where the light of lamps enters the lens, by rays from them: first about where rays of the pupil leave the
/// lens in their direction, then in the rectangle that holds what was found. Where that ends at the border of what was
/// looked at, in more.
class LightEntries {
public:
    /// `camera`: of the set-up.
    LightEntries(const SceneView& scene, const CameraView& camera, const CameraSetup& setup, const PupilTracer& tracer);

    /// Nothing where no light of the group reaches the film.
    std::optional<FoundLight> of(const LightGroup& group) const;

private:
    /// What rays through a rectangle have found.
    struct Probe {
        int hits = 0;
        PlaneRectangle entries{}, film{};  ///< mm; pixels
    };

    using Places = std::array<Vec3f, 64>;

    /// A place of the group in the lens's frame, mm; of a sun the direction towards it.
    Vec3f place_of(const LightGroup& group, std::uint32_t number) const;
    Probe probe(const Places& places, const TracedLight& light, const PlaneRectangle& in, int rays) const;

    const SceneView& scene_;
    const CameraView& camera_;
    LensView<float> to_film_;
    const PupilTracer& tracer_;
    const PupilEntries* pupil_entries_;  ///< of a lens of revolution; else null
    float front_reach_;  ///< radius of a circle that holds all places where light enters the lens, mm
};

}  // namespace REALCAM_NAMESPACE
