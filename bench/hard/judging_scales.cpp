// Judging families of scales: peaks in ranges far too wide, decays and thermal spectra of any scale, moments.
#include "bench/hard/judging.h"
#include <boost/math/special_functions/bessel.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <boost/math/special_functions/zeta.hpp>

namespace montelux::bench {

namespace {

// Gaussian, Lorentzian, hyperbolic secant and its square (a soliton), of scale 1.
double profile(int kind, double t) {
    if (kind == 0) return std::exp(-0.5 * t * t);
    if (kind == 1) return 1 / (1 + t * t);
    const double secant = 1 / std::cosh(t);
    return kind == 2 ? secant : secant * secant;
}

// Integral from 0 to t.
double profile_integral(int kind, double t) {
    if (kind == 0) return std::sqrt(pi / 2) * std::erf(t / std::numbers::sqrt2);
    if (kind == 1) return std::atan(t);
    return kind == 2 ? 2 * std::atan(std::tanh(t / 2)) : std::tanh(t);
}

HardIntegral wide_range(Draws& draws) {
    const int n = draws.integer(1, 3), kind = draws.integer(0, 3), place = draws.integer(0, 2);
    const double ratio = draws.log_uniform(10, n == 1 ? 1e6 : n == 2 ? 1e3 : 100);
    const double length = draws.log_uniform(1, 100), s = length / ratio;
    const double lower = place == 0 ? -length / 2 : place == 1 ? draws.uniform(-length, length) : 0;
    std::vector<double> centre(static_cast<std::size_t>(n), 0.0);
    double exact = 1;
    for (double& c : centre) {
        if (place == 1) c = lower + length * draws.uniform(0.05, 0.95);
        exact *=
            s * (profile_integral(kind, (lower + length - c) / s) - profile_integral(kind, (lower - c) / s));
    }
    constexpr const char* kinds[] = {"Gaussian", "Lorentzian", "sech", "sech^2"};
    constexpr const char* places[] = {"in the middle", "anywhere", "at the lower end"};
    return {.ranges = box(n, lower, lower + length),
            .f =
                [=](const double* x) {
                    double product = 1;
                    for (int j = 0; j < n; ++j) product *= profile(kind, (x[j] - centre[j]) / s);
                    return product;
                },
            .exact = exact,
            .parameters = words("n = ", n, ", ", kinds[kind], " ", places[place], ", range ", ratio,
                                " times its width")};
}

HardIntegral several_decays(Draws& draws) {
    const int count = draws.integer(2, 4);
    std::vector<double> scale, mass;
    double exact = 0;
    for (int k = 0; k < count; ++k) {
        scale.push_back(draws.log_uniform(1e-4, 1e4));
        mass.push_back(draws.uniform(0.2, 1));
        exact += mass.back();
    }
    return {.ranges = box(1, 0, infinity),
            .f =
                [=](const double* x) {
                    double total = 0;
                    for (int k = 0; k < count; ++k) total += mass[k] / scale[k] * std::exp(-x[0] / scale[k]);
                    return total;
                },
            .exact = exact,
            .parameters = words(count, " decays, first scales ", scale[0], ", ", scale[1])};
}

// Bateman: activity of the daughter of a decaying nuclide.
HardIntegral daughter(Draws& draws) {
    const double slow = draws.log_uniform(1e-4, 1e2), fast = slow * draws.log_uniform(2, 1e3);
    const double until = draws.log_uniform(10, 1e5) / slow;
    const bool whole = draws.chance(0.3);
    const double gone_slow = whole ? 1 : -std::expm1(-slow * until);
    const double gone_fast = whole ? 1 : -std::expm1(-fast * until);
    return {.ranges = box(1, 0, whole ? infinity : until),
            .f =
                [=](const double* x) {
                    return slow * fast / (fast - slow) * -std::exp(-slow * x[0]) *
                           std::expm1((slow - fast) * x[0]);
                },
            .exact = (fast * gone_slow - slow * gone_fast) / (fast - slow),
            .parameters = words("daughter, rates ", slow, ", ", fast, whole ? "" : words(", until ", until))};
}

HardIntegral power_decay(Draws& draws) {
    const int power = draws.integer(0, 6);
    const double s = draws.log_uniform(1e-4, 1e4), length = s * draws.log_uniform(10, 1e5);
    return {.ranges = box(1, 0, length),
            .f = [=](const double* x) { return std::pow(x[0] / s, power) * std::exp(-x[0] / s); },
            .exact = s * boost::math::tgamma_lower(power + 1.0, length / s),
            .parameters = words("power ", power, ", scale ", s, ", range ", length / s, " times it")};
}

HardIntegral decay(Draws& draws) {
    switch (draws.integer(0, 2)) {
    case 0:
        return several_decays(draws);
    case 1:
        return daughter(draws);
    default:
        return power_decay(draws);
    }
}

// x^(p - 1) / (exp(x / T) - 1): gamma(p) zeta(p) T^p; in 3 variables p = 4 with Lambert's cosine.
HardIntegral bosons(Draws& draws) {
    const int n = draws.chance(0.5) ? 1 : 3;
    const double t = draws.log_uniform(1e-3, 1e3), p = n == 3 ? 4 : draws.uniform(1.5, 5);
    const bool whole = draws.chance(0.5);
    const double most = t * draws.log_uniform(100, 1e4);
    std::vector<Range> ranges = box(1, 0, whole ? infinity : most);
    if (n == 3) {
        ranges.push_back({0, pi / 2});
        ranges.push_back({0, 2 * pi});
    }
    // In units of T the tail beyond 100 is below 1e-35.
    return {.ranges = ranges,
            .f =
                [=](const double* x) {
                    const double y = x[0] / t;
                    const double spectrum = y > 0 ? std::pow(y, p - 1) / std::expm1(y) : 0;
                    return n == 1 ? spectrum : spectrum * std::sin(x[1]) * std::cos(x[1]);
                },
            .exact = t * std::tgamma(p) * boost::math::zeta(p) * (n == 1 ? 1 : pi),
            .parameters = words("n = ", n, ", Bose, T = ", t, ", p = ", p,
                                whole ? "" : words(", until ", most / t, " T"))};
}

// sqrt(E) / (1 + exp((E - mu) / T)), substituted E = y^2.
HardIntegral fermions(Draws& draws) {
    const double mu = draws.log_uniform(1e-2, 1e2), t = mu / draws.log_uniform(5, 1e3);
    const bool whole = draws.chance(0.5);
    const double most = mu + t * draws.log_uniform(60, 1e4);
    auto occupation = [=](double energy) { return 1 / (1 + std::exp((energy - mu) / t)); };
    auto of_root = [&](double y) { return 2 * y * y * occupation(y * y); };
    const double from = std::sqrt(std::max(0.0, mu - 40 * t)), to = std::sqrt(mu + 50 * t);
    return {.ranges = box(1, 0, whole ? infinity : most),
            .f = [=](const double* x) { return std::sqrt(x[0]) * occupation(x[0]); },
            .exact = integrate_by_panels(0, from, 64, of_root) + integrate_by_panels(from, to, 128, of_root),
            .parameters = words("Fermi, mu = ", mu, ", T = ", t, whole ? "" : words(", until ", most))};
}

HardIntegral radiation(Draws& draws) { return draws.chance(0.6) ? bosons(draws) : fermions(draws); }

// x^k times a log-normal, gamma, Weibull or inverse-Gaussian-like law of x / scale.
struct Moment {
    int law, power;
    double scale, a, b;

    double operator()(double x) const {
        const double t = x / scale;
        if (!(t > 0)) return 0;
        const double logarithm = std::log(t);
        switch (law) {
        case 0: {
            const double z = logarithm / a;
            return std::exp(power * logarithm - 0.5 * z * z) / t;
        }
        case 1:
            return std::exp((power + a - 1) * logarithm - t);
        case 2:
            return std::exp((power + a - 1) * logarithm - std::pow(t, a));
        default:
            return std::exp((power + a - 1) * logarithm - b * (t + 1 / t));
        }
    }
    double integral() const {
        switch (law) {
        case 0:
            return scale * a * std::sqrt(2 * pi) * std::exp(0.5 * power * power * a * a);
        case 1:
            return scale * std::tgamma(power + a);
        case 2:
            return scale * std::tgamma(1 + power / a) / a;
        default:
            return scale * 2 * boost::math::cyl_bessel_k(power + a, 2 * b);
        }
    }
};

HardIntegral moments(Draws& draws) {
    const int n = draws.integer(1, 3);
    constexpr const char* laws[] = {"log-normal", "gamma", "Weibull", "inverse Gaussian"};
    std::vector<Moment> factors;
    double exact = 1;
    for (int j = 0; j < n; ++j) {
        Moment m{draws.integer(0, 3), draws.integer(0, 4), draws.log_uniform(0.01, 100), 0, 0};
        m.a = m.law == 0   ? draws.uniform(0.2, 1.2)
              : m.law == 3 ? draws.uniform(-2, 2)
                           : draws.log_uniform(0.4, 8);
        m.b = draws.log_uniform(0.02, 20);
        exact *= m.integral();
        factors.push_back(m);
    }
    return {.ranges = box(n, 0, infinity),
            .f =
                [=](const double* x) {
                    double product = 1;
                    for (int j = 0; j < n; ++j) product *= factors[j](x[j]);
                    return product;
                },
            .exact = exact,
            .parameters = words("n = ", n, ", first: ", laws[factors[0].law], ", power ", factors[0].power,
                                ", scale ", factors[0].scale, ", shape ", factors[0].a)};
}

constexpr HardFamily scale_table[] = {
    {"wide_range",
     "products of Gaussian, Lorentzian, sech or sech^2 peaks in the middle of a range, anywhere or at its "
     "lower end; n in 1..3; range / width log-uniform in 10..1e6 (n = 1), 10..1e3 (2), 10..100 (3). Exact: "
     "error functions, arc tangents",
     wide_range},
    {"decay",
     "2..4 exponential densities of scales log-uniform in 1e-4..1e4 over the half-line; activity of a "
     "daughter nuclide (Bateman); x^k exp(-x / s), k in 0..6, over 10..1e5 scales. Exact: closed forms",
     decay},
    {"radiation",
     "x^(p - 1) / (exp(x / T) - 1), p in 1.5..5, or p = 4 and Lambert's cosine (n = 3); sqrt(E) times "
     "Fermi's law, mu / T in 5..1e3; T log-uniform in 1e-3..1e3; half-line, or cut where it has vanished. "
     "Exact: zeta function, Gauss panels",
     radiation},
    {"moments",
     "products of x^k times log-normal, gamma, Weibull and (generalised) inverse Gaussian laws over the "
     "half-lines; n in 1..3, k in 0..4, scales log-uniform in 0.01..100. Exact: gamma and Bessel functions",
     moments},
};

} // namespace

std::span<const HardFamily> judging_scale_families() { return scale_table; }

} // namespace montelux::bench
