#include "test/mc/dist/message_of.h"
#include "test/significance.h"
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <limits>

#include "montelux/mc/dist/closed_form_inversion.h"
#include "montelux/mc/dist/families.h"
#include "montelux/mc/dist/inversion.h"
#include "montelux/mc/stats/chi_squared.h"

namespace montelux {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(NumericalInversion, ReproducesTheClosedForms) {
    // Unnormalised on purpose: c is found, not given.
    NumericalInversion linear([](double v) { return 7 * v; }, 2, 4);
    EXPECT_NEAR(linear.integral(), 42, 1e-11);
    NumericalInversion cosine([](double x) { return std::cos(x); }, 0, pi / 2);
    NumericalInversion quadratic([](double x) { return x * x; }, -1, 1);
    TestUniforms uniforms(2);
    for (int i = 0; i < 1000; ++i) {
        double xi = uniforms.next();
        ASSERT_NEAR(linear.quantile(xi), 2 * std::sqrt(3 * xi + 1), 1e-13);
        ASSERT_NEAR(cosine.quantile(xi), std::asin(xi), 1e-13 / std::sqrt(1 - xi));
        ASSERT_NEAR(quadratic.cdf(quadratic.quantile(xi)), xi, 1e-13);
        ASSERT_NEAR(quadratic.cdf_complement(quadratic.quantile_complement(xi)), xi, 1e-13);
        ASSERT_NEAR(linear.cdf(linear.quantile(xi)), xi, 1e-13);
    }
    EXPECT_NEAR(linear.pdf(3), 3 / 6.0, 1e-12);
    EXPECT_EQ(linear.pdf(1.9), 0);
    EXPECT_EQ(linear.cdf(1), 0);
    EXPECT_EQ(linear.cdf(5), 1);
}

// Both tails of laws on the whole line and on half lines, at scales that the recipe is not given.
TEST(NumericalInversion, InfiniteRanges) {
    NumericalInversion bell([](double x) { return std::exp(-0.5 * x * x); }, -infinity, infinity);
    NormalDistribution normal;
    EXPECT_NEAR(bell.integral(), std::sqrt(2 * pi), 1e-11);
    NumericalInversion lorentz([](double x) { return 1 / (1 + x * x); }, -infinity, infinity);
    CauchyDistribution cauchy;
    EXPECT_NEAR(lorentz.integral(), pi, 1e-11);
    for (double p : {1e-10, 1e-5, 0.01, 0.3, 0.5, 0.6}) {
        EXPECT_NEAR(bell.quantile(p), normal.quantile(p), 1e-9);
        EXPECT_NEAR(bell.quantile_complement(p), normal.quantile_complement(p), 1e-9);
        EXPECT_NEAR(bell.cdf(normal.quantile(p)), p, 1e-9 * p);
        EXPECT_NEAR(lorentz.quantile(p) - cauchy.quantile(p), 0, 1e-9 * (1 + std::abs(cauchy.quantile(p))));
        EXPECT_NEAR(lorentz.cdf_complement(-cauchy.quantile(p)), p, 1e-9 * p);
    }
    for (double scale : {1e-6, 1e-3, 1.0, 1e3, 1e6}) {
        NumericalInversion decay([=](double x) { return std::exp(-(x - 5) / scale); }, 5, infinity);
        NumericalInversion mirrored([=](double x) { return std::exp((x + 5) / scale); }, -infinity, -5);
        EXPECT_NEAR(decay.integral() / scale, 1, 1e-8) << scale;
        for (double xi : {1e-6, 0.5, 0.999}) {
            double distance = -std::log1p(-xi) * scale;
            EXPECT_NEAR(decay.quantile(xi), 5 + distance, 1e-8 * distance + 1e-14) << scale;
            EXPECT_NEAR(mirrored.quantile_complement(xi), -5 - distance, 1e-8 * distance + 1e-14) << scale;
        }
    }
    // A tail that falls so slowly that x = 1e10 is where one tenth is left.
    NumericalInversion heavy([](double x) { return std::pow(x, -1.1); }, 1, infinity);
    EXPECT_NEAR(heavy.integral(), 10, 1e-10);
    EXPECT_NEAR(heavy.quantile(0.9) / 1e10, 1, 1e-8);
}

TEST(NumericalInversion, SingularitiesAtEndsAndBreakPoints) {
    NumericalInversion root([](double x) { return 1 / std::sqrt(x); }, 0, 1);
    EXPECT_NEAR(root.integral(), 2, 1e-11);
    for (double xi : {1e-9, 0.01, 0.3, 0.9})
        EXPECT_NEAR(root.quantile(xi) / (xi * xi), 1, 3e-3 * 1e-9 / xi + 1e-10);
    NumericalInversion steep([](double x) { return std::pow(x, -0.9); }, 0, 1);
    EXPECT_NEAR(steep.integral(), 10, 1e-10);
    EXPECT_NEAR(steep.quantile(0.5) / std::pow(0.5, 10), 1, 1e-10);
    NumericalInversion logarithm([](double x) { return -std::log(x); }, 0, 1);
    EXPECT_NEAR(logarithm.integral(), 1, 1e-12);
    // Away from 0, numbers next to the singularity are epsilon apart, and sqrt(epsilon) of the integral is
    // lost.
    NumericalInversion end([](double x) { return 1 / std::sqrt(2 - x); }, 1, 2);
    EXPECT_NEAR(end.integral(), 2, 1e-7);
    EXPECT_NEAR(end.quantile(0.5), 1.75, 1e-7);
    auto both = [](double x) { return 1 / std::sqrt(std::abs(x)) + 1 / std::sqrt(std::abs(x - 1)); };
    NumericalInversion inside(both, -1, 2, {.break_points = {1, 0}});
    EXPECT_NEAR(inside.integral(), 2 * (2 + 2 * std::sqrt(2)), 1e-6);
    EXPECT_NEAR(inside.cdf(0.5), 0.5, 1e-7);
    EXPECT_NEAR(inside.quantile(0.5), 0.5, 1e-7);
    NumericalInversion gamma([](double x) { return std::pow(x, -0.7) * std::exp(-x); }, 0, infinity);
    GammaDistribution exact(0.3);
    for (double xi : {0.01, 0.5, 0.99}) EXPECT_NEAR(gamma.quantile(xi) / exact.quantile(xi), 1, 1e-9);
}

TEST(NumericalInversion, JumpsGapsAndPeaks) {
    auto step = [](double x) { return x < 0.3 ? 1.0 : (x < 0.7 ? 0.0 : 3.0); };
    NumericalInversion jump(step, 0, 1);
    EXPECT_NEAR(jump.integral(), 1.2, 1e-11);
    EXPECT_NEAR(jump.quantile(0.125), 0.15, 1e-11);
    EXPECT_NEAR(jump.quantile(0.625), 0.85, 1e-11);
    EXPECT_NEAR(jump.cdf(0.5), 0.25, 1e-11);
    EXPECT_NEAR(jump.cdf_complement(0.5), 0.75, 1e-11);
    // A peak of width 1e-6 on a range of 1e3, which a break point shows the way to.
    auto peak = [](double x) { return std::exp(-0.5 * std::pow((x - 777.7) / 1e-6, 2)); };
    NumericalInversion found(peak, 0, 1000, {.break_points = {777.7}});
    EXPECT_NEAR(found.integral() / (std::sqrt(2 * pi) * 1e-6), 1, 1e-6);
    EXPECT_NEAR((found.quantile(0.9) - 777.7) / 1e-6, NormalDistribution().quantile(0.9), 1e-6);
    auto bumps = [](double x) {
        return std::exp(-50 * (x - 0.2) * (x - 0.2)) + 0.1 * std::abs(std::sin(9 * x));
    };
    NumericalInversion any(bumps, -1, 2);
    auto r = interval_chi_squared_test([&](double u) { return any.sample(u); },
                                       [&](double x) { return any.pdf(x); }, -1, 2,
                                       {.samples = 50000, .cells_x = 100});
    EXPECT_TRUE(r.passes(significance)) << r.description;
}

TEST(NumericalInversion, SaysWhatItReached) {
    auto f = [](double x) { return std::exp(-x) * (2 + std::sin(30 * x)); };
    NumericalInversion fine(f, 0, 5, {.tolerance = 1e-13}), coarse(f, 0, 5, 1e-3);
    EXPECT_LE(fine.relative_error(), 1e-13);
    EXPECT_LE(coarse.relative_error(), 1e-3);
    EXPECT_LE(std::abs(coarse.integral() / fine.integral() - 1), coarse.relative_error() + 1e-13);
}

void expect_message(const std::function<void()>& build, const std::string& part) {
    std::string sentence = message_of(build);
    EXPECT_NE(sentence.find(part), std::string::npos) << "'" << sentence << "' should say '" << part << "'";
}

TEST(NumericalInversion, BadFunctionsGetASentence) {
    auto build = [](auto f, double a = 0, double b = 1, InversionOptions options = {}) {
        return [=] { NumericalInversion(f, a, b, options); };
    };
    auto one = [](double) { return 1.0; };
    expect_message(build([](double x) { return x - 0.5; }), "expected a finite number that is not negative");
    expect_message(build([](double) { return std::nan(""); }), "the function is nan at x = ");
    expect_message(build([](double) { return 0.0; }), "zero wherever it was asked on [0, 1]");
    expect_message(build(one, 1, 1), "the interval [1, 1] is empty");
    expect_message(build(one, 2, 1), "the interval [2, 1] is empty");
    expect_message(build(one, std::nan(""), 1), "is empty; expected a < b");
    expect_message(build(one, 0, infinity), "not integrable");
    expect_message(build([](double x) { return 1 / x; }), "not integrable");
    expect_message(build([](double x) { return 1 / (x - 1); }, 1, 2), "not integrable");
    expect_message(build([](double x) { return 1 / x; }, 1, infinity), "not integrable");
    expect_message(build([](double x) { return 1 / std::abs(x - 0.3); }, 0, 1, {.break_points = {0.3}}),
                   "not integrable");
    expect_message(build(one, 0, 1, {.break_points = {1.5}}), "the break point 1.5 is not in [0, 1]");
    expect_message(build(one, 0, 1, {.break_points = {std::nan("")}}), "the break point nan is not in");
}

// With an antiderivative, and with its inverse too, on every kind of range.
TEST(ClosedFormInversion, AgreesWithTheFamilies) {
    auto decay = inversion([](double x) { return std::exp(-5 * x); },
                           [](double x) { return -std::expm1(-5 * x) / 5; }, 0, infinity);
    auto decay_inverse =
        inversion([](double x) { return std::exp(-5 * x); }, [](double x) { return -std::expm1(-5 * x) / 5; },
                  [](double y) { return -std::log1p(-5 * y) / 5; }, 0, infinity);
    auto lorentz = inversion([](double x) { return 1 / (1 + x * x); }, [](double x) { return std::atan(x); },
                             -infinity, infinity);
    auto growth =
        inversion([](double x) { return std::exp(x); }, [](double x) { return std::exp(x); }, -infinity, 2);
    ExponentialDistribution exponential(5);
    CauchyDistribution cauchy;
    for (double xi : {1e-12, 1e-3, 0.2, 0.5, 0.7, 0.99}) {
        EXPECT_NEAR(decay.quantile(xi) / exponential.quantile(xi), 1, 1e-14);
        EXPECT_NEAR(decay_inverse.quantile(xi) / exponential.quantile(xi), 1, 1e-14);
        EXPECT_NEAR(decay.cdf(exponential.quantile(xi)), xi, 1e-14 * xi);
        double x = cauchy.quantile(xi);
        EXPECT_NEAR(lorentz.cdf(x), xi, 1e-15);
        EXPECT_NEAR(lorentz.quantile(lorentz.cdf(x)), x, 4e-16 * (1 + x * x) * pi);
        EXPECT_NEAR(growth.quantile(xi), 2 + std::log(xi), 1e-14);
        EXPECT_NEAR(growth.quantile_complement(xi), 2 + std::log1p(-xi), 1e-14);
    }
    EXPECT_NEAR(decay.pdf(0.1), exponential.pdf(0.1), 1e-15);
    EXPECT_EQ(lorentz.quantile(0), -infinity);
    EXPECT_TRUE(std::isfinite(lorentz.sample(0)));
    auto r = interval_chi_squared_test([&](double xi) { return lorentz.sample(xi); },
                                       [&](double x) { return lorentz.pdf(x); }, -6, 6, {.cells_x = 60});
    EXPECT_TRUE(r.passes(significance)) << r.description;
}

TEST(ClosedFormInversion, WrongAntiderivativesGetASentence) {
    auto x = [](double v) { return v; };
    auto square = [](double v) { return v * v; };
    auto half_square = [](double v) { return 0.5 * v * v; };
    expect_message([&] { inversion(x, square, 0, 1); }, "expected one whose derivative is the density");
    expect_message([&] { inversion(x, half_square, x, 0, 1); }, "and its own inverse");
    expect_message([&] { inversion(x, half_square, -1, 1); }, "expected finite values that grow");
    expect_message([&] { inversion(x, half_square, 1, 0); }, "the interval [1, 0] is empty");
    expect_message([&] { inversion(x, half_square, 0, infinity); }, "expected finite values that grow");
    auto sine = [](double v) { return std::sin(v); };
    auto minus_cosine = [](double v) { return -std::cos(v); };
    expect_message([&] { inversion(sine, minus_cosine, 0, 4); }, "expected one that does not fall");
    expect_message([&] { inversion([](double v) { return v - 0.1; }, half_square, 0, 1); },
                   "expected a finite number that is not negative");
    EXPECT_EQ(message_of([&] { inversion(sine, minus_cosine, 0, pi); }), "no error");
}

} // namespace
} // namespace montelux
