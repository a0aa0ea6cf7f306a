// Published figures of integrators that are not installed, from an earlier measurement.
#pragma once

#include "bench/integrate/integrands.h"
#include <optional>
#include <span>
#include <string_view>

namespace montelux::bench {

// Median evaluations to a claimed relative error. GSL 2.7.1, Cuba 4.2.2, vegas 6.4.1, cubature 1.0.4,
// mppmu/qmc; 20 seeds (10 to 20 at 1e-4), cap 2e7 evaluations, every pilot and rerun counted, the same
// families with parameters of other draws.
struct PublishedMedians {
    std::string_view best_sampling; // the best honest sampling method; empty where none was honest
    double sampling = 0;            // its evaluations
    double cubature = 0;            // those of the best honest deterministic rule; 0: none
    double vegas = 0;               // those of VEGAS+
    bool vegas_honest = true;
};
// For a relative error of 1e-3 or 1e-4; nothing for other errors and lines.
std::optional<PublishedMedians> published_medians(Line line, double relative_error);
// Whether the method is one of those that are not measured again.
bool only_published(std::string_view method);

// Root mean square of the true relative error at 1e6 evaluations.
struct PublishedErrors {
    double vegas, gsl_vegas, cuba_vegas_sobol, sobol8, qmc;
};
std::optional<PublishedErrors> published_errors(Line line);

// CPU nanoseconds per evaluation with a trivial integrand in 8 dimensions.
struct PublishedOverhead {
    std::string_view method, nanoseconds;
};
std::span<const PublishedOverhead> published_overheads();

// Share of silent failures, and coverage at 1e-3.
struct PublishedHonesty {
    std::string_view method, silent_1e3, silent_1e4, smooth, discontinuous;
};
std::span<const PublishedHonesty> published_honesty();

} // namespace montelux::bench
