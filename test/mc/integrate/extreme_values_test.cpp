#include <cmath>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "montelux/mc/integrate/extreme_values.h"
#include "montelux/mc/integrate/integrate.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

ExtremeValues of(const std::vector<double>& values) {
    ExtremeValues extremes(1);
    extremes.add(0, values);
    return extremes;
}
bool warns_of_tail(const IntegrationResult& r) {
    for (const std::string& warning : r.warnings)
        if (warning.find("Pareto tail") != std::string::npos) return true;
    return false;
}

// Hits of a rare event and misses of a common one have the same error, which follows their number.
TEST(ExtremeValues, ErrorsOfFewHitsAndFewMisses) {
    const int n = 10'000;
    for (int hits : {1, 3, 10}) {
        std::vector<double> rare(n, 0.0), common(n, 1.0);
        for (int i = 0; i < hits; ++i) rare[static_cast<std::size_t>(i * 31)] = 1;
        for (int i = 0; i < hits; ++i) common[static_cast<std::size_t>(i * 31)] = 0;
        const double expected = (std::sqrt(hits) + 1.32 / hits) / n;
        EXPECT_NEAR(of(rare).least_standard_error(0, n), expected, 2e-3 * expected);
        EXPECT_NEAR(of(common).least_standard_error(0, n), expected, 2e-3 * expected);
    }
    std::vector<double> many(n, 0.0);
    for (std::size_t i = 0; i < 100; ++i) many[i] = 1;
    EXPECT_EQ(of(many).least_standard_error(0, n), 0);
}

TEST(ExtremeValues, EqualValuesFollowTheRuleOfThree) {
    const std::vector<double> equal(1000, -0.7);
    EXPECT_NEAR(of(equal).least_standard_error(0, 1000), 1.5 * 0.7 / 1000, 1e-12);
    EXPECT_EQ(of(std::vector<double>(1000, 0.0)).least_standard_error(0, 1000), 0);
    // Values that were not added are zeros.
    EXPECT_EQ(of(equal).least_standard_error(0, 2000), 0);
    EXPECT_GT(of(equal).least_standard_error(0, 1003), 2 * 0.7 / 1003);
}

TEST(ExtremeValues, SavesAndLoadsItsBits) {
    ExtremeValues extremes = of({1, 2, 7, -3}), other(1), wrong(2);
    StateWriter state, again;
    extremes.save(state);
    StateReader reader({state.words().begin(), state.words().end()}), second = reader;
    other.load(reader);
    other.save(again);
    EXPECT_TRUE(std::ranges::equal(state.words(), again.words()));
    EXPECT_EQ(other.largest(), 7);
    EXPECT_THROW(wrong.load(second), Error);
}

// A hole of one thousandth: whether a point hits it or not, the error accounts for it.
TEST(ExtremeValues, ComplementsOfRareEventsHaveAnError) {
    auto f = [](std::span<const double> x) {
        return std::hypot(x[0] - 0.3, x[1] - 0.6) < 0.0062 ? 0.0 : 1.0;
    };
    const double truth = 1 - 3.14159265358979 * 0.0062 * 0.0062;
    for (const char* name : {"basic", "quasi", "stratified", "recursive", "vegas", "vegas_sobol", "adaptive"})
        for (std::uint64_t seed = 1; seed <= 5; ++seed) {
            const IntegrationResult r = integrate(f, Domain::unit_cube(2), Method::named(name),
                                                  {.evaluations = 8000}, {.seed = seed, .threads = 1});
            // Vegas allots many points to the box of a hole that it has met.
            const double least = std::string(name) == "vegas" ? 0.4 : 1;
            EXPECT_GT(r.standard_error[0], least / 8000.0) << name << " " << seed;
            EXPECT_LT(r.standard_error[0], 8 / 8000.0) << name << " " << seed;
            EXPECT_LT(std::abs(r.value[0] - truth), 5 * r.standard_error[0]) << name << " " << seed;
        }
}

// Equal values of all points: exact or not, 3 of n others would have been missed with a probability of 5 %.
TEST(ExtremeValues, ConstantsHaveAnError) {
    auto f = [](std::span<const double>) { return 3.0; };
    for (const char* name :
         {"basic", "quasi", "stratified", "recursive", "vegas", "vegas_sobol", "adaptive"}) {
        const IntegrationResult r =
            integrate(f, Domain::unit_cube(2), Method::named(name), {.evaluations = 8000}, {.threads = 1});
        EXPECT_GT(r.standard_error[0], 1.4 * 3 / 8000) << name;
        EXPECT_LT(r.standard_error[0], 3.0 * 3 / 8000) << name;
        EXPECT_NEAR(r.covariance[0], r.standard_error[0] * r.standard_error[0], 1e-12) << name;
    }
}

TEST(ExtremeValues, InfiniteVarianceGivesAWarning) {
    auto f = [](std::span<const double> x) {
        const double sum = x[0] + x[1] + x[2];
        return std::pow(sum - std::floor(sum) + 1e-300, -0.85);
    };
    auto g = [](std::span<const double> x) {
        const double sum = x[0] + x[1] + x[2];
        return std::pow(sum - std::floor(sum) + 1e-300, -0.3);
    };
    for (const char* name :
         {"basic", "quasi", "stratified", "recursive", "vegas", "vegas_sobol", "adaptive"}) {
        int infinite = 0, finite = 0;
        for (std::uint64_t seed = 1; seed <= 10; ++seed) {
            const Budget budget{.evaluations = 60'000};
            const IntegrationOptions options{.seed = seed, .threads = 1};
            infinite +=
                warns_of_tail(integrate(f, Domain::unit_cube(3), Method::named(name), budget, options));
            finite += warns_of_tail(integrate(g, Domain::unit_cube(3), Method::named(name), budget, options));
        }
        // Few strata reveal less.
        const bool strata = std::string(name) == "stratified" || std::string(name) == "recursive";
        EXPECT_GE(infinite, strata ? 2 : 6) << name;
        EXPECT_EQ(finite, 0) << name;
    }
}

} // namespace
} // namespace montelux
