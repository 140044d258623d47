#pragma once
#include <memory>
#include <vector>

#include "../scene/placed_scene.hpp"
#include "embree_api.hpp"

namespace realcam {

/// A placed scene with its Embree BVHs: one for the ground and, where objects stand on it, one for each of them and one
/// over them all.
class EmbreeScene {
public:
    /// Throws DeviceError (out of memory, for one).
    EmbreeScene(RTCDevice device, const Assembly& assembly, Vec3d origin_m);

    const PlacedScene& placed() const { return placed_; }
    RTCScene handle() const { return all_ ? all_.get() : meshes_.front().get(); }

    /// As PlacedScene::move.
    void move(const Assembly& assembly);

private:
    struct Release {
        void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
        void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
    };
    using OwnScene = std::unique_ptr<RTCSceneTy, Release>;
    using OwnGeometry = std::unique_ptr<RTCGeometryTy, Release>;

    OwnScene new_scene() const;
    OwnScene build(const PlacedMesh& mesh) const;
    /// Makes a geometry of `all_` an instance. Its number is that of PlacedScene's; the ground's follows on the last.
    OwnGeometry attach(const OwnScene& mesh, unsigned number) const;
    void stand_objects();
    void check() const;

    RTCDevice device_;
    PlacedScene placed_;
    std::vector<OwnScene> meshes_;  ///< the ground, then the objects
    OwnScene all_;  ///< null where there is only the ground
    std::vector<OwnGeometry> instances_;
};

}  // namespace realcam
