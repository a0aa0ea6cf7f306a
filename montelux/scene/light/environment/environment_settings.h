// How environment maps are looked up, and how directions to them are sampled.
#pragma once

#include <cstdint>

namespace montelux {

// docs/environment-light.md says what each is, and how they compare.
enum class EnvironmentSampling : std::uint8_t {
    automatic,  // one of the others, by the map
    tabulated,  // each texel in proportion to its light (MISSION C6)
    median_cut, // regions of equal light, uniform in each
    structured, // strata of a hierarchical thresholding, uniform in each
};

// What a map is between the centres of its texels.
enum class EnvironmentLookup : std::uint8_t {
    nearest,  // constant over each texel, as pbrt-v4 has it
    bilinear, // blended between the four nearest centres
};

struct EnvironmentSettings {
    EnvironmentSampling sampling = EnvironmentSampling::tabulated;
    // MIS compensation: the density leaves out what BSDF sampling finds as well. It is zero where there is
    // light, and so is for light samples that are joined with BSDF samples by multiple importance sampling.
    bool compensated = false;
    EnvironmentLookup lookup = EnvironmentLookup::nearest;
    // Regions of median_cut (a power of two up to 65536) or strata of structured (about so many, up to
    // 65536); 0: as many as are usual.
    int parts = 0;
};

} // namespace montelux
