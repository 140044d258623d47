#pragma once
// Wraps the difference between the queries of Embree 3 and 4.
#if REALCAM_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

enum class RayOrder { coherent, incoherent };

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
