// Randomised quasi-Monte Carlo (A6): low-discrepancy points, with an honest error from independent
// replicates.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

#include "montelux/mc/integrate/estimator.h"
#include "montelux/mc/random/point_set.h"

namespace montelux {

// The mean of the integrand over a point set, for several independent randomisations of it; the estimate is
// the mean over these replicates and its error comes from their spread, with Student's law of replicates - 1
// degrees of freedom (Owen 2013, "Monte Carlo theory, methods and examples", section 17). Unbiased, for every
// point of a randomised set is uniform. The number of points doubles from step to step, and only whole
// doublings count: such a number is balanced for Sobol' points. If the evaluations are limited, the other
// sets finally use up the rest; Hammersley sets, which have no prefix, start anew for each number.
//
// An error target counts as reached if three standard errors by Student's law, t, stay within three targets,
// or if it is met at two successive doublings: a spread that is small by luck seldom passes.
//
// The error is calibrated if the replicates are nearly normal. It is not for integrands of infinite variance,
// nor for a jump in one dimension, which all replicates may have on the same side of the same point: such
// replicates mostly agree and seldom differ much. If one of them is an outlier, there is a warning.
//
// The plain sets (Randomisation::none, but for independent points) give one deterministic value; its error is
// unknown, infinite.
struct Quasi {
    static constexpr std::string_view name = "quasi";
    static constexpr FirstLookUse first_look = FirstLookUse::with_target;
    static constexpr bool on_device = true;

    PointSetKind points = PointSetKind::sobol;
    // Empty: Owen's scrambling where it exists, else a random shift (independent points need neither).
    std::optional<Randomisation> randomisation = {};
    // At least 2. 0: 16; or, for Sobol' points with limited evaluations, the number from 12 to 23 that uses
    // most of them with a power of two of points.
    int replicates = 0;

    // Throws Error where the set has fewer dimensions or not this randomisation.
    std::unique_ptr<Estimator> estimator(const Problem& problem) const;
};

} // namespace montelux
