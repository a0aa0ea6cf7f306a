#include <gtest/gtest.h>
#include <limits>
#include <utility>
#include <vector>

#include "montelux/mc/integrate/tally_checks.h"

namespace montelux {
namespace {

Tally tally(std::vector<double> value, std::vector<double> error) {
    Tally t;
    t.value = std::move(value);
    t.standard_error = std::move(error);
    t.evaluations = 100;
    t.statistical = true;
    return t;
}

StepRequest target(double relative, double absolute) {
    StepRequest request;
    request.relative_error = relative;
    request.absolute_error = absolute;
    return request;
}

TEST(TallyChecks, EveryComponentMeetsTheLargerOfTheTwoErrors) {
    const Tally t = tally({10, -100}, {0.1, 1});
    EXPECT_TRUE(meets(t, target(0.01, 0)));
    EXPECT_FALSE(meets(t, target(0.0099, 0)));
    EXPECT_TRUE(meets(t, target(0, 1)));
    EXPECT_FALSE(meets(t, target(0, 0.99))); // the second
    EXPECT_TRUE(meets(t, target(0.01, 0.05)));
    EXPECT_FALSE(meets(t, target(0, 0)));
    EXPECT_TRUE(meets(tally({0}, {0}), target(0, 0)));
    EXPECT_FALSE(meets(tally({1}, {std::numeric_limits<double>::quiet_NaN()}), target(1, 1)));
}

TEST(TallyChecks, SizesTakeThePlaceOfSmallerValues) {
    const Tally t = tally({0, 10}, {0.1, 0.1});
    StepRequest request = target(0.01, 0);
    EXPECT_FALSE(meets(t, request));
    const std::vector<double> sizes{10, 1};
    request.sizes = sizes;
    EXPECT_TRUE(meets(t, request));
    EXPECT_DOUBLE_EQ(request.tolerance(0, 0), 0.1);
    EXPECT_DOUBLE_EQ(request.tolerance(1, 10), 0.1);
}

TEST(TallyChecks, NothingIsFoundWhereAValueAndItsErrorAreZero) {
    EXPECT_TRUE(nothing_found(tally({1, 0}, {1, 0})));
    EXPECT_FALSE(nothing_found(tally({1, 0}, {1, 0.1})));
    EXPECT_FALSE(nothing_found(tally({1}, {0})));
    Tally rule = tally({0}, {0});
    rule.statistical = false;
    EXPECT_FALSE(nothing_found(rule));
    Tally empty = tally({0}, {0});
    empty.evaluations = 0;
    EXPECT_FALSE(nothing_found(empty));
}

TEST(TallyChecks, RoundingIsBelowTheResolutionOfDoublesInEveryComponent) {
    const double epsilon = std::numeric_limits<double>::epsilon();
    EXPECT_TRUE(is_rounding(tally({1, -1e100}, {epsilon, 1e100 * epsilon})));
    EXPECT_FALSE(is_rounding(tally({1, -1e100}, {2 * epsilon, 0})));
    EXPECT_FALSE(is_rounding(tally({0}, {0})));
}

} // namespace
} // namespace montelux
