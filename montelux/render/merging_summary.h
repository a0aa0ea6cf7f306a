// MergingSummary: by which discs the paths of a render merged, and the bias that this brought.
#pragma once

#include <cstdint>

namespace montelux {

// Trivially copyable. All zero where no paths merge.
struct MergingSummary {
    double first_radius = 0, last_radius = 0;    // of passes, in units of the scene
    std::uint64_t light_paths = 0, of_paths = 0; // in the map of a pass; light paths of the pass
    std::uint64_t bytes = 0;                     // of the largest map; 0 if all were empty
    // MergingBias::Estimate, in units of luminance, from so many passes; unknown below two.
    double bias = 0, bias_error = 0, bias_rms = 0;
    std::uint64_t passes = 0;
};

} // namespace montelux
