// Worlds that move compared with worlds that stand still as they are at the rays' times.
#pragma once

#include "test/accel/accel_testing.h"
#include <gtest/gtest.h>
#include <map>

namespace montelux::testing {

struct HitCounts {
    int rays = 0;
    int other = 0;                  // where the worlds differ in what is hit
    std::map<Index, int> instances; // hits of both; no_index: of the world's own shapes

    int hits() const {
        int sum = 0;
        for (const auto& [instance, count] : instances) sum += count;
        return sum;
    }
};

// Sends `rays` rays at each of five times through both worlds, from a cube of half side `reach`; both are of size
// `scale`. still(time): the scene as it is at that time. more(p, q): further checks of the points of a hit.
template <typename Still, typename More>
void compare_with_still(const World& moving, const Still& still, double scale, float reach, int rays,
                        HitCounts& counts, const More& more) {
    Draws draws(9);
    const auto s = static_cast<float>(scale);
    for (const float time : {0.0f, 0.123f, 0.5f, 0.77f, 1.0f}) {
        const World at_time(still(time));
        for (int i = 0; i < rays; ++i, ++counts.rays) {
            const Ray ray{s * draws.in_cube(reach), draws.direction(), 1e30f, time};
            Hit a, b;
            const bool hit_a = moving.accelerator.intersect(ray, a);
            const bool hit_b = at_time.accelerator.intersect(ray, b);
            ASSERT_EQ(moving.accelerator.occluded(ray), hit_a);
            if (hit_a != hit_b ||
                (hit_a && (a.shape != b.shape || a.primitive != b.primitive || a.instance != b.instance))) {
                ++counts.other;
                continue;
            }
            if (!hit_a) continue;
            ++counts.instances[a.instance];
            const SurfacePoint p = surface_point(moving.tables.view(), ray, a, true);
            const SurfacePoint q = surface_point(at_time.tables.view(), ray, b, true);
            ASSERT_LT(length(p.p - q.p), 1e-4f * s) << scale << " " << time;
            ASSERT_LT(length(p.p - (ray.o + ray.d * a.t)), 1e-4f * s) << scale << " " << time;
            ASSERT_GT(dot(p.ng, q.ng), 0.999f);
            ASSERT_GT(dot(p.ns, q.ns), 0.999f);
            ASSERT_NO_FATAL_FAILURE(more(p, q));
        }
    }
}

} // namespace montelux::testing
