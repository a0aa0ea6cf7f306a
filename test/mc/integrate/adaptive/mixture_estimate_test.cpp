#include <cmath>
#include <gtest/gtest.h>
#include <vector>

#include "montelux/mc/integrate/adaptive/mixture_estimate.h"

namespace montelux {
namespace {

constexpr int replicate_count = 8;

// Sums over n points of replicate_count whose means are `value` plus deviations that rise evenly to +-spread.
MixtureSums sums_of(double value, double spread, std::uint64_t n, int components = 1) {
    MixtureSums sums;
    sums.sums = ReplicateSums(replicate_count, components);
    sums.evaluations = n * replicate_count;
    const double count = static_cast<double>(n);
    for (int r = 0; r < replicate_count; ++r)
        sums.sums.sum(r, 0) = count * (value + spread * (2.0 * r / (replicate_count - 1) - 1));
    sums.channels = {{n * replicate_count, value * count * replicate_count, 0}};
    return sums;
}
// Standard error of the mean of what sums_of() makes with a spread of 1, and half a standard deviation of that error above.
double unit_error() {
    const double caution = 1 + 0.5 / std::sqrt(2.0 * (replicate_count - 1));
    double squares = 0;
    for (int r = 0; r < replicate_count; ++r) squares += std::pow(2.0 * r / (replicate_count - 1) - 1, 2);
    return caution * std::sqrt(squares / (replicate_count - 1) / replicate_count);
}
Tally tally_of(const MixtureEstimate& estimate) {
    Tally tally;
    estimate.tally(true, tally);
    return tally;
}

TEST(MixtureEstimate, MeanAndErrorOfTheReplicates) {
    MixtureEstimate estimate(replicate_count, 1);
    EXPECT_TRUE(std::isinf(tally_of(estimate).standard_error[0]));
    estimate.explore(sums_of(3, 0.1, 64), 64);
    const Tally tally = tally_of(estimate);
    EXPECT_DOUBLE_EQ(tally.value[0], 3);
    EXPECT_NEAR(tally.standard_error[0], 0.1 * unit_error(), 1e-12);
    EXPECT_NEAR(tally.covariance[0], std::pow(0.1 * unit_error(), 2), 1e-12);
    EXPECT_NEAR(estimate.error_ratio({.relative_error = 1e-2}), 0.1 * unit_error() / 0.03, 1e-9);
    EXPECT_NEAR(estimate.error_ratio({.relative_error = 1e-2, .absolute_error = 0.3}),
                0.1 * unit_error() / 0.3, 1e-9);
    EXPECT_NEAR(estimate.error_ratio({}), 0.1 * unit_error() / 3, 1e-9);
    EXPECT_EQ(estimate.expected_rest({.absolute_error = 1}), 0);
    EXPECT_GT(estimate.expected_rest({.relative_error = 1e-3}), 8 * 64);
    const double ratio = 0.1 * unit_error() / 0.003;
    EXPECT_NEAR(estimate.expected_rest({.relative_error = 1e-3}, 0.5),
                static_cast<double>(estimate.evaluations()) * (ratio * ratio - 1), 1e-6);
}

// Twice the points may lower the error by 2^1.5; what falls faster is held up, by a factor of three at most.
TEST(MixtureEstimate, ErrorsThatFallTooFastAreNotBelieved) {
    for (double share : {0.9, 0.3, 0.2, 0.01}) { // of the first error
        MixtureEstimate estimate(replicate_count, 1);
        estimate.grow(sums_of(3, 0.1, 64), 64);
        EXPECT_FALSE(estimate.compared());
        estimate.grow(sums_of(3, 0.1 * (2 * share - 1), 64), 128);
        EXPECT_TRUE(estimate.compared());
        const double error = tally_of(estimate).standard_error[0], plain = 0.1 * share * unit_error();
        const double least = 0.1 * unit_error() * std::pow(0.5, 1.5);
        EXPECT_NEAR(error, std::min(std::max(plain, least), 3 * plain), 1e-12) << share;
        estimate.compare_anew();
        EXPECT_FALSE(estimate.compared());
        EXPECT_NEAR(tally_of(estimate).standard_error[0], plain, 1e-12);
    }
}

TEST(MixtureEstimate, SuspectsOneSampleOrOneReplicate) {
    MixtureSums sums = sums_of(1, 0.01, 64);
    std::vector<double> values(64 * replicate_count, 1.0);
    values[5] = 4;
    sums.extremes = ExtremeValues(1);
    sums.extremes.add(0, values);
    MixtureEstimate even(replicate_count, 1);
    even.explore(sums, 64);
    EXPECT_FALSE(even.heavy_tailed(tally_of(even).standard_error[0]));
    EXPECT_FALSE(even.one_replicate_stands_out());
    values[5] = 20;
    sums.extremes = ExtremeValues(1);
    sums.extremes.add(0, values);
    sums.sums.sum(3, 0) += 20;
    MixtureEstimate uneven(replicate_count, 1);
    uneven.explore(sums, 64);
    const double one = 20.0 / (64 * replicate_count);
    EXPECT_TRUE(uneven.heavy_tailed(one));
    // The error of the one value, and of as many as may not have been drawn.
    EXPECT_GT(tally_of(uneven).standard_error[0], 2 * one);
    EXPECT_TRUE(uneven.one_replicate_stands_out());
}

TEST(MixtureEstimate, LostComponentsAreNoticed) {
    MixtureEstimate seen(replicate_count, 2), nothing(replicate_count, 2);
    MixtureSums sums = sums_of(1, 0.1, 64, 2);
    seen.explore(sums, 64);
    nothing.explore(sums_of(0, 0, 64, 2), 64);
    EXPECT_TRUE(nothing.lost_what_is_in(seen));
    EXPECT_FALSE(seen.lost_what_is_in(nothing));
    sums.sums.sum(0, 1) = 1;
    MixtureEstimate both(replicate_count, 2);
    both.explore(sums, 64);
    EXPECT_TRUE(seen.lost_what_is_in(both));
    EXPECT_FALSE(both.lost_what_is_in(seen));
}

TEST(MixtureEstimate, SavesAndLoadsItsBits) {
    MixtureEstimate estimate(replicate_count, 1), other(replicate_count, 1);
    estimate.grow(sums_of(3, 0.1, 64), 64);
    estimate.grow(sums_of(3.1, 0.1, 64), 128);
    StateWriter state;
    estimate.save(state);
    StateReader reader({state.words().begin(), state.words().end()});
    other.load(reader);
    EXPECT_EQ(tally_of(other).standard_error, tally_of(estimate).standard_error);
    EXPECT_EQ(other.points(), 128u);
    EXPECT_TRUE(other.compared());
}

} // namespace
} // namespace montelux
