// RayTracer: the accelerator, with counts and times of its rays.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>

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

// One per thread. Of rays traced one by one every 256th is timed: reading the clock costs as much as a ray.
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
    // Many rays at once, as Accelerator; all of them are timed.
    void intersect(std::span<const Ray* const> rays, std::span<Hit> hits) {
        statistics.closest += rays.size();
        time_all(rays.size(), [&] { accelerator_->intersect(rays, hits); });
    }
    void occluded(std::span<const Ray* const> rays, std::span<bool> results) {
        statistics.occlusion += rays.size();
        time_all(rays.size(), [&] { accelerator_->occluded(rays, results); });
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
        // Subtracts the time of reading the clock.
        add_time(1, std::max(0.0, seconds(end - begin) - seconds(begin - before)));
        return result;
    }
    template <typename F>
    void time_all(std::size_t rays, const F& f) {
        const auto begin = Clock::now();
        f();
        add_time(rays, seconds(Clock::now() - begin));
    }
    // No ray takes longer than this limit: the thread was interrupted.
    void add_time(std::size_t rays, double taken) {
        if (taken >= 50e-6 * static_cast<double>(rays)) return;
        statistics.timed_seconds += taken;
        statistics.timed += rays;
    }

    const Accelerator* accelerator_;
};

} // namespace montelux
