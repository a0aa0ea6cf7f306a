// Targets with known integrals that densities are trained on and samples are drawn of.
#pragma once

#include <cmath>
#include <memory>
#include <span>
#include <stdexcept>

#include "montelux/mc/integrate/adaptive/adaptive.h"
#include "montelux/mc/integrate/integrate.h"
#include "montelux/mc/integrate/trained/trained_density.h"
#include "montelux/mc/integrate/vegas/vegas.h"
#include "montelux/mc/math/constants.h"

namespace montelux {

// A Gaussian of width s around m, normalised over the line, and its integral over [a, b].
inline double bell(double x, double m, double s) {
    return std::exp(-0.5 * (x - m) * (x - m) / (s * s)) / (s * std::sqrt(2 * pi));
}
inline double bell_integral(double a, double b, double m, double s) {
    return 0.5 * (std::erf((b - m) / (s * std::sqrt(2.0))) - std::erf((a - m) / (s * std::sqrt(2.0))));
}

// On [-1, 3] x [0, 2]: a bell that two faces cut, so that Gaussians fitted to it draw points outside, and a
// second one inside that is a third of the first.
struct CutBells {
    static Domain domain() { return {{-1, 3}, {0, 2}}; }
    static double value(std::span<const double> x) {
        return bell(x[0], -0.9, 0.15) * bell(x[1], 0.1, 0.2) + bell(x[0], 2, 0.1) * bell(x[1], 1.2, 0.3) / 3;
    }
    // Over [a, b] x [c, d].
    static double integral(double a, double b, double c, double d) {
        return bell_integral(a, b, -0.9, 0.15) * bell_integral(c, d, 0.1, 0.2) +
               bell_integral(a, b, 2, 0.1) * bell_integral(c, d, 1.2, 0.3) / 3;
    }
};

inline TrainedDensity trained(const Integrand& f, const Domain& domain, const Method& method,
                              std::uint64_t evaluations) {
    const auto density = integrate(f, domain, method, {.evaluations = evaluations}).density;
    if (!density) throw std::runtime_error("no density was trained");
    return *density;
}
inline TrainedDensity cut_bells(const Method& method = Adaptive{}) {
    return trained(CutBells::value, CutBells::domain(), method, 40000);
}

} // namespace montelux
