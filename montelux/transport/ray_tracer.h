// RayTracer: the accelerator, with counts of its rays and times of a few of them.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>

#include "montelux/accel/accelerator.h"

namespace montelux {

struct RayStatistics {
    std::uint64_t closest = 0, occlusion = 0;
    std::uint64_t timed = 0; // rays that were timed
    double timed_seconds = 0;

    void merge(const RayStatistics& other) {
        closest += other.closest;
        occlusion += other.occlusion;
        timed += other.timed;
        timed_seconds += other.timed_seconds;
    }
    std::uint64_t rays() const { return closest + occlusion; }
};

// One per thread. Every 256th ray is timed: reading the clock costs as much as a ray.
class RayTracer {
  public:
    explicit RayTracer(const Accelerator& accelerator) : accelerator_(&accelerator) {}

    bool intersect(const Ray& ray, Hit& hit) {
        ++statistics.closest;
        return timed([&] { return accelerator_->intersect(ray, hit); });
    }
    bool occluded(const Ray& ray) {
        ++statistics.occlusion;
        return timed([&] { return accelerator_->occluded(ray); });
    }

    RayStatistics statistics;

  private:
    using Clock = std::chrono::steady_clock;
    static double seconds(Clock::duration d) { return std::chrono::duration<double>(d).count(); }

    template <typename F>
    bool timed(const F& f) {
        if ((statistics.rays() & 255) != 0) return f();
        auto before = Clock::now();
        auto begin = Clock::now();
        bool result = f();
        auto end = Clock::now();
        // Subtracts the time of reading the clock. No ray takes longer than this limit: the thread was
        // interrupted.
        const double taken = std::max(0.0, seconds(end - begin) - seconds(begin - before));
        if (taken < 50e-6) {
            statistics.timed_seconds += taken;
            ++statistics.timed;
        }
        return result;
    }

    const Accelerator* accelerator_;
};

} // namespace montelux
