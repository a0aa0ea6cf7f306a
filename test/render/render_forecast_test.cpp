#include <cstdint>
#include <gtest/gtest.h>
#include <limits>

#include "montelux/render/render_forecast.h"

namespace montelux {
namespace {

// 1000 of 10000 samples in 2 s.
RenderPace pace() {
    return {.samples_done = 1000, .samples_most = 10000, .seconds = 2, .run_samples = 1000, .run_seconds = 2};
}

TEST(RenderForecast, OfSamplesAlone) {
    const RenderForecast f = forecast(pace(), {});
    EXPECT_DOUBLE_EQ(f.share, 0.1);
    EXPECT_DOUBLE_EQ(f.seconds_left.value(), 18);
}

TEST(RenderForecast, TimeEndsWhatWouldTakeLonger) {
    RenderPace p = pace();
    p.samples_most = 1'000'000'000;
    const RenderForecast f = forecast(p, {.time = 20});
    EXPECT_DOUBLE_EQ(f.share, 0.1);
    EXPECT_DOUBLE_EQ(f.seconds_left.value(), 18);
    // Samples come first.
    EXPECT_DOUBLE_EQ(forecast(pace(), {.time = 200}).seconds_left.value(), 18);
}

TEST(RenderForecast, AnUnknownErrorGivesNone) {
    const RenderForecast f = forecast(pace(), {.error = 0.01});
    EXPECT_EQ(f.share, 0);
    EXPECT_FALSE(f.seconds_left);
    // A time limit is known from the start.
    EXPECT_DOUBLE_EQ(forecast(pace(), {.error = 0.01, .time = 8}).seconds_left.value(), 6);
}

TEST(RenderForecast, OfAnError) {
    RenderPace p = pace();
    p.samples_for_error = 4000;
    const RenderForecast f = forecast(p, {.error = 0.01});
    EXPECT_DOUBLE_EQ(f.share, 0.25);
    EXPECT_DOUBLE_EQ(f.seconds_left.value(), 6);
    // More than may be taken.
    p.samples_for_error = 40000;
    EXPECT_DOUBLE_EQ(forecast(p, {.error = 0.01}).share, 0.1);
    // The estimate was exceeded.
    p.samples_for_error = 900;
    EXPECT_DOUBLE_EQ(forecast(p, {.error = 0.01}).share, 1);
    EXPECT_DOUBLE_EQ(forecast(p, {.error = 0.01}).seconds_left.value(), 0);
}

// A render whose error is nearly small enough still ends only where the error is looked at.
TEST(RenderForecast, ErrorsAreLookedAtBetweenRounds) {
    RenderPace p = pace();
    p.samples_for_error = 1010;
    p.end_of_round = 2000;
    const RenderForecast f = forecast(p, {.error = 0.01});
    EXPECT_DOUBLE_EQ(f.share, 0.5);
    EXPECT_DOUBLE_EQ(f.seconds_left.value(), 2);
    EXPECT_DOUBLE_EQ(forecast(p, {}).seconds_left.value(), 18); // without a target they do not count
}

TEST(RenderForecast, SamplesForAnError) {
    EXPECT_EQ(samples_for_error(100, 0.2, 0.1), 400u);
    EXPECT_EQ(samples_for_error(100, 1e20, 1e-20), std::uint64_t(1e18));
    EXPECT_FALSE(samples_for_error(100, std::numeric_limits<double>::infinity(), 0.1));
}

TEST(RenderForecast, SpeedIsThatOfThisRun) {
    // 1000 samples in 100 s long ago, 500 in 1 s now.
    const RenderPace p{
        .samples_done = 1500, .samples_most = 2000, .seconds = 101, .run_samples = 500, .run_seconds = 1};
    EXPECT_DOUBLE_EQ(forecast(p, {}).seconds_left.value(), 1);
}

TEST(RenderForecast, BeforeTheFirstSample) {
    const RenderPace p{.samples_most = 2000};
    EXPECT_FALSE(forecast(p, {}).seconds_left);
    EXPECT_DOUBLE_EQ(forecast(p, {.time = 5}).seconds_left.value(), 5);
    EXPECT_EQ(forecast({.samples_done = 5, .samples_most = 5}, {}).share, 1);
}

} // namespace
} // namespace montelux
