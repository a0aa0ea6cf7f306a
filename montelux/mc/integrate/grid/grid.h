// Deterministic baselines (A1): left Riemann sums, midpoint and trapezoid rules on tensor grids.
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>

#include "montelux/mc/integrate/estimator.h"

namespace montelux {

// All three divide each of the d variables of the unit cube into `cells` equal cells and sum values at the
// n^d points of the tensor grid. They are baselines for other methods: for smooth integrands the error falls
// as N^(-order / d) with the number N of points, the curse of dimensionality.
//
// With cells = 0 the grid is refined, by doubling `cells` in each step while a target is set, and at
// last by the largest grid that the evaluations left allow. Left Riemann sums and trapezoids use the points
// of the grid before again where they double. The error is then |I_k - I_(k-1)| / (r^order - 1) (Richardson
// 1911; r the ratio of the numbers of cells), or the one predicted by the level before if that is larger: an
// estimate for smooth integrands, not a bound and not statistical. With a single grid it is infinite. With
// cells > 0 only that grid is evaluated.

// Order 1: f at the lower corner of each cell.
struct RiemannSum {
    static constexpr std::string_view name = "riemann";
    std::uint64_t cells = 0;

    std::unique_ptr<Estimator> estimator(const Problem& problem) const;
};

// Order 2: f at the centre of each cell.
struct MidpointRule {
    static constexpr std::string_view name = "midpoint";
    std::uint64_t cells = 0;

    std::unique_ptr<Estimator> estimator(const Problem& problem) const;
};

// Order 2: f at the corners of each cell, so cells + 1 points per variable. Corners at infinity count as zero
// unless f has another value there (then as not finite).
struct TrapezoidRule {
    static constexpr std::string_view name = "trapezoid";
    std::uint64_t cells = 0;

    std::unique_ptr<Estimator> estimator(const Problem& problem) const;
};

} // namespace montelux
