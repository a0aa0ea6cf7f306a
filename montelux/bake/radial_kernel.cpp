#include "montelux/bake/radial_kernel.h"

#include <cmath>

#include "montelux/mc/math/constants.h"

namespace montelux {
namespace {

// integral_0^1 (1 - d) / (a + b d)^2 dd for a, b >= 0, a + b > 0.
double reciprocal_square_integral(double a, double b) {
    if (b < 1e-3 * a) { // the closed form would cancel
        const double q = b / a;
        return (0.5 - q / 3 + q * q / 4 - q * q * q / 5 + q * q * q * q / 6) / (a * a);
    }
    return 1 / (a * b) - std::log1p(b / a) / (b * b);
}

} // namespace

RadialKernel RadialKernel::ggx(double alpha) {
    const double a = alpha * alpha, b = (1 - alpha) * (1 + alpha) / 2;
    return {static_cast<float>(inv_two_pi / reciprocal_square_integral(a, b)), static_cast<float>(a),
            static_cast<float>(b)};
}

RadialKernel RadialKernel::cosine() { return {inv_pi_f, 1, 0}; }

} // namespace montelux
