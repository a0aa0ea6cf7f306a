#include <cmath>
#include <cstdint>
#include <gtest/gtest.h>
#include <utility>
#include <vector>

#include "montelux/mc/integrate/iteration_average.h"
#include "montelux/mc/math/special.h"
#include "montelux/mc/random/philox_stream.h"

namespace montelux {
namespace {

// Independent Gaussian iterations of mean 1, with the given weights and standard deviations.
Tally tally_of(const std::vector<std::pair<double, double>>& iterations, std::uint64_t seed) {
    PhiloxStream stream(seed);
    IterationAverage average(1, true);
    for (const auto& [weight, sigma] : iterations) {
        IterationEstimate iteration = IterationEstimate::zero(1, true);
        iteration.value[0] = 1 + sigma * normal_quantile(stream.next_double() + 1e-17);
        iteration.covariance[0] = sigma * sigma;
        iteration.points = 1000;
        average.add(weight, iteration);
    }
    Tally tally;
    average.tally(tally);
    return tally;
}

using Iterations = std::vector<std::pair<double, double>>;

class IterationsThatAgree : public testing::TestWithParam<Iterations> {};

TEST_P(IterationsThatAgree, HaveUniformPValues) {
    constexpr int seeds = 4000;
    int warnings = 0, below = 0;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        const Tally tally = tally_of(GetParam(), seed);
        warnings += !tally.warnings.empty();
        below += tally.p_value < 0.05;
    }
    // 200 and 4 are expected; the law of three moments is near, not exact.
    EXPECT_NEAR(below, 200, 70);
    EXPECT_LE(warnings, 16);
}

INSTANTIATE_TEST_SUITE_P(
    All, IterationsThatAgree,
    testing::Values(Iterations(10, {1, 1}),                                         // alike
                    Iterations{{1, 1}, {1, 0.1}, {1, 0.01}, {1, 0.01}, {1, 0.001}}, // the first is the error
                    Iterations{{1, 1}, {2, 0.2}, {4, 0.1}, {8, 0.1}, {16, 0.05}, {32, 0.03}},
                    Iterations{{5, 0.01}, {1, 1}, {1, 1}, {1, 1}, {1, 1}, {5, 0.01}}, // the reference is good
                    Iterations{{1, 0}, {1, 1}, {1, 1}, {1, 0.5}}));                   // one that is exact

TEST(IterationAverage, WeightsOfInverseVariancesGiveTheLawOfChiSquared) {
    // With weights of the inverse variances the differences are independent.
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        const Tally tally = tally_of({{1, 1}, {4, 0.5}, {1, 1}, {16, 0.25}, {4, 0.5}}, seed);
        EXPECT_EQ(tally.degrees_of_freedom, 4);
        EXPECT_NEAR(tally.p_value, chi_squared_p_value(tally.chi_squared, 4), 1e-9);
    }
}

TEST(IterationAverage, DisagreementIsAWarning) {
    IterationAverage average(1, true);
    for (const double value : {1., 1.02, 1.5}) {
        IterationEstimate iteration = IterationEstimate::zero(1, true);
        iteration.value[0] = value;
        iteration.covariance[0] = 1e-4;
        iteration.points = 1000;
        average.add(1, iteration);
    }
    Tally tally;
    average.tally(tally);
    ASSERT_EQ(tally.warnings.size(), 1u);
    EXPECT_NE(tally.warnings[0].find("the iterations disagree"), std::string::npos);
}

TEST(IterationAverage, GoesOnFromASavedState) {
    // See integrate_checkpoint_test.cpp for whole methods.
    IterationAverage whole(1, true);
    IterationEstimate iteration = IterationEstimate::zero(1, true);
    const auto add = [&](IterationAverage& average, double value, double variance) {
        iteration.value[0] = value;
        iteration.covariance[0] = variance;
        average.add(1, iteration);
    };
    add(whole, 1, 1);
    add(whole, 2, 0.1);
    StateWriter writer;
    whole.save(writer);
    IterationAverage resumed(1, true);
    StateReader reader({writer.words().begin(), writer.words().end()});
    resumed.load(reader);
    Tally a, b;
    for (IterationAverage* average : {&whole, &resumed}) {
        add(*average, 1.5, 0.1);
        add(*average, 1.6, 0.01);
        average->tally(average == &whole ? a : b);
    }
    EXPECT_EQ(a.value, b.value);
    EXPECT_EQ(a.chi_squared, b.chi_squared);
    EXPECT_EQ(a.p_value, b.p_value);
}

} // namespace
} // namespace montelux
