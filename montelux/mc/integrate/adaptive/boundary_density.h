// A density on the unit cube that rises towards all faces: a defence against singularities there.
#pragma once

#include <span>

#include "montelux/mc/integrate/points.h"

namespace montelux {

// The product over coordinates of (2 m)^(-2/3) / 3, m = min(x, 1 - x). Of 1 / (x + y), and wherever several
// coordinates vanish together, the marginals have only logarithms. Maps fitted to them leave weights of
// infinite variance; here a singularity at a corner of order k has bounded weights where 3 k <= 2 n of the n
// coordinates that vanish there, and finite variance where 6 k < 5 n.
//
// x[i] for uniform u[i], and density[i] *= p(x[i]).
void sample_boundary(std::span<const double> u, std::span<double> x, std::span<double> density);
// density[i] *= p(x[i]).
void multiply_boundary_pdf(std::span<const double> x, std::span<double> density);

} // namespace montelux
