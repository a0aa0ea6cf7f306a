#include "test/significance.h"
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <vector>

#include "montelux/mc/integrate/adaptive/gaussian.h"
#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/math/special.h"
#include "montelux/mc/stats/chi_squared.h"
#include "montelux/mc/stats/z_test.h"

namespace montelux {
namespace {

std::vector<double> random_matrix(int n, std::uint64_t seed) {
    TestUniforms uniforms(seed);
    std::vector<double> a(static_cast<std::size_t>(n * n));
    for (double& v : a) v = 2 * uniforms.next() - 1;
    return a;
}
// A A^T + 0.1.
std::vector<double> random_covariance(int n, std::uint64_t seed) {
    const std::vector<double> a = random_matrix(n, seed);
    const auto m = static_cast<std::size_t>(n);
    std::vector<double> c(m * m, 0.0);
    for (std::size_t i = 0; i < m; ++i)
        for (std::size_t j = 0; j < m; ++j) {
            for (std::size_t k = 0; k < m; ++k) c[i * m + j] += a[i * m + k] * a[j * m + k];
            if (i == j) c[i * m + j] += 0.1;
        }
    return c;
}

TEST(CholeskyFactor, MultipliesBackToTheMatrix) {
    const std::vector<double> known = cholesky_factor(std::vector<double>{4, 2, 2, 3}, 2);
    ASSERT_EQ(known.size(), 4u);
    EXPECT_DOUBLE_EQ(known[0], 2);
    EXPECT_EQ(known[1], 0);
    EXPECT_DOUBLE_EQ(known[2], 1);
    EXPECT_DOUBLE_EQ(known[3], std::sqrt(2.0));
    for (int n : {1, 2, 5, 12}) {
        const std::vector<double> c = random_covariance(n, 4), l = cholesky_factor(c, n);
        const auto m = static_cast<std::size_t>(n);
        ASSERT_EQ(l.size(), m * m);
        for (std::size_t i = 0; i < m; ++i)
            for (std::size_t j = 0; j < m; ++j) {
                double sum = 0;
                for (std::size_t k = 0; k < m; ++k) sum += l[i * m + k] * l[j * m + k];
                EXPECT_NEAR(sum, c[i * m + j], 1e-13 * n);
                if (j > i) {
                    EXPECT_EQ(l[i * m + j], 0);
                }
            }
    }
}

TEST(CholeskyFactor, EmptyForMatricesThatAreNotPositiveDefinite) {
    EXPECT_TRUE(cholesky_factor(std::vector<double>{1, 2, 2, 1}, 2).empty());
    EXPECT_TRUE(cholesky_factor(std::vector<double>{1, 1, 1, 1}, 2).empty());
    EXPECT_TRUE(cholesky_factor(std::vector<double>{-1}, 1).empty());
    EXPECT_TRUE(cholesky_factor(std::vector<double>{std::nan("")}, 1).empty());
}

TEST(SymmetricEigensystem, VectorsAreOrthonormalAndKeepTheirDirection) {
    Eigensystem known = symmetric_eigensystem({2, 1, 1, 2}, 2);
    std::ranges::sort(known.values);
    EXPECT_NEAR(known.values[0], 1, 1e-14);
    EXPECT_NEAR(known.values[1], 3, 1e-14);
    for (int n : {1, 2, 3, 8, 20}) {
        std::vector<double> a = random_matrix(n, 9);
        const auto m = static_cast<std::size_t>(n);
        for (std::size_t i = 0; i < m; ++i)
            for (std::size_t j = 0; j < i; ++j) a[i * m + j] = a[j * m + i];
        const Eigensystem e = symmetric_eigensystem(a, n);
        for (std::size_t k = 0; k < m; ++k)
            for (std::size_t i = 0; i < m; ++i) {
                double av = 0, product = 0;
                for (std::size_t j = 0; j < m; ++j) {
                    av += a[i * m + j] * e.vectors[j * m + k];
                    product += e.vectors[j * m + i] * e.vectors[j * m + k];
                }
                EXPECT_NEAR(av, e.values[k] * e.vectors[i * m + k], 1e-11) << "n " << n;
                EXPECT_NEAR(product, i == k ? 1 : 0, 1e-12) << "n " << n;
            }
    }
}

TEST(Gaussian, LogarithmOfTheDensityByItsFormula) {
    // Correlation 0.6, standard deviations 0.1 and 0.2.
    const double s = 0.1, t = 0.2, r = 0.6;
    const Gaussian g({0.3, 0.7}, cholesky_factor(std::vector<double>{s * s, r * s * t, r * s * t, t * t}, 2));
    PointBuffer x(3, 2);
    const std::vector<std::vector<double>> points{{0.3, 0.7}, {0.41, 0.55}, {-1, 2}};
    for (std::size_t i = 0; i < 3; ++i) {
        x(i, 0) = points[i][0];
        x(i, 1) = points[i][1];
    }
    std::vector<double> log_pdf(3);
    g.log_pdf(x, log_pdf);
    for (std::size_t i = 0; i < 3; ++i) {
        const double a = (points[i][0] - 0.3) / s, b = (points[i][1] - 0.7) / t;
        const double distance = (a * a - 2 * r * a * b + b * b) / (1 - r * r);
        EXPECT_NEAR(g.squared_distance(points[i]), distance, 1e-11 * (1 + distance));
        EXPECT_NEAR(log_pdf[i], -0.5 * distance - std::log(2 * pi * s * t * std::sqrt(1 - r * r)),
                    1e-11 * (1 + distance));
        EXPECT_NEAR(log_pdf[i], g.log_norm() - 0.5 * g.squared_distance(points[i]), 1e-11 * (1 + distance));
        EXPECT_NEAR(g.widened(2).squared_distance(points[i]), distance / 4, 1e-11 * (1 + distance));
    }
}

TEST(Gaussian, SamplesHaveItsMeanAndCovariance) {
    const int n = 3, count = 100'000;
    const std::vector<double> mean{0.2, -1, 5}, c = random_covariance(n, 6);
    const Gaussian g(mean, cholesky_factor(c, n));
    PointBuffer u(count, n), x(count, n);
    TestUniforms uniforms(1);
    for (std::size_t i = 0; i < count; ++i)
        for (int d = 0; d < n; ++d) u(i, d) = i == 0 ? 0.5 : uniforms.next();
    g.sample(u, x);
    for (int d = 0; d < n; ++d) EXPECT_EQ(x(0, d), mean[static_cast<std::size_t>(d)]);
    for (int i = 0; i < n; ++i) {
        const auto row = static_cast<std::size_t>(i);
        RunningMoments values;
        for (std::size_t k = 1; k < count; ++k) values.add(x(k, i));
        const TestResult r = unbiasedness_test(values, mean[row]);
        EXPECT_TRUE(r.passes(significance / 9)) << r.description;
        for (int j = 0; j <= i; ++j) {
            const auto column = static_cast<std::size_t>(j);
            RunningMoments products;
            for (std::size_t k = 1; k < count; ++k)
                products.add((x(k, i) - mean[row]) * (x(k, j) - mean[column]));
            const TestResult p = unbiasedness_test(products, c[row * n + column]);
            EXPECT_TRUE(p.passes(significance / 9)) << p.description;
        }
    }
}

TEST(Gaussian, SavedOneHasTheSameBitsAndBadFactorsAreRefused) {
    const Gaussian g({0.1, 0.2, 0.3}, cholesky_factor(random_covariance(3, 2), 3));
    StateWriter saved;
    g.save(saved);
    StateReader reader({saved.words().begin(), saved.words().end()});
    const Gaussian loaded = Gaussian::load(reader);
    EXPECT_TRUE(reader.at_end());
    EXPECT_EQ(loaded.log_norm(), g.log_norm());
    EXPECT_TRUE(std::ranges::equal(loaded.mean(), g.mean()));
    EXPECT_TRUE(std::ranges::equal(loaded.cholesky(), g.cholesky()));
    using V = std::vector<double>;
    EXPECT_THROW(Gaussian(V{0, 0}, V{1}), Error);
    EXPECT_THROW(Gaussian(V{0, 0}, V{1, 0, 0, 0}), Error);
}

// Uniform points of the unit square, weighted by a mixture of two Gaussians.
struct WeightedPoints {
    PointBuffer x;
    std::vector<double> weights;
};
WeightedPoints points_of(const std::vector<Gaussian>& mixture, const std::vector<double>& shares) {
    const std::size_t count = 40'000;
    WeightedPoints points{PointBuffer(count, 2), std::vector<double>(count, 0.0)};
    TestUniforms uniforms(2);
    for (std::size_t i = 0; i < count; ++i)
        for (int d = 0; d < 2; ++d) points.x(i, d) = uniforms.next();
    std::vector<double> log_pdf(count);
    for (std::size_t k = 0; k < mixture.size(); ++k) {
        mixture[k].log_pdf(points.x, log_pdf);
        for (std::size_t i = 0; i < count; ++i) points.weights[i] += shares[k] * std::exp(log_pdf[i]);
    }
    return points;
}

TEST(FitGaussians, RecoversTwoComponents) {
    const std::vector<double> first{0.004, 0.002, 0.002, 0.003}, second{0.002, 0, 0, 0.006};
    const std::vector<Gaussian> truth{Gaussian({0.35, 0.3}, cholesky_factor(first, 2)),
                                      Gaussian({0.65, 0.6}, cholesky_factor(second, 2))};
    const WeightedPoints points = points_of(truth, {0.25, 0.75});
    const std::vector<double> round{0.1, 0, 0, 0.1};
    std::vector<Gaussian> fit{Gaussian({0.3, 0.4}, round), Gaussian({0.6, 0.5}, round)};
    fit_gaussians(fit, points.x, points.weights, 60);
    ASSERT_EQ(fit.size(), 2u);
    for (std::size_t k = 0; k < 2; ++k) {
        const std::vector<double>& c = k == 0 ? first : second;
        const auto l = fit[k].cholesky();
        EXPECT_NEAR(fit[k].mean()[0], truth[k].mean()[0], 0.005);
        EXPECT_NEAR(fit[k].mean()[1], truth[k].mean()[1], 0.005);
        EXPECT_NEAR(l[0] * l[0], c[0], 4e-4);
        EXPECT_NEAR(l[0] * l[2], c[1], 4e-4);
        EXPECT_NEAR(l[2] * l[2] + l[3] * l[3], c[3], 4e-4);
    }
}

TEST(FitGaussians, DropsComponentsThatExplainNothing) {
    const std::vector<double> narrow{0.05, 0, 0, 0.05};
    const std::vector<Gaussian> truth{Gaussian({0.4, 0.5}, narrow)};
    const WeightedPoints points = points_of(truth, {1});
    std::vector<Gaussian> fit{Gaussian({0.9, 0.05}, {0.01, 0, 0, 0.01}), truth[0]};
    fit_gaussians(fit, points.x, points.weights, 20);
    ASSERT_EQ(fit.size(), 1u);
    EXPECT_NEAR(fit[0].mean()[0], 0.4, 0.005);
    EXPECT_NEAR(fit[0].mean()[1], 0.5, 0.005);
}

TEST(FitGaussians, ComponentsWithTooFewPointsKeepTheirShape) {
    // Four points: too few for a covariance in the plane.
    PointBuffer x(4, 2);
    for (std::size_t i = 0; i < 4; ++i) {
        x(i, 0) = 0.4 + 0.01 * static_cast<double>(i);
        x(i, 1) = 0.5;
    }
    const std::vector<double> factor{0.1, 0, 0, 0.1};
    std::vector<Gaussian> fit{Gaussian({0.45, 0.55}, factor)};
    fit_gaussians(fit, x, std::vector<double>(4, 1.0), 10);
    ASSERT_EQ(fit.size(), 1u);
    EXPECT_TRUE(std::ranges::equal(fit[0].cholesky(), factor));
    EXPECT_EQ(fit[0].mean()[0], 0.45);
}

} // namespace
} // namespace montelux
