// One-dimensional warps (B2 to B5): chi-squared, round trip, and derivative of the inverse = density.
#include <functional>
#include <gtest/gtest.h>
#include <limits>
#include <string>

#include "montelux/mc/stats/chi_squared.h"
#include "montelux/mc/warp/cosine.h"
#include "montelux/mc/warp/equiangular.h"
#include "montelux/mc/warp/exponential.h"
#include "montelux/mc/warp/linear.h"
#include "montelux/mc/warp/tent.h"

namespace montelux {
namespace {

struct IntervalWarp {
    std::string name;
    std::function<double(double)> sample, inverse, pdf;
    double lower, upper;
};

std::vector<IntervalWarp> all_interval_warps() {
    auto linear = [](std::string name, double a, double b) {
        return IntervalWarp{std::move(name),
                            [=](double u) { return sample_linear(u, a, b); },
                            [=](double x) { return invert_linear(x, a, b); },
                            [=](double x) { return linear_pdf(x, a, b); },
                            0,
                            1};
    };
    auto equiangular = [](const char* name, Equiangular<double> d) {
        return IntervalWarp{name,
                            [=](double u) { return d.sample(u); },
                            [=](double x) { return d.invert(x); },
                            [=](double x) { return d.pdf(x); },
                            0,
                            d.length};
    };
    return {
        linear("LinearFromZero", 0, 1),
        linear("LinearToZero", 2, 0),
        linear("LinearFlat", 3, 3),
        linear("LinearUp", 1, 5),
        {"Tent", [](double u) { return sample_tent(u, 2.0); }, [](double x) { return invert_tent(x, 2.0); },
         [](double x) { return tent_pdf(x, 2.0); }, -2, 2},
        {"Exponential", [](double u) { return sample_exponential(u, 5.0); },
         [](double x) { return invert_exponential(x, 5.0); },
         [](double x) { return exponential_pdf(x, 5.0); }, 0, 10},
        {"TruncatedExponential", [](double u) { return sample_truncated_exponential(u, 3.0, 0.5); },
         [](double x) { return invert_truncated_exponential(x, 3.0, 0.5); },
         [](double x) { return truncated_exponential_pdf(x, 3.0, 0.5); }, 0, 0.5},
        equiangular("EquiangularBefore", {-0.5, 0.3, 2}),
        equiangular("EquiangularOnTheSegment", {0.7, 0.05, 2}),
        equiangular("EquiangularBehind", {3, 1, 2}),
        {"Cosine", [](double u) { return sample_cosine(u); }, [](double x) { return invert_cosine(x); },
         [](double x) { return cosine_pdf(x); }, 0, pi / 2},
        {"Quadratic", [](double u) { return sample_quadratic(u); },
         [](double x) { return invert_quadratic(x); }, [](double x) { return quadratic_pdf(x); }, -1, 1},
    };
}

class IntervalWarpTest : public testing::TestWithParam<IntervalWarp> {};

TEST_P(IntervalWarpTest, SamplesFollowTheDensity) {
    const IntervalWarp& w = GetParam();
    auto r = interval_chi_squared_test(w.sample, w.pdf, w.lower, w.upper, {.cells_x = 100});
    EXPECT_TRUE(r.passes(1e-6)) << r.description;
}

TEST_P(IntervalWarpTest, InverseUndoesSampleAndItsSlopeIsTheDensity) {
    const IntervalWarp& w = GetParam();
    TestUniforms uniforms(2);
    constexpr double h = 1e-6;
    for (int i = 0; i < 5000; ++i) {
        double u = 0.001 + 0.998 * uniforms.next(), x = w.sample(u);
        ASSERT_NEAR(w.inverse(x), u, 1e-12);
        ASSERT_NEAR((w.inverse(x + h) - w.inverse(x - h)) / (2 * h), w.pdf(x), 1e-5) << x;
    }
    EXPECT_GE(w.sample(0), w.lower);
    EXPECT_TRUE(std::isfinite(w.sample(one_minus_epsilon_d)));
}

INSTANTIATE_TEST_SUITE_P(All, IntervalWarpTest, testing::ValuesIn(all_interval_warps()),
                         [](const auto& warp) { return warp.param.name; });

TEST(EquiangularWarp, TheSegmentMayBeInfinite) {
    const Equiangular<double> d{2, 0.5, std::numeric_limits<double>::infinity()};
    EXPECT_NEAR(d.invert(1e12), 1, 1e-12);
    EXPECT_NEAR(d.sample(d.invert(7.0)), 7, 1e-12);
    EXPECT_GT(d.sample(one_minus_epsilon_d), 1e12);
    EXPECT_EQ(d.pdf(-1.0), 0);
}

TEST(ExponentialWarp, ShortPathsKeepTheirDigits) {
    EXPECT_NEAR(sample_exponential(1e-30f, 1.0f) / 1e-30f, 1, 1e-6f);
}

} // namespace
} // namespace montelux
