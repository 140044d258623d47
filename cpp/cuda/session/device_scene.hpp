#pragma once
#include <vector>

#include "../../bvh/scene_bvh.hpp"
#include "../../scene/render_space/scene_arrays.hpp"
#include "../device/cuda_stream.hpp"
#include "../device/device_array.hpp"

namespace realcam {

/// One GPU's copy of a scene and its BVHs. The host's data may be freed when a function has returned. All functions
/// throw DeviceError.
class DeviceScene {
public:
    /// Copies a scene and its BVHs to the current device. Synchronous.
    void set(const RenderSpaceScene& scene, const SceneBvh& bvh, CudaStream& stream);
    /// Updates only the data that depend on instance transforms.
    void set_instances(const RenderSpaceScene& scene, const SceneBvh& bvh, CudaStream& stream);

    const SceneView& view() const { return view_; }
    const SceneBvhView& bvh() const { return bvh_; }

private:
    DeviceArrays arrays_, instance_arrays_;
    SceneView view_{};
    SceneBvhView bvh_{};
    std::vector<WideBvhView> objects_;  ///< BVHs of the objects, in the GPU's memory
};

}  // namespace realcam
