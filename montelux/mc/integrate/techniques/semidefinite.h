// Linear equations with a symmetric matrix that is positive semidefinite, such as normal equations.
#pragma once

#include <span>
#include <vector>

namespace montelux {

// One solution x of A x = b for each of the `columns` right sides. A is n x n, row by row (the lower triangle
// is read); b and x hold one column after the other. Pivoted Cholesky decomposition (Higham 2002, "Accuracy
// and Stability of Numerical Algorithms", section 10.3): unknowns whose pivots fall below `tolerance` times
// the diagonal depend on the others, and are set to zero. Contradicting equations are solved for the
// remaining unknowns.
std::vector<double> solve_semidefinite(std::span<const double> matrix, std::span<const double> right,
                                       int columns, double tolerance = 1e-10);

} // namespace montelux
