// Embree 3 and 4 under common names: the header of either, and the calls in which they differ.
#pragma once

#if !defined(MONTELUX_EMBREE)
#error "MONTELUX_EMBREE must be Embree's major version; cmake/MonteluxEmbree.cmake sets it"
#elif MONTELUX_EMBREE >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace montelux {

#if MONTELUX_EMBREE >= 4

inline void closest_hit(RTCScene scene, RTCRayHit& ray) { rtcIntersect1(scene, &ray); }
inline void any_hit(RTCScene scene, RTCRay& ray) { rtcOccluded1(scene, &ray); }

#else

inline void closest_hit(RTCScene scene, RTCRayHit& ray) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene, &context, &ray);
}
inline void any_hit(RTCScene scene, RTCRay& ray) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene, &context, &ray);
}

#endif

} // namespace montelux
