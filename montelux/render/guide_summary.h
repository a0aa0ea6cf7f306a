// GuideSummary: how a render came by its guide, or why it has none.
#pragma once

#include <cstdint>

namespace montelux {

enum class GuideOutcome : std::uint8_t {
    none,          // not trained, or not over
    too_short,     // a trial would take too large a share of the render
    nothing_found, // paths found no light to learn from
    would_not_pay,
    trained,
};

// The outcome of a training. Trivially copyable.
struct GuideSummary {
    bool decided = false; // the training is over
    GuideOutcome outcome = GuideOutcome::none;
    std::uint32_t rounds = 0;
    double samples = 0; // per pixel, of all rounds
    // Samples that an unguided render takes in the time of a guided one with the same error, over those of the guided
    // one; estimated from the training.
    double gain = 0;
    std::uint64_t regions = 0, bytes = 0; // of the guide; 0: paths are not guided
    double cpu_seconds = 0;
};

} // namespace montelux
