// IntegratorChoice: how a render came by its integrator, where a pilot chose it.
#pragma once

#include <array>
#include <cstdint>

#include "montelux/scene/render_settings.h"

namespace montelux {

// What became of an integrator that might have been chosen.
enum class CandidateOutcome : std::uint8_t {
    refused,      // it cannot render this scene, or not with these settings
    unaffordable, // its pilot would take too large a share of the render
    measured,
};

// The outcome of a pilot. Trivially copyable.
struct IntegratorChoice {
    struct Candidate {
        IntegratorKind kind = IntegratorKind::path;
        CandidateOutcome outcome = CandidateOutcome::refused;
        // Relative variance of one sample per pixel times its work: proportional to the time to any error. 0: it found no
        // light.
        double effort = 0;
        std::uint64_t samples = 0; // of its pilot
    };
    bool decided = false; // by a pilot; otherwise the user chose
    double missing = 0;   // share of the light that path tracing would lack, where that decided
    IntegratorKind chosen = IntegratorKind::path;
    std::array<Candidate, 3> candidates{};
    double cpu_seconds = 0; // of the whole pilot
    double seconds_to_target =
        0; // expected of the render from its start, with a target error; 0: none, or not known

    // Of an integrator that was measured: time to an error over that of the chosen one; 0 if that is not known.
    double time_ratio(const Candidate& candidate) const {
        for (const Candidate& c : candidates)
            if (c.kind == chosen && c.outcome == CandidateOutcome::measured && c.effort > 0)
                return candidate.effort / c.effort;
        return 0;
    }
};

} // namespace montelux
