// Tables of the rates of rays.
#pragma once

#include "bench/rays/tracing.h"
#include <span>
#include <string>
#include <vector>

namespace montelux::bench {

// Rays of one kind, traced in one way.
struct RayRun {
    std::string scene;
    RayKind kind = RayKind::camera;
    RayOrder order = RayOrder::path;
    bool robust = true;
    Tracing tracing;
    std::size_t rays = 0;
    TracingResult result;

    double rate() const { return 1e-6 * static_cast<double>(rays) / result.seconds; } // Mrays/s
};

// Markdown: for each scene a table, a row for each kind, order and setting.
void print_table(std::span<const RayRun> runs);
void write_json(const std::string& path, std::span<const RayRun> runs);

} // namespace montelux::bench
