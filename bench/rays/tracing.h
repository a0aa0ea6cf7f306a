// Traces recorded rays through Embree, timed, in packets of any size.
#pragma once

#include "bench/rays/recorded_rays.h"
#include <string>
#include <vector>

#include "montelux/accel/embree_scene.h"

namespace montelux::bench {

struct Tracing {
    std::size_t packet = 1; // rays per call: 1, 4, 8 or 16; 0: streams of `RecordedRays::batch` rays
    bool coherent = false;  // Embree is told that the rays of a packet are similar
    std::string name() const;
};
// All that this version of Embree has; streams are in version 3 alone.
std::vector<Tracing> all_tracings();

struct TracingResult {
    double seconds = 0; // CPU time, least of the repetitions
    // Rays whose hit differs in any bit from that of tracing one by one; of occlusion rays, in its answer.
    std::size_t differing = 0;
    // Of these, rays that hit another primitive, or none.
    std::size_t other_primitive = 0;
};

// Of one thread.
TracingResult trace(const EmbreeScene& scene, RayKind kind, const std::vector<Ray>& rays,
                    const Tracing& tracing, int repetitions);

} // namespace montelux::bench
