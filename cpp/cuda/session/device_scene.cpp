#include "device_scene.hpp"

namespace realcam {

void DeviceScene::set(const RenderSpaceScene& scene, const SceneBvh& bvh, CudaStream& stream) {
    arrays_.restart();
    const auto copy = [&](const auto* from, std::size_t count) { return arrays_.copy(from, count, stream); };
    const auto copy_bvh = [&](const WideBvh& mesh) -> WideBvhView {
        return {copy(mesh.nodes.data(), mesh.nodes.size()), copy(mesh.triangles.data(), mesh.triangles.size())};
    };
    view_ = with_copied_arrays(scene.view(), copy);
    bvh_.static_geometry = copy_bvh(bvh.static_geometry);
    objects_.clear();
    for (const WideBvh& object : bvh.objects) objects_.push_back(copy_bvh(object));
    set_instances(scene, bvh, stream);
    stream.wait("copying the scene to it");
}

void DeviceScene::set_instances(const RenderSpaceScene& scene, const SceneBvh& bvh, CudaStream& stream) {
    instance_arrays_.restart();
    const auto copy = [&](const auto* from, std::size_t count) { return instance_arrays_.copy(from, count, stream); };
    static_cast<InstancesView&>(view_) = with_copied_arrays(scene.instances_view(), copy);
    const std::vector<BvhInstance> leaves = bvh_instances(bvh, scene, objects_);
    bvh_.nodes = copy(bvh.instances.nodes.data(), bvh.instances.nodes.size());
    bvh_.instances = copy(leaves.data(), leaves.size());
}

}  // namespace realcam
