// Judging families of posterior densities: linear regression, eight schools, Neal's funnel.
#include "bench/hard/judging.h"

#include "montelux/mc/math/special.h"

namespace montelux::bench {

namespace {

using Matrix = std::vector<std::vector<double>>;

// Inverse and determinant of a positive definite matrix by elimination in long double.
struct Inverse {
    Matrix inverse;
    double determinant;

    explicit Inverse(const Matrix& matrix) {
        const std::size_t n = matrix.size();
        std::vector<std::vector<long double>> rows(n, std::vector<long double>(2 * n, 0.0L));
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t j = 0; j < n; ++j) rows[i][j] = matrix[i][j];
            rows[i][n + i] = 1;
        }
        long double product = 1;
        for (std::size_t k = 0; k < n; ++k) {
            const long double pivot = rows[k][k];
            product *= pivot;
            for (long double& entry : rows[k]) entry /= pivot;
            for (std::size_t i = 0; i < n; ++i) {
                if (i == k) continue;
                const long double factor = rows[i][k];
                for (std::size_t j = 0; j < 2 * n; ++j) rows[i][j] -= factor * rows[k][j];
            }
        }
        determinant = static_cast<double>(product);
        inverse.assign(n, std::vector<double>(n));
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = 0; j < n; ++j) inverse[i][j] = static_cast<double>(rows[i][n + j]);
    }
};

// Likelihood over its largest value; polynomials of up to 4 coefficients, or regressors with a common part.
HardIntegral regression(Draws& draws) {
    const int k = draws.integer(2, 8), count = draws.integer(15, 30);
    const bool polynomial = k <= 4 && draws.chance(0.5);
    const double common = draws.uniform(0, 0.97), sigma = draws.log_uniform(0.05, 2);
    const std::vector<double> truth = draws.uniforms(k, -2, 2);
    Matrix rows;
    std::vector<double> y;
    for (int i = 0; i < count; ++i) {
        std::vector<double> row{1};
        const double shared = draws.uniform(-1.7, 1.7), t = draws.uniform();
        for (int j = 1; j < k; ++j)
            row.push_back(polynomial ? std::pow(t, j)
                                     : std::sqrt(common) * shared +
                                           std::sqrt(1 - common) * draws.uniform(-1.7, 1.7));
        double value = sigma * draws.uniform(-1.7, 1.7);
        for (int j = 0; j < k; ++j) value += truth[j] * row[j];
        y.push_back(value);
        rows.push_back(std::move(row));
    }
    Matrix normal(static_cast<std::size_t>(k), std::vector<double>(static_cast<std::size_t>(k), 0.0));
    std::vector<double> right(static_cast<std::size_t>(k), 0.0), best(static_cast<std::size_t>(k), 0.0);
    for (int r = 0; r < count; ++r)
        for (int i = 0; i < k; ++i) {
            right[i] += rows[r][i] * y[r];
            for (int j = 0; j < k; ++j) normal[i][j] += rows[r][i] * rows[r][j];
        }
    const Inverse solved(normal);
    std::vector<Range> ranges;
    for (int i = 0; i < k; ++i) {
        for (int j = 0; j < k; ++j) best[i] += solved.inverse[i][j] * right[j];
        const double deviation = sigma * std::sqrt(solved.inverse[i][i]);
        ranges.push_back(
            {best[i] - deviation * draws.uniform(7.5, 14), best[i] + deviation * draws.uniform(7.5, 14)});
    }
    auto squares = [=](const double* beta) {
        double total = 0;
        for (int r = 0; r < count; ++r) {
            double rest = y[r];
            for (int j = 0; j < k; ++j) rest -= rows[r][j] * beta[j];
            total += rest * rest;
        }
        return total;
    };
    const double least = squares(best.data());
    return {.ranges = ranges,
            .f = [=](const double* x) { return std::exp(-0.5 * (squares(x) - least) / (sigma * sigma)); },
            .exact = std::pow(2 * pi * sigma * sigma, 0.5 * k) / std::sqrt(solved.determinant),
            .parameters = words(k, " coefficients, ", count, " values, ",
                                polynomial ? "polynomial" : words("common part ", common)),
            .accuracy = 1e-10};
}

// y_j ~ normal(theta_j, s_j), theta_j ~ normal(mu, tau), mu ~ normal(0, 30), tau uniform (Gelman et al.).
// Without theta_j the y_j are normal(mu, sqrt(s_j^2 + tau^2)); the integral over mu is closed too.
HardIntegral schools(Draws& draws) {
    const bool centred = draws.chance(0.4);
    const int schools = draws.integer(2, centred ? 4 : 7);
    const double most = draws.uniform(30, 100), prior = 30;
    const std::vector<double> y = draws.uniforms(schools, -10, 30), s = draws.uniforms(schools, 8, 18);
    const double exact = integrate_by_panels(0, most, 64, [&](double tau) {
        double a = 1 / (prior * prior), b = 0, c = 0, factor = 1 / prior;
        for (int j = 0; j < schools; ++j) {
            const double variance = s[j] * s[j] + tau * tau;
            a += 1 / variance;
            b += y[j] / variance;
            c += y[j] * y[j] / variance;
            factor *= s[j] / std::sqrt(variance);
        }
        return factor / std::sqrt(a) * std::exp(-0.5 * (c - b * b / a));
    });
    // Each likelihood without its constant, so that values are near 1.
    auto f = [=](const double* x) {
        const double mu = x[0], tau = x[1];
        double value = normal_density(mu / prior) / prior;
        for (int j = 0; j < schools; ++j) {
            const double z = centred ? (x[j + 2] - mu) / tau : x[j + 2];
            const double t = (y[j] - (centred ? x[j + 2] : mu + tau * z)) / s[j];
            value *= normal_density(z) * std::exp(-0.5 * t * t) / (centred ? tau : 1);
        }
        return std::isfinite(value) ? value : 0;
    };
    std::vector<Range> ranges{{-300, 300}, {0, most}};
    for (int j = 0; j < schools; ++j) ranges.push_back(centred ? Range{-300, 350} : Range{-9, 9});
    return {.ranges = ranges,
            .f = f,
            .exact = exact,
            .parameters = words("n = ", schools + 2, ", ", schools, " schools, first ", y[0], " +- ", s[0],
                                centred ? ", effects themselves" : ", effects in units of tau"),
            .accuracy = 1e-10};
}

// Neal: v ~ normal(0, 3), x_j ~ normal(0, exp(v / 2)).
HardIntegral funnel(Draws& draws) {
    const int n = draws.integer(2, 6);
    const double most = draws.uniform(4, 9), half = draws.log_uniform(10, 100);
    const double exact = integrate_by_panels(-most, most, 64, [&](double v) {
        return normal_density(v / 3) / 3 *
               std::pow(std::erf(half / std::exp(v / 2) / std::numbers::sqrt2), n - 1);
    });
    std::vector<Range> ranges{{-most, most}};
    for (int j = 1; j < n; ++j) ranges.push_back({-half, half});
    return {.ranges = ranges,
            .f =
                [=](const double* x) {
                    double square = 0;
                    for (int j = 1; j < n; ++j) square += x[j] * x[j];
                    const double v = x[0];
                    return normal_density(v / 3) / 3 * std::pow(2 * pi, -0.5 * (n - 1)) *
                           std::exp(-0.5 * (n - 1) * v - 0.5 * square * std::exp(-v));
                },
            .exact = exact,
            .parameters = words("n = ", n, ", v to +-", most, ", others to +-", half)};
}

constexpr HardFamily model_table[] = {
    {"regression",
     "likelihood of linear regression over its largest value: 2..8 coefficients, 15..30 values, polynomials "
     "on [0, 1] to the cubic or regressors with a common part 0..0.97, 7.5..14 standard deviations on both "
     "sides. Exact: determinant",
     regression},
    {"schools",
     "likelihood and prior of 2..7 schools with normal effects of unknown mean and spread (n in 4..9), "
     "effects in units of the spread, or themselves (to 4 schools). Exact: Gauss panels over the spread",
     schools},
    {"funnel",
     "Neal's funnel, v of deviation 3, n - 1 others of deviation exp(v / 2), over +-(4..9) and +-(10..100); "
     "n in 2..6. Exact: Gauss panels over error functions",
     funnel},
};

} // namespace

std::span<const HardFamily> judging_model_families() { return model_table; }

} // namespace montelux::bench
