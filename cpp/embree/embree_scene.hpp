#pragma once
#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include "../scene/render_space/render_space_scene.hpp"
#include "embree_api.hpp"

namespace realcam {

/// Returns a new device of Embree, to be released by rtcReleaseDevice. Throws DeviceError if there is none.
RTCDevice new_embree_device();

/// Scene in render space with its Embree BVHs: one for the static geometry and, if there are instances, one for each
/// object and one over all instances.
class EmbreeScene {
public:
    /// Builds the BVHs. `origin_m`: origin of render space in the scene; `exposure`: time interval of the motion.
    /// `stop` must outlive this object. Throws DeviceError if Embree fails (out of memory, for example), the errors of
    /// RenderSpaceScene, and Cancelled if `stop` becomes true here or in move.
    EmbreeScene(RTCDevice device, const Assembly& assembly, Vec3d origin_m, TimeInterval exposure,
                const std::atomic<bool>& stop);

    /// The scene in render space.
    const RenderSpaceScene& placed() const { return placed_; }
    /// Embree's scene, for ray queries: that of all instances or, without instances, of the static geometry.
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

    /// Returns an empty scene with the flags that all scenes have.
    OwnScene new_scene() const;
    /// Builds the BVH of a mesh.
    OwnScene build(const RenderSpaceMesh& mesh);
    /// Attaches a mesh to `all_` as an instance. `id`: its index in RenderSpaceScene's instances; the static geometry
    /// has the id after the last instance.
    OwnGeometry attach(const OwnScene& mesh, unsigned id) const;
    /// Sets the transforms of all instances, and builds the BVH over them.
    void commit_instances();
    /// Builds a scene's BVH. Throws as check.
    void commit(const OwnScene& scene) const;
    /// Throws Cancelled if a stop is requested, and DeviceError if Embree has reported an error.
    void check() const;

    /// User data of Embree's filter function, for a mesh with holes.
    struct MeshWithHoles {
        MeshView mesh;
        std::uint32_t instance_count;  ///< larger ids are that of the static geometry
    };
    /// Filter function: rejects hits at which a ray passes through a partly opaque surface (stops_ray).
    static void filter_holes(const RTCFilterFunctionNArguments* hits);

    RTCDevice device_;
    const std::atomic<bool>& stop_;
    RenderSpaceScene placed_;
    std::deque<MeshWithHoles> with_holes_;  ///< a deque, because Embree's geometries hold pointers to the elements
    std::vector<OwnScene> meshes_;  ///< static geometry, then the objects
    OwnScene all_;  ///< scene of all instances; null if there is only static geometry
    std::vector<OwnGeometry> instances_;
};

}  // namespace realcam
