// The textbook's random variables, as the textbook states them: exponential, cosine, linear, quadratic.
#include "test/significance.h"
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <random>

#include "montelux/mc/dist/closed_form_inversion.h"
#include "montelux/mc/dist/families.h"
#include "montelux/mc/math/special.h"
#include "montelux/mc/stats/chi_squared.h"
#include "montelux/mc/stats/z_test.h"

namespace montelux {
namespace {

constexpr std::array some_xi{0.0, 1e-12, 0.1, 0.25, 0.5, 0.75, 0.9, 0.999};

// Ten thousand values with lambda = 5 beside as many of std::exponential_distribution: histograms of 40 bins
// against the law, and against each other.
TEST(RandomVariables, ExponentialBesideTheStandardLibrary) {
    static constexpr int count = 10000, bins = 40;
    constexpr double rate = 5, width = 0.05;
    std::mt19937_64 engine(12);
    std::exponential_distribution<double> standard(rate);
    ExponentialDistribution ours(rate), other(1.1 * rate);
    TestUniforms uniforms(12);
    std::vector<double> theirs_seen(bins + 1), ours_seen(bins + 1), expected(bins + 1), wrong(bins + 1);
    auto bin = [](double x) { return std::min(bins, static_cast<int>(x / width)); };
    double theirs_sum = 0, ours_sum = 0;
    for (int i = 0; i < count; ++i) {
        double a = standard(engine), b = ours.sample(uniforms.next());
        theirs_seen[bin(a)] += 1;
        ours_seen[bin(b)] += 1;
        theirs_sum += a;
        ours_sum += b;
    }
    for (int i = 0; i <= bins; ++i) {
        double to = i < bins ? (i + 1) * width : std::numeric_limits<double>::infinity();
        expected[i] = count * (ours.cdf(to) - ours.cdf(i * width));
        wrong[i] = count * (other.cdf(to) - other.cdf(i * width));
    }
    auto first = chi_squared_test(theirs_seen, expected), second = chi_squared_test(ours_seen, expected);
    EXPECT_TRUE(first.passes(significance)) << first.description;
    EXPECT_TRUE(second.passes(significance)) << second.description;
    EXPECT_FALSE(chi_squared_test(ours_seen, wrong).passes(significance));
    // Two samples of one size are of one law: the sum of (a - b)^2 / (a + b) over the bins is chi-squared.
    double statistic = 0;
    int used = 0;
    for (int i = 0; i <= bins; ++i) {
        double sum = theirs_seen[i] + ours_seen[i], difference = theirs_seen[i] - ours_seen[i];
        if (sum < 10) continue;
        statistic += difference * difference / sum;
        ++used;
    }
    EXPECT_GT(used, 20);
    EXPECT_GT(chi_squared_p_value(statistic, used - 1), significance);
    // Means 1/5 with standard error 1/5 / 100; 5 standard errors: 6e-7.
    EXPECT_NEAR(theirs_sum / count, 0.2, 5 * 0.002);
    EXPECT_NEAR(ours_sum / count, 0.2, 5 * 0.002);
    for (double xi : some_xi) EXPECT_NEAR(ours.quantile(xi), -std::log(1 - xi) / 5, 1e-15 / (1 - xi));
}

// X = asin(xi), and Y = xi beside it: the density on [0, pi/2) x [0, 1) is cos x.
TEST(RandomVariables, CosineAndItsPlane) {
    for (double xi : some_xi) {
        EXPECT_DOUBLE_EQ(CosineDistribution().quantile(xi), std::asin(xi));
        EXPECT_DOUBLE_EQ(CosineDistribution().pdf(std::asin(xi)), std::cos(std::asin(xi)));
    }
    ProductDistribution plane{CosineDistribution(), UniformDistribution()};
    auto p = plane.sample({0.5, 0.25});
    EXPECT_DOUBLE_EQ(p[0], pi / 6);
    EXPECT_DOUBLE_EQ(p[1], 0.25);
    EXPECT_DOUBLE_EQ(plane.pdf(p), std::cos(pi / 6));
    auto r = rectangle_chi_squared_test(
        [&](Vec2d u) {
            auto q = plane.sample({u.x, u.y});
            return Vec2d(q[0], q[1]);
        },
        [&](Vec2d q) {
            return plane.pdf({q.x, q.y});
        },
        {0, 0}, {pi / 2, 1});
    EXPECT_TRUE(r.passes(significance)) << r.description;
}

// On [0, 1): p = 2v, X = sqrt(xi). On [2, 4): c = 12, P = (v^2 - 4) / 12, X = 2 sqrt(3 xi + 1); from the
// family, from the recipe with F alone, with F^-1, and with neither.
TEST(RandomVariables, LinearAndItsRestriction) {
    LinearDistribution whole, family(2, 4);
    auto f = [](double v) { return 2 * v; };
    auto antiderivative = [](double v) { return v * v; };
    auto inverse = [](double y) { return std::sqrt(y); };
    auto by_f = inversion(f, 2, 4);
    auto by_antiderivative = inversion(f, antiderivative, 2, 4);
    auto by_inverse = inversion(f, antiderivative, inverse, 2, 4);
    EXPECT_NEAR(by_f.integral(), 12, 1e-12);
    EXPECT_EQ(by_antiderivative.integral(), 12);
    EXPECT_EQ(by_inverse.integral(), 12);
    for (double xi : some_xi) {
        EXPECT_DOUBLE_EQ(whole.quantile(xi), std::sqrt(xi));
        double x = 2 * std::sqrt(3 * xi + 1);
        EXPECT_NEAR(family.quantile(xi), x, 1e-15);
        EXPECT_NEAR(by_inverse.quantile(xi), x, 2e-15);
        EXPECT_NEAR(by_antiderivative.quantile(xi), x, 2e-15);
        EXPECT_NEAR(by_f.quantile(xi), x, 1e-14);
        for (double p : {family.cdf(x), by_f.cdf(x), by_antiderivative.cdf(x), by_inverse.cdf(x)})
            EXPECT_NEAR(p, (x * x - 4) / 12, 1e-15);
        for (double p : {family.pdf(x), by_f.pdf(x), by_antiderivative.pdf(x), by_inverse.pdf(x)})
            EXPECT_NEAR(p, x / 6, 1e-15);
    }
}

TEST(RandomVariables, QuadraticIsACubeRoot) {
    QuadraticDistribution d;
    auto recipe = inversion([](double x) { return x * x; }, [](double x) { return x * x * x / 3; }, -1, 1);
    for (double xi : some_xi) {
        double x = std::cbrt(2 * xi - 1);
        EXPECT_DOUBLE_EQ(d.quantile(xi), x);
        EXPECT_NEAR(d.pdf(x), 1.5 * x * x, 1e-15);
        // Where the density is zero, the middle, the recipe knows x to the cube root of the rounding of P
        // only.
        EXPECT_NEAR(recipe.quantile(xi), x, xi == 0.5 ? 1e-5 : 1e-15);
        EXPECT_NEAR(recipe.cdf(x), xi, 1e-15);
    }
}

} // namespace
} // namespace montelux
