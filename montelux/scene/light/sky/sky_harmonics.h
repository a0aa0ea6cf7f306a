// Spherical harmonics of light that is symmetric about the plane of the sun.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace montelux {

// Orders up to which light that is scattered again is resolved.
inline constexpr int sky_order = 8;
constexpr std::size_t harmonic_count(int order) {
    return static_cast<std::size_t>((order + 1) * (order + 2) / 2);
}
inline constexpr std::size_t sky_terms = harmonic_count(sky_order);
// Index of the function of order l, 0 <= m <= l.
constexpr std::size_t harmonic(int l, int m) { return harmonic_count(l - 1) + static_cast<std::size_t>(m); }

// The real orthonormal harmonics are p[harmonic(l, m)] cos(m phi): p for all l <= order at one mu.
inline void normalised_legendre(double mu, int order, double* p) {
    auto at = [&](int l, int m) -> double& { return p[harmonic(l, m)]; };
    const double s = std::sqrt(std::max(0.0, 1 - mu * mu));
    at(0, 0) = 0.28209479177387814; // 1 / sqrt(4 pi)
    for (int m = 1; m <= order; ++m)
        at(m, m) = std::sqrt((m == 1 ? 2 : 1) * (2 * m + 1) / (2.0 * m)) * s * at(m - 1, m - 1);
    for (int m = 0; m < order; ++m) at(m + 1, m) = std::sqrt(2.0 * m + 3) * mu * at(m, m);
    for (int m = 0; m <= order; ++m)
        for (int l = m + 2; l <= order; ++l) {
            const double before = (l - 1.0) * (l - 1);
            at(l, m) = std::sqrt((4.0 * l * l - 1) / (l * l - m * m)) *
                       (mu * at(l - 1, m) - std::sqrt((before - m * m) / (4 * before - 1)) * at(l - 2, m));
        }
}
inline std::vector<double> normalised_legendre(double mu, int order) {
    std::vector<double> p(harmonic_count(order));
    normalised_legendre(mu, order, p.data());
    return p;
}

} // namespace montelux
