// A texel that is baked: its value, its error, and when it is good enough.
#pragma once

#include <algorithm>
#include <cstdint>

#include "montelux/mc/math/vec.h"

namespace montelux {

// When one texel is done.
struct TexelGoal {
    // Standard error of each channel beside the larger of the mean of the three channels and `floor`; 0:
    // none.
    double target_error = 0.01;
    double floor = 0; // in radiance
    // Without a target, the number of samples to take; with one, the most that a round may take.
    std::uint64_t samples = 1 << 20;
};

struct TexelEstimate {
    Vec3d value, standard_error;
    std::uint64_t samples = 0; // in all rounds
    bool met = true;
};

// How many times the error that the goal allows; 0 where a black texel has none.
inline double missed_by(const TexelEstimate& e, const TexelGoal& goal, double target_error) {
    const double reference = std::max((e.value.x + e.value.y + e.value.z) / 3, goal.floor);
    const double error = max_component(e.standard_error);
    if (error == 0) return 0;
    return reference > 0 ? error / (target_error * reference) : 2;
}
inline bool meets(const TexelEstimate& e, const TexelGoal& goal) {
    return missed_by(e, goal, goal.target_error) <= 1;
}

} // namespace montelux
