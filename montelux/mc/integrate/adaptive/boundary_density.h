// A density on the unit cube that rises towards all faces, which bounds weights at singularities there.
#pragma once

#include <span>

#include "montelux/mc/integrate/points.h"

namespace montelux {

// The product over coordinates of (2 m)^(-2/3) / 3, m = min(x, 1 - x). If several coordinates vanish
// together, as in 1 / (x + y), the marginals have only logarithms, and maps fitted to them leave weights of
// infinite variance. With this density a corner singularity of order k in n vanishing coordinates has bounded
// weights if 3 k <= 2 n, and finite variance if 6 k < 5 n.
//
// x[i] for uniform u[i], and density[i] *= p(x[i]).
void sample_boundary(std::span<const double> u, std::span<double> x, std::span<double> density);
// density[i] *= p(x[i]).
void multiply_boundary_pdf(std::span<const double> x, std::span<double> density);

} // namespace montelux
