#pragma once
// Ray queries in packets of 16, for Embree 3 and 4 alike.
#if REALCAM_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Hint about a packet's rays: coherent rays (of a camera) traverse the same part of the scene.
enum class RayOrder { coherent, incoherent };

/// Finds the closest hits of a packet. `valid`: -1 for each ray that is traced, else 0.
inline void intersect16(const int* valid, RTCScene scene, RayOrder order, RTCRayHit16* rays) {
#if REALCAM_EMBREE_MAJOR >= 4
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.flags = order == RayOrder::coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    rtcIntersect16(valid, scene, rays, &arguments);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags =
        order == RayOrder::coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    rtcIntersect16(valid, scene, &context, rays);
#endif
}

/// Tests a packet for occlusion: sets tfar of occluded rays to minus infinity. `valid`: as in intersect16.
inline void occluded16(const int* valid, RTCScene scene, RayOrder order, RTCRay16* rays) {
#if REALCAM_EMBREE_MAJOR >= 4
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.flags = order == RayOrder::coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    rtcOccluded16(valid, scene, rays, &arguments);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags =
        order == RayOrder::coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    rtcOccluded16(valid, scene, &context, rays);
#endif
}

}  // namespace REALCAM_NAMESPACE
