// Nodes and weights of quadrature rules on [0, 1].
#pragma once

#include <vector>

namespace montelux {

struct QuadratureNode {
    double x = 0;
    double to_end = 1; // 1 - x, with all its digits near the end
    double weight = 0;
};

// Gauss-Legendre: exact for polynomials of degree 2 n - 1.
std::vector<QuadratureNode> gauss_legendre_rule(int n);

// Takahasi, Mori 1974, "Double Exponential Formulas for Numerical Integration": x = (1 + tanh(pi/2 sinh t)) /
// 2 for t in steps of h within [-limit, limit]. Converges fast also where the integrand is singular at the
// ends. Every second node, beginning with the second one, at twice its weight is the rule with step 2 h.
std::vector<QuadratureNode> double_exponential_rule(double h, double limit);

} // namespace montelux
