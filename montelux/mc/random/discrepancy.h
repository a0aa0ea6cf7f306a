// Discrepancy: how far a point set is from uniform over boxes anchored at the origin.
#pragma once

#include <span>

#include "montelux/mc/math/vec.h"

namespace montelux {

// Star discrepancy: the largest difference between the share of points in a box [0, a) and its volume. Exact;
// of n points. 1-D in O(n log n): Niederreiter 1992, "Random Number Generation and Quasi-Monte Carlo
// Methods", theorem 2.6. 2-D in O(n^2): Bundschuh, Zhu 1993, "A method for exact calculation of the
// discrepancy of low-dimensional finite point sets". No points have discrepancy 1.
double star_discrepancy(std::span<const double> points);
double star_discrepancy(std::span<const Vec2d> points);

// Root of the mean squared difference over boxes [0, a), in O(n^2 d). `points` holds n rows of `dimensions`
// coordinates. Warnock 1972, "Computational investigations of low-discrepancy point sets".
double l2_star_discrepancy(std::span<const double> points, int dimensions);

} // namespace montelux
