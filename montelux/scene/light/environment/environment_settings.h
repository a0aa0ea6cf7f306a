// EnvironmentSettings: interpolation of environment maps, and sampling of directions to them.
#pragma once

#include <cstdint>

namespace montelux {

// Described and compared in docs/environment-light.md.
enum class EnvironmentSampling : std::uint8_t {
    automatic,  // one of the others, by the map
    tabulated,  // each texel in proportion to its light (MISSION C6)
    median_cut, // regions of equal light, uniform in each
    structured, // strata of a hierarchical thresholding, uniform in each
};

// The radiance between the centres of texels.
enum class EnvironmentLookup : std::uint8_t {
    nearest,  // constant over each texel, as pbrt-v4 has it
    bilinear, // blended between the four nearest centres
};

struct EnvironmentSettings {
    EnvironmentSampling sampling = EnvironmentSampling::tabulated;
    // MIS compensation: the density omits what BSDF sampling finds as well. It is zero in places with light,
    // so light samples must be combined with BSDF samples by multiple importance sampling.
    bool compensated = false;
    EnvironmentLookup lookup = EnvironmentLookup::nearest;
    // Regions of median_cut (a power of two up to 65536) or approximate number of strata of structured (up to
    // 65536); 0: the default.
    int parts = 0;
};

} // namespace montelux
