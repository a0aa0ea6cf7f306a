#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <numeric>
#include <vector>

#include "montelux/mc/integrate/cubature/cubature_rules.h"
#include "montelux/mc/integrate/cubature/symmetric_rule.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

std::vector<SymmetricRule> rules() {
    std::vector<SymmetricRule> all{coarse_rule_of_one_dimension(), fine_rule_of_one_dimension(),
                                   two_dimensional_rule(), three_dimensional_rule()};
    for (int n : {2, 3, 4, 5, 8}) all.push_back(genz_malik_7(n));
    for (int n : {3, 4, 5, 8}) all.push_back(genz_malik_9(n));
    return all;
}

// All exponents of n variables with a sum up to `degree`, in at most four different variables: the rules
// know no others.
void for_each_monomial(int n, int degree, const std::function<void(const std::vector<int>&)>& visit) {
    std::vector<int> powers(static_cast<std::size_t>(n), 0);
    auto recurse = [&](auto& self, std::size_t d, int left, int used) -> void {
        if (d == powers.size()) return visit(powers);
        for (int p = 0; p <= (used == 4 ? 0 : left); ++p) {
            powers[d] = p;
            self(self, d + 1, left - p, used + (p > 0));
        }
        powers[d] = 0;
    };
    recurse(recurse, 0, degree, 0);
}

std::vector<double> monomial_at(const SymmetricRule& rule, const std::vector<int>& powers) {
    std::vector<double> values(rule.points(), 1.0);
    const PointBatch x = rule.offsets().view();
    for (int d = 0; d < rule.dimensions(); ++d)
        for (std::size_t i = 0; i < values.size(); ++i)
            for (int p = 0; p < powers[static_cast<std::size_t>(d)]; ++p) values[i] *= x(i, d);
    return values;
}

TEST(SymmetricRule, IntegratesEachMonomialUpToItsDegree) {
    for (const SymmetricRule& rule : rules()) {
        std::vector<double> nulls(static_cast<std::size_t>(rule.null_rules()));
        double worst = 0;
        for_each_monomial(rule.dimensions(), std::min(rule.degree(), rule.dimensions() > 4 ? 7 : 23),
                          [&](const std::vector<int>& powers) {
                              double exact = 1;
                              for (int p : powers) exact *= p % 2 == 0 ? 1.0 / (p + 1) : 0;
                              const double mean = rule.apply(monomial_at(rule, powers), nulls);
                              worst = std::max(worst, std::abs(mean - exact));
                          });
        EXPECT_LT(worst, 1e-13) << rule.dimensions() << " dimensions, degree " << rule.degree();
    }
}

TEST(SymmetricRule, DegreeNineIsExactInManyDimensions) {
    const SymmetricRule rule = genz_malik_9(8);
    std::vector<double> nulls(static_cast<std::size_t>(rule.null_rules()));
    for (std::vector<int> powers :
         {std::vector<int>{8}, {6, 2}, {4, 4}, {4, 2, 2}, {2, 2, 2, 2}, {5, 3, 1}}) {
        double exact = 1;
        for (int p : powers) exact *= p % 2 == 0 ? 1.0 / (p + 1) : 0;
        powers.resize(8, 0);
        std::rotate(powers.begin(), powers.begin() + 5, powers.end());
        EXPECT_NEAR(rule.apply(monomial_at(rule, powers), nulls), exact, 1e-13);
    }
}

TEST(SymmetricRule, NullRulesAnnihilateUpToTheirDegreeAndNotBeyond) {
    for (const SymmetricRule& rule : rules()) {
        if (rule.dimensions() > 5) continue;
        std::vector<double> nulls(static_cast<std::size_t>(rule.null_rules())), largest(nulls.size(), 0.0);
        ASSERT_GE(nulls.size(), rule.dimensions() == 1 ? 3u : 4u);
        for_each_monomial(rule.dimensions(), std::min(rule.degree() + 1, rule.dimensions() > 3 ? 8 : 23),
                          [&](const std::vector<int>& powers) {
                              const int degree = std::accumulate(powers.begin(), powers.end(), 0);
                              rule.apply(monomial_at(rule, powers), nulls);
                              for (std::size_t k = 0; k < nulls.size(); ++k) {
                                  if (degree <= rule.null_degree(static_cast<int>(k)))
                                      EXPECT_NEAR(nulls[k], 0, 1e-13);
                                  else
                                      largest[k] = std::max(largest[k], std::abs(nulls[k]));
                              }
                          });
        for (double l : largest) EXPECT_GT(l, 1e-6);
    }
}

TEST(SymmetricRule, NullRulesFallWithTheSizeOfTheBoxAndCallItSmooth) {
    const SymmetricRule rule = genz_malik_9(4);
    std::vector<double> nulls(static_cast<std::size_t>(rule.null_rules())), values(rule.points());
    const PointBatch x = rule.offsets().view();
    double last = 1e300;
    for (double size : {1.0, 0.5, 0.25}) {
        for (std::size_t i = 0; i < values.size(); ++i)
            values[i] = std::exp(size * (x(i, 0) + 0.7 * x(i, 1) - 0.3 * x(i, 2) * x(i, 3)));
        rule.apply(values, nulls);
        const SymmetricRule::Assessment found = rule.assess(nulls);
        EXPECT_LT(found.ratio, 1);
        EXPECT_LT(found.error, last / 64);
        last = found.error;
    }
    // A jump is as rough at any size.
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = x(i, 0) + 0.1 * x(i, 1) > 0.3 ? 1 : 0;
    rule.apply(values, nulls);
    EXPECT_GT(rule.assess(nulls).error, 0.01);
}

TEST(SymmetricRule, RoundingIsNotRoughness) {
    const SymmetricRule rule = coarse_rule_of_one_dimension();
    // Null rules of degrees 7, 5 and 3, the first two of nothing but rounding.
    const std::vector<double> nulls{-7e-17, -6e-17, 0.6};
    EXPECT_GT(rule.assess(nulls).ratio, 1);
    EXPECT_LT(rule.assess(nulls, 1e-15).ratio, 1e-15);
    EXPECT_LT(rule.assess(nulls, 1e-15).error, 1e-15);
    EXPECT_EQ(rule.assess({{0.7, 0.6, 0.6}}, 1e-15).error, 0.7);
}

TEST(SymmetricRule, ProbesSeeAJumpAtAFace) {
    const SymmetricRule rule = genz_malik_7(3);
    std::vector<double> values(rule.points());
    const PointBatch x = rule.offsets().view();
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = x(i, 1) > 0.97 ? 1 : 0;
    EXPECT_NEAR(rule.edge_surprise(values), (1 - std::sqrt(0.9)) / 2, 1e-12);
    std::vector<double> nulls(static_cast<std::size_t>(rule.null_rules()));
    rule.apply(values, nulls);
    EXPECT_EQ(rule.assess(nulls).error, 0); // what the probes are for
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::pow(x(i, 1), 4) + x(i, 0);
    EXPECT_LT(rule.edge_surprise(values), 1e-13);
}

TEST(SymmetricRule, RoughnessFindsTheAxis) {
    for (const SymmetricRule& rule : {genz_malik_7(3), three_dimensional_rule(), genz_malik_9(3)}) {
        std::vector<double> values(rule.points()), sums(3, 0.0);
        const PointBatch x = rule.offsets().view();
        for (std::size_t i = 0; i < values.size(); ++i)
            values[i] = std::pow(x(i, 0), 3) + std::pow(x(i, 1), 4) + 0.1 * std::pow(x(i, 2), 4);
        rule.add_roughness(values, 1, sums);
        EXPECT_NEAR(sums[0], 0, 1e-13);
        EXPECT_NEAR(sums[2] / sums[1], 0.1, 1e-10);
        EXPECT_GT(sums[1], 1e-4);
    }
}

TEST(SymmetricRule, GeneratorsThatCannotReachTheDegreeAreRefused) {
    EXPECT_THROW(SymmetricRule(2, 7, {{}, {0.5}, {0.9}}), Error);
}

// Jumps at -0.7 and 0.8, between the same two points of a rule on either side.
TEST(SymmetricRule, OddPartTellsOfJumps) {
    const SymmetricRule rule = fine_rule_of_one_dimension();
    auto values = [&](auto f) {
        std::vector<double> all;
        for (double x : rule.offsets().view().coordinate(0)) all.push_back(f(x));
        return all;
    };
    std::vector<double> nulls(static_cast<std::size_t>(rule.null_rules()));
    const auto jumps = values([](double x) { return x + (x < -0.7) - (x > 0.8); }); // of mean 0.05
    EXPECT_NEAR(rule.apply(jumps, nulls), 0, 1e-14);
    EXPECT_LT(rule.assess(nulls).error, 1e-14);
    EXPECT_GT(rule.odd_surprise(jumps), 0.05);
    EXPECT_LT(rule.odd_surprise(values([](double x) { return std::sin(2 * x); })), 1e-11);
    EXPECT_LT(rule.odd_surprise(values([](double x) { return 1 / (2 + x); })), 1e-7);
    EXPECT_EQ(rule.odd_surprise(values([](double x) { return x * x; })), 0);
    EXPECT_EQ(two_dimensional_rule().odd_surprise(std::vector<double>(two_dimensional_rule().points(), 1.0)),
              0);
}

} // namespace
} // namespace montelux
