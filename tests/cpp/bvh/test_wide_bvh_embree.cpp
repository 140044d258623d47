// The BVH of the CUDA backend against Embree.
#if defined(REALCAM_HAS_BVH)

#include <algorithm>
#include <cmath>

#include "bvh_rays.hpp"
#include "doctest/doctest.h"
#include "embree/embree_api.hpp"

using namespace realcam;
using namespace realcam::test;

TEST_CASE("wide BVH: hits are those of Embree") {
    const Mesh mesh = potato(200, 300, {1, 2, 3}, 5, 0.3f);
    const WideBvh bvh = mesh.bvh();
    const RTCDevice device = rtcNewDevice(nullptr);
    const RTCScene scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<Vec3f*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                 sizeof(Vec3f), mesh.positions.size()));
    auto* corners = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), mesh.triangles.size()));
    std::copy(mesh.positions.begin(), mesh.positions.end(), vertices);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) std::copy_n(mesh.triangles[i].vertices, 3, corners + 3 * i);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);

    BvhDraw draw(14);
    int hits = 0, other = 0, wrong = 0;
    double distance = 0, barycentric = 0;
    constexpr int kRays = 64000;
    for (int first = 0; first < kRays; first += 16) {
        RTCRayHit16 packet;
        alignas(64) int valid[16];
        BvhRay rays[16];
        for (int k = 0; k < 16; ++k) {
            const Vec3f from = Vec3f{1, 2, 3} + draw.in_cube(12);
            rays[k] = {from, normalized(Vec3f{1, 2, 3} + draw.in_cube(6) - from)};
            valid[k] = -1;
            packet.ray.org_x[k] = rays[k].origin.x;
            packet.ray.org_y[k] = rays[k].origin.y;
            packet.ray.org_z[k] = rays[k].origin.z;
            packet.ray.dir_x[k] = rays[k].direction.x;
            packet.ray.dir_y[k] = rays[k].direction.y;
            packet.ray.dir_z[k] = rays[k].direction.z;
            packet.ray.tnear[k] = packet.ray.time[k] = 0;
            packet.ray.tfar[k] = kFarAway;
            packet.ray.mask[k] = 0xffffffffu;
            packet.ray.id[k] = packet.ray.flags[k] = 0;
            packet.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
            packet.hit.primID[k] = kNoTriangle;
        }
        intersect16(valid, scene, RayOrder::incoherent, &packet);
        for (int k = 0; k < 16; ++k) {
            const Hit hit = closest_hit(bvh.view(), rays[k].origin, rays[k].direction, kFarAway);
            if (hit.triangle != packet.hit.primID[k]) {
                // Beside an edge either may be right: the exact ray then misses neither by much.
                ++other;
                for (const std::uint32_t t : {hit.triangle, packet.hit.primID[k]}) {
                    if (t == kNoTriangle) {
                        ++wrong;
                        continue;
                    }
                    const double margin = exact_hit(mesh, t, rays[k]).margin;
                    wrong += margin < -2 * uncertainty(mesh, t, rays[k]).barycentric;
                }
                continue;
            }
            if (hit.triangle == kNoTriangle) continue;
            ++hits;
            const Uncertainty may = uncertainty(mesh, hit.triangle, rays[k]);
            const auto off = [](float a, float b) {
                return std::fabs(static_cast<double>(a) - static_cast<double>(b));
            };
            distance = std::max(distance, off(hit.distance, packet.ray.tfar[k]) / may.distance);
            barycentric = std::max({barycentric, off(hit.u, packet.hit.u[k]) / may.barycentric,
                                    off(hit.v, packet.hit.v[k]) / may.barycentric});
        }
    }
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
    CHECK(hits > kRays / 5);
    CHECK(other < kRays / 1000);
    CHECK(wrong == 0);
    // In units of 16 roundings, each of the two being off by up to one.
    CHECK(distance < 2);
    CHECK(barycentric < 2);
}

#endif
