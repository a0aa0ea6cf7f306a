// The check of a cubature: random points in all regions, compared with the values of the rules.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "montelux/mc/integrate/cubature/cubature_regions.h"
#include "montelux/mc/integrate/evaluator.h"
#include "montelux/mc/parallel/cancel_flag.h"
#include "montelux/mc/stats/covariance_moments.h"

namespace montelux {

// A point of the cube whose value the rule of its region did not expect.
struct CubatureWitness {
    std::size_t region = 0;
    std::vector<double> x, value; // one per coordinate, one per component
    double volume = 1;            // of the part of the cube that it may speak for
};

struct CubatureCheck {
    std::vector<CubatureWitness> surprises;
    // Points with values far beyond all that their region's rule saw, however small: they may lie on flanks of other
    // peaks. The greatest of each region.
    std::vector<CubatureWitness> hints;
    // Of g - (mean of its region), over the points.
    CovarianceMoments residual;
    std::vector<double> difference;   // of the integral by these points and its value by the rules
    std::vector<double> missed;       // of it, by surprises alone, each counted as positive
    std::vector<std::size_t> regions; // that have points
    std::vector<double> differences;  // of each, components side by side
    // Standard error of the difference, from the spread of its parts (scrambled Sobol' blocks): mostly too
    // large.
    std::vector<double> standard_error;
    std::vector<double> lowest, highest; // values met
    NonFiniteCount non_finite;
};

// Far beyond what a smooth integrand does between the points of a rule: how much |value| exceeds the range
// that the rule of `region` saw, widened by half of it, by four times the region's claimed error and by a
// quarter of the tolerance. Zero where the value is no surprise. `tolerance`: of the whole integral, one per
// component.
double surprise(const CubatureRegions& regions, std::size_t region, std::size_t component, double value,
                double tolerance);

// Evaluates `count` points: three fifths of them spread over the regions by volume, the others by volume
// times the range of the values that the rules saw, and equally over the regions; within a region they are
// scrambled Sobol' points. (seed, round) key the randomisation. Empty when cancelled. A part of the cube of
// volume v with unexpected values is overlooked with a probability of at most about exp(-0.6 count v).
std::optional<CubatureCheck> check_regions(const Evaluator& evaluator, const CubatureRegions& regions,
                                           std::uint64_t count, std::uint64_t seed, std::uint64_t round,
                                           std::span<const double> tolerance, bool full_covariance,
                                           const CancelFlag* cancel);

} // namespace montelux
