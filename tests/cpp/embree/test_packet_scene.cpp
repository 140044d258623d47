// Ray packets for Embree: inactive rays are not read, and their results are defined nevertheless.
#if defined(REALCAM_HAS_BVH)

#include "doctest/doctest.h"
#include "embree/packet_scene.hpp"

using namespace realcam;

namespace {

constexpr int kRays = 64;

/// A triangle in the plane z = 1 about the axis.
struct OneTriangle {
    RTCDevice device = rtcNewDevice(nullptr);
    RTCScene scene = rtcNewScene(device);

    OneTriangle() {
        RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* p = static_cast<float*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), 3));
        auto* corners = static_cast<unsigned*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), 1));
        const float places[] = {-1, -1, 1, 1, -1, 1, 0, 1, 1};
        for (int i = 0; i < 9; ++i) p[i] = places[i];
        for (unsigned i = 0; i < 3; ++i) corners[i] = i;
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene);
    }
    ~OneTriangle() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }
};

}  // namespace

TEST_CASE("shadow rays that are left out are not hidden, in packets of their own too") {
    const OneTriangle world;
    SceneRays<kRays> rays;
    for (int i = 0; i < kRays; ++i) {
        // The second packet has no active ray, the third has one, half of the fourth's are active; half of all point
        // away from the triangle.
        rays.active[i] = i < 16 || i == 40 || (i >= 48 && i % 2 == 0);
        if (!rays.active[i]) continue;
        rays.origin.set(i, {0, 0, 0});
        rays.direction.set(i, {0, 0, i % 4 < 2 ? 1.0f : -1.0f});
        rays.far[i] = 10;
    }
    std::int32_t hidden[kRays];
    for (std::int32_t& h : hidden) h = 77;
    PacketScene<SceneKind::opaque> packets{world.scene, 0, RayOrder::incoherent, 0};
    packets.occluded(rays, hidden);
    for (int i = 0; i < kRays; ++i) {
        CAPTURE(i);
        CHECK(hidden[i] == (rays.active[i] && i % 4 < 2 ? 1 : 0));
    }
    CHECK(packets.rays_traced == 16 + 1 + 8);
}

#endif
