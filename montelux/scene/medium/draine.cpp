#include "montelux/scene/medium/draine.h"

namespace montelux {

namespace {

// mu with a cumulative distribution of u. With s = sqrt(1 + g^2 - 2 g mu) the distribution is the integral of
// (1 + alpha mu^2) / s^2 over s: a polynomial divided by s.
double invert_cosine(double g, double alpha, double u) {
    const double gg = 1 + g * g, c = alpha / (4 * g * g);
    const auto mu_of = [&](double s) { return (gg - s * s) / (2 * g); };
    // The antiderivative; it grows with s.
    const auto integral = [&](double s) {
        return -(1 + c * gg * gg) / s - 2 * c * gg * s + c * s * s * s / 3;
    };
    const double at_minus_one = 1 + g, at_one = 1 - g; // s of mu = -1 and 1
    const double from = integral(at_minus_one), to = integral(at_one);
    const double target = from + u * (to - from);
    double low = std::min(at_one, at_minus_one), high = std::max(at_one, at_minus_one);
    double s = at_minus_one * at_one / (at_one + u * (at_minus_one - at_one)); // alpha = 0
    for (int i = 0; i < 60; ++i) { // Newton's method within a shrinking interval
        const double difference = integral(s) - target;
        (difference > 0 ? high : low) = s;
        const double mu = mu_of(s);
        double next = s - difference * s * s / (1 + alpha * mu * mu);
        if (!(next >= low && next <= high)) next = 0.5 * (low + high);
        const bool converged = std::abs(next - s) <= 1e-14 * s;
        s = next;
        if (converged) break;
    }
    return mu_of(s);
}

// g = 0: mu + alpha mu^3 / 3 is a linear function of u.
double invert_cosine(double alpha, double u) {
    const double target = (2 * u - 1) * (1 + alpha / 3);
    double mu = 2 * u - 1, low = -1, high = 1;
    for (int i = 0; i < 60; ++i) {
        const double difference = mu + alpha * mu * mu * mu / 3 - target;
        (difference > 0 ? high : low) = mu;
        double next = mu - difference / (1 + alpha * mu * mu);
        if (!(next >= low && next <= high)) next = 0.5 * (low + high);
        const bool converged = std::abs(next - mu) <= 1e-14;
        mu = next;
        if (converged) break;
    }
    return mu;
}

} // namespace

PhaseSample Draine::sample(Vec3f wo, Vec2f u) const {
    // Near g = 0 the differences of the general form cancel; the density there is that of g = 0 within 1e-3.
    const double mu =
        std::abs(g) < 1e-3f
            ? invert_cosine(static_cast<double>(alpha), static_cast<double>(u.x))
            : invert_cosine(static_cast<double>(g), static_cast<double>(alpha), static_cast<double>(u.x));
    const auto cos_theta = static_cast<float>(std::clamp(-mu, -1.0, 1.0));
    const float sin_theta = std::sqrt(std::max(0.0f, 1 - cos_theta * cos_theta));
    const float phi = two_pi_f * u.y;
    const Vec3f wi =
        Frame::from_normal(wo).to_world({sin_theta * std::cos(phi), sin_theta * std::sin(phi), cos_theta});
    return {wi, pdf(wo, wi)};
}

} // namespace montelux
