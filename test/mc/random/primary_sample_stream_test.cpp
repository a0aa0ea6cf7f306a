#include "test/significance.h"
#include "uniformity.h"
#include <cmath>
#include <cstdint>
#include <gtest/gtest.h>
#include <vector>

#include "montelux/mc/random/primary_sample_stream.h"
#include "montelux/mc/stats/chi_squared.h"
#include "montelux/mc/stats/moments.h"

namespace montelux {
namespace {

using testing::uniform_square_p_value;

std::vector<double> draw(PrimarySamples& samples, int count) {
    PrimarySampleStream stream(samples);
    std::vector<double> u;
    for (int i = 0; i < count; ++i) {
        const float x = stream.next_1d();
        u.push_back(stream.refined(x));
    }
    return u;
}

// A uniform target accepts everything and stays uniform, whatever is mixed: large and small steps, and states of
// different lengths. Pairs of successive numbers and pairs far apart in time.
TEST(PrimarySamples, KeepAUniformTarget) {
    PrimarySamples samples(PhiloxStream(7));
    std::vector<Vec2d> neighbours, later;
    std::vector<double> before(6, 0.5);
    for (int t = 0; t < 400000; ++t) {
        if (t % 10 == 0)
            samples.propose_large();
        else
            samples.propose_small(SmallStep(0.2));
        const std::vector<double> u = draw(samples, 2 + t % 5);
        samples.accept();
        if (t % 10 == 9) neighbours.push_back({u[0], u[u.size() - 1]});
        if (t % 40 == 39) {
            later.push_back({before[1], u[1]});
            before = u;
        }
    }
    EXPECT_GT(uniform_square_p_value(neighbours, 8, 8), significance);
    EXPECT_GT(uniform_square_p_value(later, 8, 8), significance);
}

// Metropolis with p(x) = 2 x on one number and small steps alone: cells of states far apart.
TEST(PrimarySamples, SampleADensity) {
    PrimarySamples samples(PhiloxStream(3));
    samples.propose_large();
    double x = draw(samples, 1)[0];
    samples.accept();
    std::vector<double> observed(10, 0), expected;
    constexpr int kept = 20000, thin = 200;
    for (int t = 0; t < kept * thin; ++t) {
        samples.propose_small(SmallStep(0.45));
        const double y = draw(samples, 1)[0];
        if (samples.numbers().next_double() * x < y) {
            samples.accept();
            x = y;
        }
        if (t % thin == 0) ++observed[static_cast<std::size_t>(10 * x)];
    }
    for (int i = 0; i < 10; ++i) expected.push_back(kept * (2 * i + 1) / 100.0);
    EXPECT_GT(chi_squared_test(observed, expected).p_value, significance);
}

// Steps up and down are equally likely, and their lengths have the density 1 / (length log 64).
TEST(SmallStep, IsSymmetricAndLogUniform) {
    PhiloxStream numbers(11);
    const SmallStep step(0.04);
    std::vector<double> up(24, 0), down(24, 0);
    constexpr int n = 200000;
    for (int i = 0; i < n; ++i) {
        const double x = numbers.next_double(), y = step(x, numbers);
        ASSERT_TRUE(y >= 0 && y < 1);
        const double moved = y - x - std::round(y - x), length = std::abs(moved);
        ASSERT_TRUE(length < 0.04 * (1 + 1e-9) && length > (0.04 / 64) * (1 - 1e-9)) << moved;
        const auto cell = static_cast<std::size_t>(std::min(23.0, 4 * std::log2(length / (0.04 / 64))));
        ++(moved > 0 ? up : down)[cell];
    }
    const std::vector<double> expected(24, n / 48.0);
    EXPECT_GT(chi_squared_test(up, expected).p_value, significance);
    EXPECT_GT(chi_squared_test(down, expected).p_value, significance);
}

TEST(PrimarySamples, RejectionKeepsTheState) {
    PrimarySamples samples(PhiloxStream(5));
    samples.propose_large();
    const std::vector<double> current = draw(samples, 8);
    samples.accept();
    EXPECT_EQ(samples.dimensions(), 8u);
    for (int t = 0; t < 100; ++t) { // all rejected
        samples.propose_large();
        draw(samples, 20);
        samples.propose_small(SmallStep(1e-9));
        const std::vector<double> y = draw(samples, 8);
        for (std::size_t i = 0; i < 8; ++i) EXPECT_NEAR(y[i], current[i], 1.1e-9);
    }
    EXPECT_EQ(samples.dimensions(), 8u);
}

// What a shorter state forgets is drawn anew, not found again.
TEST(PrimarySamples, UnusedNumbersAreDrawnAnew) {
    PrimarySamples samples(PhiloxStream(6));
    RunningMoments moved;
    for (int t = 0; t < 1000; ++t) {
        samples.propose_large();
        const double x = draw(samples, 2)[1];
        samples.accept();
        samples.propose_small(SmallStep(1e-9));
        draw(samples, 1);
        samples.accept();
        samples.propose_small(SmallStep(1e-9));
        moved.add(std::abs(draw(samples, 2)[1] - x));
    }
    // Of two independent numbers: mean 1/3, variance 1/18.
    EXPECT_NEAR(moved.mean(), 1.0 / 3, 5 * std::sqrt(1.0 / 18 / 1000));
}

// Small steps keep 15 of 16 keys to the last bit, and draw the others anew.
TEST(PrimarySamples, SmallStepsKeepMostKeys) {
    PrimarySamples samples(PhiloxStream(8));
    samples.propose_large();
    Vec2f key = PrimarySampleStream(samples).next_key();
    samples.accept();
    int changed = 0;
    constexpr int n = 16000;
    std::vector<Vec2d> drawn;
    for (int t = 0; t < n; ++t) {
        samples.propose_small(SmallStep(0.1));
        const Vec2f next = PrimarySampleStream(samples).next_key();
        samples.accept();
        if (next.x == key.x && next.y == key.y) continue;
        ++changed;
        drawn.push_back(Vec2d(next));
        key = next;
    }
    EXPECT_NEAR(changed, n / 16, 5 * std::sqrt(n / 16.0));
    EXPECT_GT(uniform_square_p_value(drawn, 4, 4), significance);
}

TEST(PrimarySampleStream, RefinedNumbersBelongToTheirNumber) {
    PrimarySamples samples(PhiloxStream(9));
    for (int t = 0; t < 1000; ++t) {
        samples.propose_large();
        PrimarySampleStream stream(samples);
        const Vec2f pair = stream.next_2d();
        const double of_x = stream.refined(pair.x), of_y = stream.refined(pair.y);
        EXPECT_EQ(static_cast<float>(std::floor(of_x * 0x1p24) * 0x1p-24), pair.x);
        EXPECT_EQ(static_cast<float>(std::floor(of_y * 0x1p24) * 0x1p-24), pair.y);
        EXPECT_NE(of_x, static_cast<double>(pair.x));
        const float u = stream.next_1d();
        EXPECT_EQ(static_cast<float>(std::floor(stream.refined(u) * 0x1p24) * 0x1p-24), u);
    }
}

// The same key gives the same states, whatever was kept in memory.
TEST(PrimarySamples, RestartsAreReproducible) {
    PrimarySamples once(PhiloxStream(4)), again(PhiloxStream(12));
    again.propose_large();
    draw(again, 30);
    again.accept();
    again.restart(PhiloxStream(4));
    for (PrimarySamples* s : {&once, &again}) {
        s->propose_small(SmallStep(0.1)); // of no state: all is drawn anew
        draw(*s, 3);
        s->accept();
        s->propose_small(SmallStep(0.1));
    }
    EXPECT_EQ(draw(once, 6), draw(again, 6));
}

} // namespace
} // namespace montelux
