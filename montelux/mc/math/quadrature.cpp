#include "montelux/mc/math/quadrature.h"

#include <algorithm>
#include <boost/math/special_functions/legendre.hpp>
#include <cmath>

#include "montelux/mc/math/constants.h"

namespace montelux {

std::vector<QuadratureNode> gauss_legendre_rule(int n) {
    std::vector<QuadratureNode> rule;
    for (double x : boost::math::legendre_p_zeros<double>(n)) { // those that are not negative
        const double derivative = boost::math::legendre_p_prime(n, x);
        const double weight = 1 / ((1 - x) * (1 + x) * derivative * derivative);
        rule.push_back({(1 + x) / 2, (1 - x) / 2, weight});
        if (x > 0) rule.push_back({(1 - x) / 2, (1 + x) / 2, weight});
    }
    std::sort(rule.begin(), rule.end(),
              [](const QuadratureNode& a, const QuadratureNode& b) { return a.x < b.x; });
    return rule;
}

std::vector<QuadratureNode> double_exponential_rule(double h, double limit) {
    // An odd number on either side, so that the coarse rule has the middle node and one fewer at each end.
    const int side = static_cast<int>(limit / h) | 1;
    std::vector<QuadratureNode> rule;
    for (int k = -side; k <= side; ++k) {
        const double t = k * h, s = pi * std::sinh(t);
        const double x = 1 / (1 + std::exp(-s)), y = 1 / (1 + std::exp(s));
        rule.push_back({x, y, h * pi * std::cosh(t) * x * y});
    }
    return rule;
}

} // namespace montelux
