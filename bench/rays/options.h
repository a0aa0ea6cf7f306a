// The command line of montelux_bench_rays.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace montelux::bench {

struct RayOptions {
    std::vector<std::filesystem::path> scenes;
    int width = 400; // of the picture, in pixels
    std::uint32_t spp = 16;
    std::size_t rays = 1'000'000; // of each kind, at most
    int repetitions = 3;
    std::string json;
    bool help = false;
};

// Throws Error for an unknown option, a value that cannot be read, or if no scene is named.
RayOptions parse_ray_options(const std::vector<std::string_view>& arguments);
std::string_view ray_options_help();

} // namespace montelux::bench
