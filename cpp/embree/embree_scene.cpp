#include "embree_scene.hpp"

#include <algorithm>

#include "../error.hpp"
#include "../scene/geometry/opacity.hpp"

namespace realcam {

RTCDevice new_embree_device() {
    const RTCDevice device = rtcNewDevice(nullptr);
    if (device) return device;
    const RTCError code = rtcGetDeviceError(nullptr);
    throw DeviceError("Embree could not be started: " + (code == RTC_ERROR_OUT_OF_MEMORY
                                                             ? std::string("out of memory")
                                                             : "error " + std::to_string(code)));
}

void EmbreeScene::check() const {
    const RTCError code = rtcGetDeviceError(device_);
    if (stop_ || code == RTC_ERROR_CANCELLED) throw Cancelled();
    if (code == RTC_ERROR_NONE) return;
    if (code == RTC_ERROR_OUT_OF_MEMORY) throw DeviceError("Embree ran out of memory while it built the scene's BVH");
    throw DeviceError("Embree could not build the scene's BVH (error " + std::to_string(code) + ")");
}

EmbreeScene::OwnScene EmbreeScene::new_scene() const {
    OwnScene scene(rtcNewScene(device_));
    // Robust: rays that hit an edge or the corner of a sliver must not slip between two triangles.
    rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene.get(), RTC_BUILD_QUALITY_MEDIUM);
    return scene;
}

void EmbreeScene::commit(const OwnScene& scene) const {
    const auto continues = [](void* stop, double) { return !*static_cast<const std::atomic<bool>*>(stop); };
    rtcSetSceneProgressMonitorFunction(scene.get(), continues, const_cast<std::atomic<bool>*>(&stop_));
    rtcCommitScene(scene.get());
    check();
}

void EmbreeScene::filter_holes(const RTCFilterFunctionNArguments* hits) {
    const auto& [mesh, instance_count] = *static_cast<const MeshWithHoles*>(hits->geometryUserPtr);
    for (unsigned i = 0; i < hits->N; ++i) {
        if (hits->valid[i] == 0) continue;
        const std::uint32_t instance = RTCHitN_instID(hits->hit, hits->N, i, 0);
        const Hit hit = {0.0f, RTCHitN_primID(hits->hit, hits->N, i), RTCHitN_u(hits->hit, hits->N, i),
                         RTCHitN_v(hits->hit, hits->N, i), instance < instance_count ? instance : kNoInstance};
        if (!stops_ray(mesh, hit, RTCRayN_id(hits->ray, hits->N, i))) hits->valid[i] = 0;
    }
}

EmbreeScene::OwnScene EmbreeScene::build(const RenderSpaceMesh& mesh) {
    OwnScene scene = new_scene();
    const auto& positions = mesh.positions();
    const auto& triangles = mesh.triangles();
    if (triangles.empty()) {
        commit(scene);
        return scene;
    }
    const OwnGeometry geometry(rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE));
    // Embree reads the mesh's own arrays, which it does not write.
    rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, positions.data(), 0,
                               sizeof(Vec3f), positions.size());
    rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, triangles.data(), 0,
                               sizeof(Triangle), triangles.size());
    if (mesh.has_holes()) {
        with_holes_.push_back({mesh.view(), static_cast<std::uint32_t>(placed_.instances().size())});
        rtcSetGeometryUserData(geometry.get(), &with_holes_.back());
        rtcSetGeometryIntersectFilterFunction(geometry.get(), filter_holes);
        rtcSetGeometryOccludedFilterFunction(geometry.get(), filter_holes);
    }
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometry(scene.get(), geometry.get());
    commit(scene);
    check();
    return scene;
}

EmbreeScene::EmbreeScene(RTCDevice device, const Assembly& assembly, Vec3d origin_m, TimeInterval exposure,
                         const std::atomic<bool>& stop)
    : device_(device), stop_(stop), placed_(assembly, origin_m, exposure, [&] { return !stop; }) {
    check();
    meshes_.push_back(build(placed_.static_geometry()));
    for (const auto& object : placed_.objects()) meshes_.push_back(build(*object));
    const auto& instances = placed_.instances();
    if (instances.empty()) return;
    all_ = new_scene();
    for (std::size_t i = 0; i < instances.size(); ++i) {
        if (stop_) throw Cancelled();
        instances_.push_back(attach(meshes_[1 + instances[i].object], static_cast<unsigned>(i)));
    }
    if (!placed_.static_geometry().triangles().empty()) {
        const OwnGeometry static_geometry = attach(meshes_.front(), static_cast<unsigned>(instances.size()));
        rtcCommitGeometry(static_geometry.get());
    }
    commit_instances();
}

EmbreeScene::OwnGeometry EmbreeScene::attach(const OwnScene& mesh, unsigned id) const {
    OwnGeometry geometry(rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE));
    rtcSetGeometryInstancedScene(geometry.get(), mesh.get());
    rtcAttachGeometryByID(all_.get(), geometry.get(), id);
    return geometry;
}

void EmbreeScene::commit_instances() {
    for (std::size_t i = 0; i < instances_.size(); ++i) {
        if (stop_) throw Cancelled();
        const InstanceView& instance = placed_.instances()[i];
        const Affine<float>* const keys =
            instance.key_count > 0 ? &placed_.keys()[static_cast<std::size_t>(instance.first_key)] : nullptr;
        const auto count = static_cast<unsigned>(std::max(instance.key_count, 1));
        static_assert(sizeof(Affine<float>) == 12 * sizeof(float));
        rtcSetGeometryTimeStepCount(instances_[i].get(), count);
        for (unsigned k = 0; k < count; ++k)
            rtcSetGeometryTransform(instances_[i].get(), k, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR,
                                    keys ? keys + k : &instance.render_from_object);
        rtcCommitGeometry(instances_[i].get());
    }
    commit(all_);
}

void EmbreeScene::move(const Assembly& assembly, TimeInterval exposure) {
    placed_.move(assembly, exposure);
    if (all_) commit_instances();
}

}  // namespace realcam
