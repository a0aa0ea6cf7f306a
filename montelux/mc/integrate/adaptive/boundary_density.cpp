#include "montelux/mc/integrate/adaptive/boundary_density.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace montelux {
namespace {

// Open at both ends, so that no coordinate is mapped to infinity.
constexpr double least_inside = 0x1p-160, most_inside = 1 - 0x1p-53;

double pdf(double x) {
    const double root = std::cbrt(2 * std::max(std::min(x, 1 - x), least_inside));
    return 1 / (3 * root * root);
}

} // namespace

void sample_boundary(std::span<const double> u, std::span<double> x, std::span<double> density) {
    for (std::size_t i = 0; i < u.size(); ++i) {
        const double root = 2 * std::min(u[i], 1 - u[i]), distance = 0.5 * root * root * root;
        x[i] = std::clamp(u[i] < 0.5 ? distance : 1 - distance, least_inside, most_inside);
        density[i] *= pdf(x[i]);
    }
}

void multiply_boundary_pdf(std::span<const double> x, std::span<double> density) {
    for (std::size_t i = 0; i < x.size(); ++i) density[i] *= pdf(x[i]);
}

} // namespace montelux
