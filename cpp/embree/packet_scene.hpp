#pragma once
#include "../render/path/path_state.hpp"
#include "embree_api.hpp"

namespace REALCAM_NAMESPACE {

/// The `scene` argument of render_samples on a CPU: intersects the rays of a block with Embree, in packets of 16.
template <SceneKind scene_kind>
struct PacketScene {
    RTCScene scene;
    std::uint32_t instance_count;  ///< number of the scene's instances; the static geometry has the next id
    RayOrder order;  ///< of the next rays
    std::uint64_t rays_traced;  ///< counter, incremented by each function

    /// Finds the closest hits of the active rays. The hits of inactive rays are undefined.
    template <int N>
    void intersect(const SceneRays<N>& rays, Hits<N>& hits) {
        for (int first = 0; first < N; first += 16) {
            RTCRayHit16 packet;
            alignas(64) int valid[16];
            const int used = load(rays, first, packet.ray, valid);
            if (used == 0) continue;
            REALCAM_LANES
            for (int k = 0; k < 16; ++k) {
                packet.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
                packet.hit.primID[k] = kNoTriangle;
                packet.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
            }
            intersect16(valid, scene, order, &packet);
            REALCAM_LANES
            for (int k = 0; k < 16; ++k) {
                hits.distance[first + k] = packet.ray.tfar[k];
                hits.triangle[first + k] = packet.hit.primID[k];
                hits.u[first + k] = packet.hit.u[k];
                hits.v[first + k] = packet.hit.v[k];
                // Static geometry follows the objects' instances, or is alone and not an instance.
                const std::uint32_t instance = packet.hit.instID[0][k];
                hits.instance[first + k] = instance < instance_count ? instance : kNoInstance;
            }
            rays_traced += static_cast<std::uint64_t>(used);
        }
        order = RayOrder::incoherent;  // all rays after the camera rays
    }

    /// Sets `is_occluded` to 1 for occluded rays, and to 0 for unoccluded and for inactive rays.
    template <int N>
    void occluded(const SceneRays<N>& rays, std::int32_t (&is_occluded)[N]) {
        for (int first = 0; first < N; first += 16) {
            RTCRay16 packet;
            alignas(64) int valid[16];
            const int used = load(rays, first, packet, valid);
            if (used > 0) occluded16(valid, scene, order, &packet);
            REALCAM_LANES
            for (int k = 0; k < 16; ++k)
                is_occluded[first + k] = packet.tfar[k] < 0.0f ? 1 : 0;  // set by Embree on a hit
            rays_traced += static_cast<std::uint64_t>(used);
        }
    }

private:
    /// Loads a packet, with zeros for inactive rays, whose values are undefined. Returns the number of active rays.
    template <int N>
    static int load(const SceneRays<N>& rays, int first, RTCRay16& packet, int (&valid)[16]) {
        int used = 0;
        REALCAM_LANES
        for (int k = 0; k < 16; ++k) {
            const int i = first + k;
            const bool on = rays.active[i] != 0;
            packet.org_x[k] = on ? rays.origin.x[i] : 0.0f;
            packet.org_y[k] = on ? rays.origin.y[i] : 0.0f;
            packet.org_z[k] = on ? rays.origin.z[i] : 0.0f;
            packet.dir_x[k] = on ? rays.direction.x[i] : 0.0f;
            packet.dir_y[k] = on ? rays.direction.y[i] : 0.0f;
            packet.dir_z[k] = on ? rays.direction.z[i] : 0.0f;
            packet.tnear[k] = 0.0f;
            packet.tfar[k] = on ? rays.far[i] : 0.0f;
            packet.time[k] = scene_kind == SceneKind::any && on ? rays.time[i] : 0.0f;
            packet.mask[k] = 0xffffffffu;
            packet.id[k] = scene_kind == SceneKind::any && on ? rays.number[i] : 0;  // for the filter of EmbreeScene
            packet.flags[k] = 0;
            valid[k] = on ? -1 : 0;
            used += on ? 1 : 0;
        }
        return used;
    }
};

}  // namespace REALCAM_NAMESPACE
