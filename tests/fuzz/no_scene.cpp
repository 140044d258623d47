// Stands in for Embree: no target meets a scene, and the program needs no library that a bare machine lacks.

#include <cstdlib>

#include "embree/embree_api.hpp"

#if REALCAM_EMBREE_MAJOR >= 4
extern "C" void rtcIntersect16(const int*, RTCScene, RTCRayHit16*, RTCIntersectArguments*) {
    std::abort();
}
extern "C" void rtcOccluded16(const int*, RTCScene, RTCRay16*, RTCOccludedArguments*) {
    std::abort();
}
#else
extern "C" void rtcIntersect16(const int*, RTCScene, RTCIntersectContext*, RTCRayHit16*) {
    std::abort();
}
extern "C" void rtcOccluded16(const int*, RTCScene, RTCIntersectContext*, RTCRay16*) {
    std::abort();
}
#endif
