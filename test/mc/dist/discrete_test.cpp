#include <cmath>
#include <gtest/gtest.h>
#include <string>

#include "montelux/mc/dist/alias_table.h"
#include "montelux/mc/dist/discrete.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/stats/chi_squared.h"
#include "montelux/mc/stats/z_test.h"

namespace montelux {
namespace {

const std::vector<std::vector<double>> tables{
    {1},
    {0, 0, 1, 0},
    {1, 2, 3, 4},
    {0, 5, 0, 0, 1e-3, 7, 0},
    {1e300, 1e300, 1e299},
    {1e-310, 2e-310},
    std::vector<double>(1000, 0.1),
};

// Counts against probabilities; and the remapped number must be uniform again.
template <typename Draw, typename Probability>
void expect_follows(std::size_t n, Draw draw, Probability probability) {
    TestUniforms u(17);
    std::vector<double> observed(n), expected(n), remapped;
    int samples = 100000;
    for (int i = 0; i < samples; ++i) {
        DiscreteSample<double> s = draw(u.next());
        ASSERT_LT(s.index, n);
        ASSERT_GT(s.probability, 0);
        ASSERT_NEAR(s.probability, probability(s.index), 1e-12);
        ASSERT_TRUE(s.remapped >= 0 && s.remapped < 1);
        observed[s.index] += 1;
        remapped.push_back(s.remapped);
    }
    for (std::size_t i = 0; i < n; ++i) expected[i] = samples * probability(i);
    auto r = chi_squared_test(observed, expected);
    EXPECT_TRUE(r.passes(1e-6)) << r.description;
    auto uniform = kolmogorov_smirnov_test(remapped, [](double x) { return x; });
    EXPECT_TRUE(uniform.passes(1e-6)) << uniform.description;
}

TEST(DiscreteDistribution, WalkBisectionAndAliasFollowTheWeights) {
    for (const auto& weights : tables) {
        DiscreteDistribution d(weights);
        AliasTable alias{std::span<const double>(weights)};
        long double sum = 0;
        for (double w : weights) sum += w;
        auto exact = [&](std::size_t i) { return static_cast<double>(weights[i] / sum); };
        for (std::size_t i = 0; i < weights.size(); ++i) {
            EXPECT_NEAR(d.probability(i), exact(i), 1e-15);
            EXPECT_NEAR(alias.probability(i), exact(i), 1e-7);
        }
        auto p = [&](std::size_t i) { return d.probability(i); };
        expect_follows(
            weights.size(), [&](double u) { return d.sample(u); }, p);
        expect_follows(
            weights.size(), [&](double u) { return alias.sample(u); },
            [&](std::size_t i) { return static_cast<double>(alias.probability(i)); });
    }
}

TEST(DiscreteDistribution, WalkingDrawsWhatBisectionDraws) {
    TestUniforms u(5);
    for (const auto& weights : tables) {
        DiscreteDistribution d(weights);
        for (int i = 0; i < 2000; ++i) {
            double v = u.next();
            ASSERT_EQ(d.sample(v).index, d.sample_by_walking(v).index);
        }
        for (double v : {0.0, one_minus_epsilon_d, 1.0}) {
            ASSERT_EQ(d.sample(v).index, d.sample_by_walking(v).index);
            ASSERT_GT(d.sample(v).probability, 0);
        }
    }
}

// Without chance: shares of a fine regular grid, where each bin holds at most two intervals.
TEST(AliasTable, SharesOfTheUnitIntervalAreTheProbabilities) {
    constexpr int points = 1 << 18;
    for (const auto& weights : tables) {
        AliasTable alias{std::span<const double>(weights)};
        std::size_t n = weights.size();
        std::vector<double> share(n);
        for (int i = 0; i < points; ++i) share[alias.sample((i + 0.5) / points).index] += 1.0 / points;
        for (std::size_t i = 0; i < n; ++i)
            ASSERT_NEAR(share[i], static_cast<double>(alias.probability(i)),
                        2.0 * static_cast<double>(n) / points + 1e-6);
    }
}

// A heavy index has a small rest of each of very many bins; all of them together are its probability.
TEST(AliasTable, SmallRestsOfManyBinsAddUp) {
    constexpr std::size_t n = 100000;
    std::vector<double> weights(n, 1);
    weights[0] = 3;
    const AliasTable alias{std::span<const double>(weights)};
    double rests = 0;
    for (std::size_t i = 1; i < n; ++i) {
        // Where in bin i its own index ends.
        double own = 0, other = 1;
        for (int step = 0; step < 48; ++step) {
            const double middle = 0.5 * (own + other);
            (alias.sample((static_cast<double>(i) + middle) / n).index == i ? own : other) = middle;
        }
        rests += 1 - own;
    }
    EXPECT_NEAR((1 + rests) / n, 3.0 / (n + 2), 1e-5 / n);
}

TEST(AliasTable, ZeroWeightsAreNeverDrawnByFloats) {
    std::vector<float> weights(777);
    TestUniforms u(5);
    for (float& w : weights) w = u.next() < 0.5 ? 0 : u.next_float();
    AliasTable alias{std::span<const float>(weights)};
    for (int i = 0; i < (1 << 20); ++i)
        ASSERT_GT(weights[alias.sample(static_cast<float>(i) * 0x1p-20f).index], 0);
    ASSERT_GT(weights[alias.sample(one_minus_epsilon).index], 0);
}

TEST(DiscreteDistribution, AllZeroWeightsAreUniform) {
    std::vector<double> zeros(4);
    DiscreteDistribution d(zeros);
    AliasTable alias{std::span<const double>(zeros)};
    EXPECT_EQ(d.weight_sum(), 0);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_DOUBLE_EQ(d.probability(i), 0.25);
        EXPECT_EQ(alias.probability(i), 0.25f);
        EXPECT_EQ(d.sample(0.25 * static_cast<double>(i)).index, i);
    }
}

TEST(DiscreteDistribution, BadWeightsGetASentence) {
    auto message = [](std::vector<double> w) -> std::string {
        try {
            DiscreteDistribution d(w);
        } catch (const Error& e) {
            return e.what();
        }
        return "";
    };
    EXPECT_EQ(message({1, -2, 3}),
              "DiscreteDistribution: weight 1 of 3 is -2; expected a finite number that is "
              "not negative");
    EXPECT_NE(message({NAN}).find("weight 0 of 1 is nan"), std::string::npos);
    EXPECT_NE(message({1, INFINITY}).find("weight 1 of 2 is inf"), std::string::npos);
    EXPECT_NE(message({}).find("found none"), std::string::npos);
    EXPECT_NE(message({1.7e308, 1.7e308}).find("overflows"), std::string::npos);
    std::vector<float> bad{1, -1};
    EXPECT_THROW(AliasTable{std::span<const float>(bad)}, Error);
}

} // namespace
} // namespace montelux
