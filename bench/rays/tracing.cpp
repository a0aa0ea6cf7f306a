#include "bench/rays/tracing.h"

#include <algorithm>
#include <bit>
#include <ctime>
#include <limits>

#include "montelux/accel/packets.h"

namespace montelux::bench {

namespace {

double cpu_seconds() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

std::vector<const Ray*> pointers_to(const std::vector<Ray>& rays) {
    std::vector<const Ray*> pointers;
    pointers.reserve(rays.size());
    for (const Ray& ray : rays) pointers.push_back(&ray);
    return pointers;
}

// In groups of rays that lie in the caches, so that filling and reading packets is not timed.
template <std::size_t K>
double trace_packets(RTCScene scene, bool closest, const std::vector<Ray>& rays, bool coherent,
                     std::vector<BareHit>& hits) {
    std::vector<Packet<K>> packets;
    packets.reserve(RecordedRays::batch / K);
    const std::vector<const Ray*> pointers = pointers_to(rays);
    QueryContext context(coherent);
    double seconds = 0;
    for (std::size_t first = 0; first < rays.size(); first += RecordedRays::batch) {
        const std::size_t end = std::min(rays.size(), first + RecordedRays::batch);
        packets.clear();
        for (std::size_t i = first; i < end; i += K)
            packets.emplace_back(std::span(pointers).subspan(i, std::min(K, end - i)));
        const double begin = cpu_seconds();
        if (closest)
            for (Packet<K>& p : packets) p.closest(scene, context);
        else
            for (Packet<K>& p : packets) p.any(scene, context);
        seconds += cpu_seconds() - begin;
        for (std::size_t i = first; i < end; ++i) hits[i] = packets[(i - first) / K].hit((i - first) % K);
    }
    return seconds;
}

#if MONTELUX_EMBREE < 4
double trace_streams(RTCScene scene, bool closest, const std::vector<Ray>& rays, bool coherent,
                     std::vector<BareHit>& hits) {
    std::vector<Packet<1>> stream;
    stream.reserve(RecordedRays::batch);
    QueryContext context(coherent);
    double seconds = 0;
    for (std::size_t first = 0; first < rays.size(); first += RecordedRays::batch) {
        const std::size_t end = std::min(rays.size(), first + RecordedRays::batch);
        stream.clear();
        for (std::size_t i = first; i < end; ++i) stream.emplace_back(rays[i]);
        const auto count = static_cast<unsigned>(stream.size());
        const double begin = cpu_seconds();
        if (closest)
            rtcIntersect1M(scene, &context.context, &stream[0].embree, count, sizeof stream[0]);
        else
            rtcOccluded1M(scene, &context.context, &stream[0].embree.ray, count, sizeof stream[0]);
        seconds += cpu_seconds() - begin;
        for (std::size_t i = first; i < end; ++i) hits[i] = stream[i - first].hit(0);
    }
    return seconds;
}
#endif

double trace_once(const EmbreeScene& scene, bool closest, const std::vector<Ray>& rays,
                  const Tracing& tracing, std::vector<BareHit>& hits) {
    switch (tracing.packet) {
#if MONTELUX_EMBREE < 4
    case 0:
        return trace_streams(scene.world(), closest, rays, tracing.coherent, hits);
#endif
    case 4:
        return trace_packets<4>(scene.world(), closest, rays, tracing.coherent, hits);
    case 8:
        return trace_packets<8>(scene.world(), closest, rays, tracing.coherent, hits);
    case 16:
        return trace_packets<16>(scene.world(), closest, rays, tracing.coherent, hits);
    default:
        return trace_packets<1>(scene.world(), closest, rays, tracing.coherent, hits);
    }
}

bool same_bits(float a, float b) { return std::bit_cast<unsigned>(a) == std::bit_cast<unsigned>(b); }
bool same_primitive(const BareHit& a, const BareHit& b) {
    return a.shape == b.shape && a.primitive == b.primitive && a.instance == b.instance;
}

} // namespace

std::string Tracing::name() const {
    return (packet == 0 ? "stream" : std::to_string(packet)) + (coherent ? " coherent" : "");
}

std::vector<Tracing> all_tracings() {
    return {
        {1, false}, {4, false}, {8, false}, {16, false}, {16, true},
#if MONTELUX_EMBREE < 4
            {0, false}, {
            0, true
        }
#endif
    };
}

TracingResult trace(const EmbreeScene& scene, RayKind kind, const std::vector<Ray>& rays,
                    const Tracing& tracing, int repetitions) {
    const bool closest = kind != RayKind::shadow;
    std::vector<BareHit> hits(rays.size()), alone(rays.size());
    TracingResult result{.seconds = std::numeric_limits<double>::infinity()};
    for (int i = 0; i < repetitions; ++i)
        result.seconds = std::min(result.seconds, trace_once(scene, closest, rays, tracing, hits));
    trace_once(scene, closest, rays, {}, alone);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const BareHit &a = alone[i], &b = hits[i];
        const bool other = !same_primitive(a, b);
        result.other_primitive += other;
        result.differing += other || !same_bits(a.t, b.t) || !same_bits(a.u, b.u) || !same_bits(a.v, b.v);
    }
    return result;
}

} // namespace montelux::bench
