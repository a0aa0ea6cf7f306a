#include "montelux/scene/bsdf/subsurface_boundary.h"

#include <cmath>

namespace montelux {

float diffuse_fresnel_reflectance(float eta) {
    const auto n = static_cast<double>(eta);
    if (!(n > 1 + 1e-3)) return 0; // below 2e-3 there; the terms of the sum diverge
    const double n2 = n * n, n4 = n2 * n2;
    const double sum = 0.5 + (n - 1) * (3 * n + 1) / (6 * (n + 1) * (n + 1)) +
                       n2 * (n2 - 1) * (n2 - 1) / std::pow(n2 + 1, 3) * std::log((n - 1) / (n + 1)) -
                       2 * n2 * n * (n2 + 2 * n - 1) / ((n2 + 1) * (n4 - 1)) +
                       8 * n4 * (n4 + 1) / ((n2 + 1) * (n4 - 1) * (n4 - 1)) * std::log(n);
    return static_cast<float>(sum);
}

} // namespace montelux
