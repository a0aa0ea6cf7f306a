// Packet<K>: K rays that Embree traces by one call, under common names for Embree 3 and 4.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

#include "montelux/accel/embree.h"
#include "montelux/scene/shape/ray.h"

namespace montelux {

// `coherent`: the rays of a packet are similar. If not, each is traversed as if alone, and its hit is the
// same to the last bit whichever other rays are in the packet; coherent packets may choose otherwise among
// equally near primitives.
#if MONTELUX_EMBREE >= 4
struct QueryContext {
    RTCIntersectArguments closest;
    RTCOccludedArguments any;
    explicit QueryContext(bool coherent = false) {
        rtcInitIntersectArguments(&closest);
        rtcInitOccludedArguments(&any);
        closest.flags = any.flags = coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    }
};
#define MONTELUX_CLOSEST(K) rtcIntersect##K(valid.data(), scene, &embree, &context.closest)
#define MONTELUX_ANY(K) rtcOccluded##K(valid.data(), scene, &embree.ray, &context.any)
#else
struct QueryContext {
    RTCIntersectContext context;
    explicit QueryContext(bool coherent = false) {
        rtcInitIntersectContext(&context);
        context.flags =
            coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    }
};
#define MONTELUX_CLOSEST(K) rtcIntersect##K(valid.data(), scene, &context.context, &embree)
#define MONTELUX_ANY(K) rtcOccluded##K(valid.data(), scene, &context.context, &embree.ray)
#endif

template <std::size_t K>
struct EmbreePacket;
#define MONTELUX_PACKET(K)                                                                                   \
    template <>                                                                                              \
    struct EmbreePacket<K> {                                                                                 \
        RTCRayHit##K embree{};                                                                               \
        alignas(64) std::array<int, K> valid{};                                                              \
        void closest(RTCScene scene, QueryContext& context) { MONTELUX_CLOSEST(K); }                         \
        void any(RTCScene scene, QueryContext& context) { MONTELUX_ANY(K); }                                 \
    };
MONTELUX_PACKET(4)
MONTELUX_PACKET(8)
MONTELUX_PACKET(16)
#undef MONTELUX_PACKET
#undef MONTELUX_CLOSEST
#undef MONTELUX_ANY

// What Embree reports of a hit; for occlusion rays t alone, minus infinity if occluded.
struct BareHit {
    float t = 0, u = 0, v = 0;
    unsigned shape = RTC_INVALID_GEOMETRY_ID, primitive = 0, instance = RTC_INVALID_GEOMETRY_ID;
};

template <std::size_t K>
struct Packet : EmbreePacket<K> {
    // At least one ray, at most K.
    explicit Packet(std::span<const Ray* const> rays) {
        auto& r = this->embree.ray;
        for (std::size_t i = 0; i < K; ++i) {
            this->valid[i] = i < rays.size() ? -1 : 0;
            const Ray& ray = *rays[std::min(i, rays.size() - 1)];
            r.org_x[i] = ray.o.x;
            r.org_y[i] = ray.o.y;
            r.org_z[i] = ray.o.z;
            r.dir_x[i] = ray.d.x;
            r.dir_y[i] = ray.d.y;
            r.dir_z[i] = ray.d.z;
            r.tnear[i] = 0;
            r.tfar[i] = ray.t_max;
            r.time[i] = ray.time;
            r.mask[i] = ~0u;
            r.id[i] = r.flags[i] = 0;
            this->embree.hit.geomID[i] = this->embree.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
        }
    }
    BareHit hit(std::size_t i) const {
        const auto& h = this->embree.hit;
        if (h.geomID[i] == RTC_INVALID_GEOMETRY_ID) return {.t = this->embree.ray.tfar[i]};
        return {this->embree.ray.tfar[i], h.u[i], h.v[i], h.geomID[i], h.primID[i], h.instID[0][i]};
    }
};

// One ray, by Embree's calls for single rays.
template <>
struct Packet<1> {
    RTCRayHit embree;

    explicit Packet(const Ray& r) {
        embree.ray = {.org_x = r.o.x,
                      .org_y = r.o.y,
                      .org_z = r.o.z,
                      .tnear = 0,
                      .dir_x = r.d.x,
                      .dir_y = r.d.y,
                      .dir_z = r.d.z,
                      .time = r.time,
                      .tfar = r.t_max,
                      .mask = ~0u,
                      .id = 0,
                      .flags = 0};
        embree.hit.geomID = embree.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    }
    explicit Packet(std::span<const Ray* const> rays) : Packet(*rays[0]) {}
    void closest(RTCScene scene, QueryContext&) { closest_hit(scene, embree); }
    void any(RTCScene scene, QueryContext&) { any_hit(scene, embree.ray); }
    BareHit hit(std::size_t = 0) const {
        if (embree.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {.t = embree.ray.tfar};
        return {embree.ray.tfar,   embree.hit.u,      embree.hit.v,
                embree.hit.geomID, embree.hit.primID, embree.hit.instID[0]};
    }
};

} // namespace montelux
