#include <array>
#include <gtest/gtest.h>
#include <limits>
#include <vector>

#include "montelux/mc/integrate/mis.h"

namespace montelux {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();
const MisHeuristic heuristics[] = {
    MisHeuristic::balance(),   MisHeuristic::power(),   MisHeuristic::power(0.5), MisHeuristic::power(8),
    MisHeuristic::cutoff(0.1), MisHeuristic::cutoff(1), MisHeuristic::maximum()};

TEST(MisWeight, WeightsSumToOneWhereSomeStrategyCanDraw) {
    const std::vector<std::vector<double>> cases{
        {1, 2, 3},   {0, 0, 5},        {1e-300, 1e-301, 0}, {1e300, 1e300, 1e299},
        {inf, 1, 0}, {inf, inf, 3},    {2, 2, 2},           {1e-320, 1, 1e20},
        {7},         {1, 0.1, 0.0999},
    };
    for (const auto& q : cases)
        for (const auto& h : heuristics) {
            double sum = 0;
            for (std::size_t i = 0; i < q.size(); ++i) {
                double w = mis_weight(h, std::span<const double>(q), i);
                ASSERT_TRUE(w >= 0 && w <= 1) << w;
                if (q[i] == 0) {
                    ASSERT_EQ(w, 0);
                }
                sum += w;
            }
            ASSERT_NEAR(sum, 1, 1e-14);
        }
    const std::vector<double> none{0, 0};
    EXPECT_EQ(mis_weight(MisHeuristic::balance(), std::span<const double>(none), 0), 0);
}

TEST(MisWeight, DefinitionsOfTheHeuristics) {
    const std::vector<double> q{1, 4, 3};
    auto w = [&](MisHeuristic h, std::size_t i) { return mis_weight(h, std::span<const double>(q), i); };
    EXPECT_DOUBLE_EQ(w(MisHeuristic::balance(), 1), 0.5);
    EXPECT_DOUBLE_EQ(w(MisHeuristic::power(2), 1), 16 / 26.0);
    EXPECT_DOUBLE_EQ(w(MisHeuristic::power(3), 2), 27 / 92.0);
    EXPECT_DOUBLE_EQ(w(MisHeuristic::cutoff(0.5), 0), 0);
    EXPECT_DOUBLE_EQ(w(MisHeuristic::cutoff(0.5), 1), 4 / 7.0);
    EXPECT_DOUBLE_EQ(w(MisHeuristic::cutoff(0.2), 0), 1 / 8.0);
    EXPECT_DOUBLE_EQ(w(MisHeuristic::maximum(), 1), 1);
    EXPECT_DOUBLE_EQ(w(MisHeuristic::maximum(), 2), 0);
}

TEST(MisWeight, TwoStrategyFormsAgreeWithTheGeneralOne) {
    for (auto [nf, pf, ng, pg] :
         {std::tuple(1, 2.0, 1, 3.0), std::tuple(4, 0.1, 2, 7.0), std::tuple(1, 0.0, 1, 1.0),
          std::tuple(3, 1e-200, 1, 1e-210), std::tuple(1, inf, 5, 2.0)}) {
        const double q[] = {nf * pf, ng * pg};
        EXPECT_NEAR(balance_heuristic(nf, pf, ng, pg),
                    mis_weight(MisHeuristic::balance(), std::span<const double>(q), 0), 1e-15);
        EXPECT_NEAR(power_heuristic(nf, pf, ng, pg),
                    mis_weight(MisHeuristic::power(2), std::span<const double>(q), 0), 1e-15);
    }
}

TEST(MisWeight, JointDensitiesGiveTheWeightsOfThreeStrategies) {
    for (const double f : {0.0, 1e-200, 0.3, 7.0})
        for (const double g : {0.0, 0.2, 1e150})
            for (const double h : {0.0, 0.5, 40.0}) {
                const std::array<double, 3> q{f, g, h};
                EXPECT_NEAR(power_heuristic(1, f, 1, power_joint_pdf(g, h)),
                            mis_weight<double>(MisHeuristic::power(), q, 0), 1e-14);
                EXPECT_NEAR(balance_heuristic(1, f, 1, balance_joint_pdf(g, h)),
                            mis_weight<double>(MisHeuristic::balance(), q, 0), 1e-14);
            }
    const float infinite = std::numeric_limits<float>::infinity();
    EXPECT_EQ(power_joint_pdf(infinite, 0.0f), infinite);
    EXPECT_LT(power_joint_pdf(1e30f, 1e30f), infinite); // the square overflows
}

TEST(MisWeight, TwoStrategyFormsSurviveExtremes) {
    EXPECT_EQ(balance_heuristic(1, 0.0f, 1, 0.0f), 0);
    EXPECT_EQ(power_heuristic(1, 0.0f, 1, 5.0f), 0);
    EXPECT_EQ(power_heuristic(1, 1e30f, 1, 0.0f), 1);
    EXPECT_NEAR(power_heuristic(1, 1e30f, 1, 1e30f), 0.5f, 1e-7f); // the square overflows a float
    EXPECT_NEAR(power_heuristic(1, 1e-30f, 1, 1e-30f), 0.5f, 1e-7f);
    float infinite = std::numeric_limits<float>::infinity();
    EXPECT_EQ(power_heuristic(1, infinite, 1, 3.0f), 1);
    EXPECT_EQ(balance_heuristic(1, 3.0f, 1, infinite), 0);
    EXPECT_EQ(balance_heuristic(3, infinite, 1, infinite), 0.75f);
    static_assert(balance_heuristic(1, 1.0f, 3, 1.0f) == 0.25f);
}

} // namespace
} // namespace montelux
