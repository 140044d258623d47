#pragma once
#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include "../scene/render_space_scene.hpp"
#include "embree_api.hpp"

namespace realcam {

/// A scene in render space with its Embree BVHs: one for static geometry and, where there are instances, one for each
/// object and one over them all.
class EmbreeScene {
public:
    /// Throws DeviceError (out of memory, for one), what RenderSpaceScene throws, and Cancelled where `stop` becomes
    /// true meanwhile, or in move.
    EmbreeScene(RTCDevice device, const Assembly& assembly, Vec3d origin_m, TimeInterval exposure,
                const std::atomic<bool>& stop);

    const RenderSpaceScene& placed() const { return placed_; }
    RTCScene handle() const { return all_ ? all_.get() : meshes_.front().get(); }

    /// As RenderSpaceScene::move.
    void move(const Assembly& assembly, TimeInterval exposure);

private:
    struct Release {
        void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
        void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
    };
    using OwnScene = std::unique_ptr<RTCSceneTy, Release>;
    using OwnGeometry = std::unique_ptr<RTCGeometryTy, Release>;

    OwnScene new_scene() const;
    OwnScene build(const RenderSpaceMesh& mesh);
    /// Makes a geometry of `all_` an instance. Its number is that of RenderSpaceScene's; static geometry's follows on
    /// the last.
    OwnGeometry attach(const OwnScene& mesh, unsigned number) const;
    void add_instances();
    void commit(const OwnScene& scene) const;
    void check() const;

    /// What Embree's filter needs to know of a mesh with holes.
    struct MeshWithHoles {
        MeshView mesh;
        std::uint32_t instance_count;
    };
    static void let_through(const RTCFilterFunctionNArguments* hits);

    RTCDevice device_;
    const std::atomic<bool>& stop_;
    RenderSpaceScene placed_;
    std::deque<MeshWithHoles> with_holes_;  ///< their geometries know the addresses
    std::vector<OwnScene> meshes_;  ///< static geometry, then the objects
    OwnScene all_;  ///< null where there is only static geometry
    std::vector<OwnGeometry> instances_;
};

}  // namespace realcam
