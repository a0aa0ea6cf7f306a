#include "montelux/scene/medium/semi_infinite_albedo.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "montelux/mc/math/quadrature.h"
#include "montelux/scene/bsdf/subsurface_boundary.h"

namespace montelux {
namespace {

constexpr int albedo_knots = 257;

// At sqrt(1 - a) = i / (albedo_knots - 1): in this variable the albedo is smooth where the medium absorbs little.
const std::array<double, albedo_knots>& albedo_table() {
    static const std::array<double, albedo_knots> table = [] {
        std::array<double, albedo_knots> t{};
        for (int i = 0; i < albedo_knots; ++i) {
            const double s = static_cast<double>(i) / (albedo_knots - 1);
            t[static_cast<std::size_t>(i)] = semi_infinite_diffuse_albedo(1 - s * s);
        }
        return t;
    }();
    return table;
}

} // namespace

double semi_infinite_diffuse_albedo(double a) {
    constexpr std::size_t n = 24;
    static const std::vector<QuadratureNode> rule = gauss_legendre_rule(n);
    const double root = std::sqrt(std::max(1 - a, 0.0));
    // 1/H(mu) = sqrt(1 - a) + a/2 integral of mu' H(mu') / (mu + mu') (section V, equation 35), solved by iteration.
    std::array<double, n> h{};
    h.fill(1);
    for (int iteration = 0; iteration < 1000; ++iteration) {
        double change = 0;
        for (std::size_t i = 0; i < n; ++i) {
            double integral = 0;
            for (std::size_t j = 0; j < n; ++j)
                integral += rule[j].weight * rule[j].x * h[j] / (rule[i].x + rule[j].x);
            const double next = 0.5 * (h[i] + 1 / (root + a / 2 * integral));
            change = std::max(change, std::abs(next - h[i]));
            h[i] = next;
        }
        if (change < 1e-10) break;
    }
    double moment = 0;
    for (std::size_t i = 0; i < n; ++i) moment += rule[i].weight * rule[i].x * h[i];
    return 1 - 2 * root * moment;
}

float single_scattering_albedo(float reflectance, float eta) {
    // Light that has entered leaves with the share (1 - r) R / (1 - r R): the boundary reflects r of what reaches it.
    const double r = static_cast<double>(internal_diffuse_reflectance(eta));
    const double rho = std::clamp(static_cast<double>(reflectance), 0.0, 1.0);
    const double albedo = rho / (1 - r + rho * r);
    const auto& table = albedo_table();
    const auto above =
        std::partition_point(table.begin() + 1, table.end() - 1, [&](double x) { return x > albedo; });
    const double low = *above, high = *(above - 1);
    const double t = std::clamp((high - albedo) / (high - low), 0.0, 1.0);
    const double s = (static_cast<double>(above - table.begin()) - 1 + t) / (albedo_knots - 1);
    return static_cast<float>(1 - s * s);
}

float body_albedo(float reflectance, float eta, float g) {
    const float reduced = single_scattering_albedo(reflectance, eta);
    return reduced / (1 - g + g * reduced);
}

} // namespace montelux
