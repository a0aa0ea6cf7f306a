// How directions to environment maps are sampled.
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

struct EnvironmentSettings {
    EnvironmentSampling sampling = EnvironmentSampling::tabulated;
    // MIS compensation: the density leaves out what BSDF sampling finds as well. It is zero where there is
    // light, and so is for light samples that are joined with BSDF samples by multiple importance sampling.
    bool compensated = false;
};

} // namespace montelux
