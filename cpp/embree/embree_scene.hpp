#pragma once
#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include "../scene/render_space/render_space_scene.hpp"
#include "embree_api.hpp"

namespace realcam {

/// Scene in render space with its Embree BVHs: one for the static geometry and, if there are instances, one for each
/// object and one over all instances.
class EmbreeScene {
public:
    /// Throws DeviceError if Embree fails (out of memory, for example), the errors of RenderSpaceScene, and Cancelled
    /// if `stop` becomes true here or in move.
    EmbreeScene(RTCDevice device, const Assembly& assembly, Vec3d origin_m, TimeInterval exposure,
                const std::atomic<bool>& stop);

    const RenderSpaceScene& placed() const { return placed_; }
    RTCScene handle() const { return all_ ? all_.get() : meshes_.front().get(); }

    /// Updates the instances' transforms; see RenderSpaceScene::move.
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
    /// Attaches a mesh to `all_` as an instance. Its id is the index in RenderSpaceScene's instances; the static
    /// geometry's follows the last one.
    OwnGeometry attach(const OwnScene& mesh, unsigned number) const;
    void add_instances();
    void commit(const OwnScene& scene) const;
    void check() const;

    /// User data of Embree's filter function, for a mesh with holes.
    struct MeshWithHoles {
        MeshView mesh;
        std::uint32_t instance_count;
    };
    static void let_through(const RTCFilterFunctionNArguments* hits);

    RTCDevice device_;
    const std::atomic<bool>& stop_;
    RenderSpaceScene placed_;
    std::deque<MeshWithHoles> with_holes_;  ///< a deque, because Embree's geometries hold pointers to the elements
    std::vector<OwnScene> meshes_;  ///< static geometry, then the objects
    OwnScene all_;  ///< null if there is only static geometry
    std::vector<OwnGeometry> instances_;
};

}  // namespace realcam
