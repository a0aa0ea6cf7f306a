#include <cmath>
#include <gtest/gtest.h>
#include <random>

#include "montelux/mc/dist/families.h"
#include "montelux/mc/dist/inversion.h"
#include "montelux/mc/stats/chi_squared.h"
#include "montelux/mc/stats/z_test.h"

namespace montelux {
namespace {

constexpr double significance = 1e-6;

// Chi-squared of the quantile against the pdf, cdf o quantile = identity, slope of the cdf = pdf.
template <Distribution1D D>
void check_family(const D& d, double lower, double upper) {
    auto r = interval_chi_squared_test([&](double u) { return d.quantile(u); },
                                       [&](double x) { return d.pdf(x); }, lower, upper, {.cells_x = 60});
    EXPECT_TRUE(r.passes(significance)) << r.description;
    TestUniforms uniforms(9);
    for (int i = 0; i < 1000; ++i) {
        double u = 0.001 + 0.998 * uniforms.next(), x = d.quantile(u), h = 1e-6;
        ASSERT_NEAR(d.cdf(x), u, 1e-12);
        ASSERT_NEAR((d.cdf(x + h) - d.cdf(x - h)) / (2 * h), d.pdf(x), 2e-5 * (1 + d.pdf(x))) << x;
    }
    EXPECT_EQ(d.cdf(d.lower()), 0);
    EXPECT_EQ(d.cdf(d.upper()), 1);
}

TEST(Families, PdfCdfAndQuantileAgree) {
    check_family(UniformDistribution(-1, 3), -1, 3);
    check_family(ExponentialDistribution(5), 0, 4);
    check_family(LinearDistribution(), 0, 1);
    check_family(LinearDistribution(2, 4), 2, 4);
    check_family(CosineDistribution(), 0, pi / 2);
    check_family(QuadraticDistribution(), -1, 1);
    check_family(NormalDistribution(1, 0.5), -2, 4);
}

TEST(Families, ClosedFormsOfTheQuantiles) {
    for (double xi : {0.0, 0.1, 0.5, 0.9}) {
        EXPECT_NEAR(LinearDistribution(2, 4).quantile(xi), 2 * std::sqrt(3 * xi + 1), 1e-15);
        EXPECT_NEAR(ExponentialDistribution(5).quantile(xi), -std::log(1 - xi) / 5, 1e-15);
    }
    EXPECT_THROW(ExponentialDistribution(0), Error);
    EXPECT_THROW(LinearDistribution(-1, 1), Error);
}

// B2: ten thousand samples beside the standard library's own distribution.
TEST(Families, ExponentialBesideTheStandardLibrary) {
    std::mt19937_64 engine(12);
    std::exponential_distribution<double> standard(5);
    TestUniforms uniforms(12);
    ExponentialDistribution ours(5);
    std::vector<double> a, b;
    for (int i = 0; i < 10000; ++i) {
        a.push_back(standard(engine));
        b.push_back(ours.quantile(uniforms.next()));
    }
    auto cdf = [&](double x) { return ours.cdf(x); };
    EXPECT_TRUE(kolmogorov_smirnov_test(a, cdf).passes(significance));
    EXPECT_TRUE(kolmogorov_smirnov_test(b, cdf).passes(significance));
    auto other = [](double x) { return -std::expm1(-5.5 * x); };
    EXPECT_FALSE(kolmogorov_smirnov_test(b, other).passes(significance));
}

TEST(ProductDistribution, DensityIsTheProductInOrder) {
    ProductDistribution d(CosineDistribution(), LinearDistribution(2, 4), UniformDistribution(0, 2));
    auto x = d.quantile({0.5, 0.25, 0.75});
    EXPECT_NEAR(x[0], std::asin(0.5), 1e-15);
    EXPECT_NEAR(x[1], 2 * std::sqrt(1.75), 1e-15);
    EXPECT_NEAR(x[2], 1.5, 1e-15);
    EXPECT_NEAR(d.pdf(x), std::cos(x[0]) * x[1] / 6 * 0.5, 1e-15);
    EXPECT_NEAR(d.cdf(x)[1], 0.25, 1e-15);
    ProductDistribution plane{CosineDistribution(), UniformDistribution()};
    auto r = rectangle_chi_squared_test(
        [&](Vec2d u) {
            auto p = plane.quantile({u.x, u.y});
            return Vec2d(p[0], p[1]);
        },
        [&](Vec2d p) {
            return plane.pdf({p.x, p.y});
        },
        {0, 0}, {pi / 2, 1});
    EXPECT_TRUE(r.passes(significance)) << r.description;
}

TEST(NumericalInversion, ReproducesTheClosedForms) {
    // Unnormalised on purpose: c is found, not given.
    NumericalInversion linear([](double v) { return 7 * v; }, 2, 4);
    EXPECT_NEAR(linear.integral(), 42, 1e-11);
    NumericalInversion cosine([](double x) { return std::cos(x); }, 0, pi / 2);
    NumericalInversion quadratic([](double x) { return x * x; }, -1, 1);
    TestUniforms uniforms(2);
    for (int i = 0; i < 1000; ++i) {
        double xi = uniforms.next();
        ASSERT_NEAR(linear.quantile(xi), 2 * std::sqrt(3 * xi + 1), 1e-12);
        ASSERT_NEAR(cosine.quantile(xi), std::asin(xi), 1e-12 / std::sqrt(1 - xi));
        ASSERT_NEAR(quadratic.cdf(quadratic.quantile(xi)), xi, 1e-12);
        ASSERT_NEAR(linear.cdf(linear.quantile(xi)), xi, 1e-13);
    }
    EXPECT_NEAR(linear.pdf(3), 3 / 6.0, 1e-12);
}

TEST(NumericalInversion, JumpsGapsAndEndpointSingularities) {
    auto step = [](double x) { return x < 0.3 ? 1.0 : (x < 0.7 ? 0.0 : 3.0); };
    NumericalInversion jump(step, 0, 1);
    EXPECT_NEAR(jump.integral(), 1.2, 1e-11);
    EXPECT_NEAR(jump.quantile(0.125), 0.15, 1e-11);
    EXPECT_NEAR(jump.quantile(0.625), 0.85, 1e-11);
    NumericalInversion root([](double x) { return 1 / std::sqrt(x); }, 0, 1);
    EXPECT_NEAR(root.integral(), 2, 1e-6);
    for (double xi : {0.01, 0.3, 0.9}) EXPECT_NEAR(root.quantile(xi), xi * xi, 1e-6);
    auto bumps = [](double x) {
        return std::exp(-50 * (x - 0.2) * (x - 0.2)) + 0.1 * std::abs(std::sin(9 * x));
    };
    NumericalInversion any(bumps, -1, 2);
    auto r = interval_chi_squared_test([&](double u) { return any.quantile(u); },
                                       [&](double x) { return any.pdf(x); }, -1, 2,
                                       {.samples = 50000, .cells_x = 100});
    EXPECT_TRUE(r.passes(significance)) << r.description;
}

TEST(NumericalInversion, BadFunctionsGetASentence) {
    auto build = [](auto f) { return NumericalInversion(f, 0, 1); };
    EXPECT_THROW(build([](double x) { return x - 0.5; }), Error);
    EXPECT_THROW(build([](double) { return std::nan(""); }), Error);
    EXPECT_THROW(build([](double) { return 0.0; }), Error);
    EXPECT_THROW(NumericalInversion([](double) { return 1.0; }, 1, 1), Error);
}

} // namespace
} // namespace montelux
