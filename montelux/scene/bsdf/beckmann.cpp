#include "montelux/scene/bsdf/beckmann.h"

#include <utility>

#include "montelux/mc/math/increasing_root.h"

namespace montelux {

namespace {

// Nearer to -1 and 1 the inverse of erf below loses its digits.
constexpr double erf_margin = 1e-7;

// The x with erf(x) = y for |y| up to 1 - erf_margin, with an absolute error below 1e-6. Giles 2012, "Approximating the
// erfinv Function", GPU Computing Gems 2 (single precision).
double inverse_erf(double y) {
    constexpr double central[] = {2.81022636e-08,  3.43273939e-07, -3.5233877e-06,
                                  -4.39150654e-06, 0.00021858087,  -0.00125372503,
                                  -0.00417768164,  0.246640727,    1.50140941};
    constexpr double tail[] = {-0.000200214257, 0.000100950558, 0.00134934322, -0.00367342844, 0.00573950773,
                               -0.0076224613,   0.00943887047,  1.00167406,    2.83297682};
    const double w = -std::log((1 - y) * (1 + y));
    const bool is_central = w < 5;
    const double t = is_central ? w - 2.5 : std::sqrt(w) - 3;
    double p = 0;
    for (const double c : is_central ? central : tail) p = p * t + c;
    return p * y;
}

// The slope along the direction of w on a surface of alpha 1, w at an angle of `cotangent` to the normal: its density is
// proportional to exp(-s^2) (cotangent - s) for s below the cotangent. Jakob 2014, "An Improved Visible Normal Sampling
// Routine for the Beckmann Distribution": the distribution function is almost linear in erf(s), where Newton's
// method begins at the solution for grazing incidence.
double visible_slope(double cotangent, double u) {
    constexpr double inv_sqrt_pi = 0.56418958354775628695;
    const double tangent = 1 / cotangent;
    const double most = std::erf(cotangent);
    const double total = 1 + most + inv_sqrt_pi * tangent * std::exp(-cotangent * cotangent);
    const auto residual = [&](double x) {
        const double s = inverse_erf(x);
        return std::pair{1 + x + inv_sqrt_pi * tangent * std::exp(-s * s) - u * total, 1 - s * tangent};
    };
    const double start = most - (1 + most) * std::erf(std::sqrt(-std::log(u)));
    const double lo = -1 + erf_margin, hi = std::min(most, 1 - erf_margin);
    return inverse_erf(increasing_root(lo, hi, start, residual, 1e-3));
}

} // namespace

Vec3f Beckmann::sample_visible(Vec3f w, Vec2f u) const {
    if (w.z < 0) w = -w;
    const Vec2f standard{alpha_x * w.x, alpha_y * w.y};
    const float sine = std::hypot(standard.x, standard.y);
    const auto inside = [](float v) {
        constexpr double margin = 1e-7;
        return std::clamp(static_cast<double>(v), margin, 1 - margin);
    };
    // Almost along the normal all azimuths are the same.
    const bool upright = !(sine > 1e-6f * w.z);
    const Vec2f along = upright ? Vec2f{1, 0} : Vec2f{standard.x / sine, standard.y / sine};
    const double cotangent = upright ? 1e6 : static_cast<double>(w.z) / static_cast<double>(sine);
    const auto s = static_cast<float>(visible_slope(cotangent, inside(u.x)));
    const auto t = static_cast<float>(inverse_erf(2 * inside(u.y) - 1));
    return normalize(
        Vec3f{-alpha_x * (along.x * s - along.y * t), -alpha_y * (along.y * s + along.x * t), 1});
}

} // namespace montelux
