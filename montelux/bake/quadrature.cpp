#include "montelux/bake/quadrature.h"

#include <algorithm>
#include <cmath>

#include "montelux/mc/math/constants.h"

namespace montelux {

std::vector<QuadratureNode> gauss_legendre_rule(int n) {
    std::vector<QuadratureNode> rule(static_cast<std::size_t>(n));
    for (int i = 0; i < n; ++i) {
        // Newton's method from Tricomi's estimate of the root.
        double x = std::cos(pi * (i + 0.75) / (n + 0.5)), derivative = 1;
        for (int iteration = 0; iteration < 100; ++iteration) {
            double before = 1, p = x;
            for (int j = 2; j <= n; ++j) {
                const double next = ((2 * j - 1) * x * p - (j - 1) * before) / j;
                before = p;
                p = next;
            }
            derivative = n * (x * p - before) / (x * x - 1);
            const double step = p / derivative;
            x -= step;
            if (std::abs(step) < 1e-16) break;
        }
        rule[static_cast<std::size_t>(n - 1 - i)] = {(1 + x) / 2, (1 - x) / 2,
                                                     1 / ((1 - x * x) * derivative * derivative)};
    }
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
