#include "embree_scene.hpp"

#include <cstring>

#include "../error.hpp"

namespace realcam {
namespace {

void check(RTCDevice device) {
    const RTCError code = rtcGetDeviceError(device);
    if (code == RTC_ERROR_NONE) return;
    if (code == RTC_ERROR_OUT_OF_MEMORY) throw DeviceError("Embree ran out of memory while it built the scene's BVH");
    throw DeviceError("Embree could not build the scene's BVH (error " + std::to_string(code) + ")");
}

}  // namespace

EmbreeScene::EmbreeScene(RTCDevice device, std::shared_ptr<const Scene> scene, Vec3d origin_m)
    : scene_(std::move(scene)), placed_(*scene_, origin_m), handle_(rtcNewScene(device)) {
    // Robust: rays that hit an edge or a sliver's corner must not slip between two triangles.
    rtcSetSceneFlags(handle_, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(handle_, RTC_BUILD_QUALITY_MEDIUM);
    const auto& positions = placed_.positions();
    const auto& triangles = placed_.triangles();
    const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<Vec3f*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                 sizeof(Vec3f), positions.size()));
    auto* corners = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), triangles.size()));
    if (vertices && corners) {
        std::copy(positions.begin(), positions.end(), vertices);
        for (std::size_t i = 0; i < triangles.size(); ++i) std::copy_n(triangles[i].vertices, 3, corners + 3 * i);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(handle_, geometry);
        rtcCommitScene(handle_);
    }
    rtcReleaseGeometry(geometry);
    try {
        check(device);
    } catch (...) {
        rtcReleaseScene(handle_);
        throw;
    }
}

EmbreeScene::~EmbreeScene() {
    rtcReleaseScene(handle_);
}

}  // namespace realcam
