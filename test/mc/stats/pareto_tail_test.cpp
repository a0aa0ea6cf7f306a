#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <vector>

#include "montelux/mc/stats/pareto_tail.h"

namespace montelux {
namespace {

// Quantile of the generalised Pareto law of scale 1.
double pareto(double u, double shape) {
    return shape == 0 ? -std::log1p(-u) : std::expm1(-shape * std::log1p(-u)) / shape;
}

std::vector<double> pareto_sample(std::size_t n, double shape, std::uint64_t seed) {
    std::mt19937_64 engine(seed);
    std::vector<double> x(n);
    for (double& v : x) v = pareto(static_cast<double>(engine() >> 11) * 0x1p-53, shape);
    return x;
}

TEST(ParetoTail, FitsSamplesOfKnownShape) {
    for (double shape : {-0.4, 0.0, 0.3, 0.5, 0.8, 1.5}) {
        std::vector<double> x = pareto_sample(4000, shape, 3);
        std::sort(x.begin(), x.end());
        const auto fit = fit_pareto(x);
        ASSERT_TRUE(fit);
        EXPECT_EQ(fit->points, 4000);
        EXPECT_LT(std::abs(fit->shape - shape), 5 * fit->shape_error() + 0.005) << shape;
        EXPECT_NEAR(fit->scale, 1, 0.15) << shape;
    }
}

TEST(ParetoTail, FitDoesNotDependOnTheUnit) {
    std::vector<double> x = pareto_sample(500, 0.7, 5);
    std::sort(x.begin(), x.end());
    const ParetoFit one = fit_pareto(x).value();
    for (double unit : {1e-290, 1e290}) {
        std::vector<double> scaled = x;
        for (double& v : scaled) v *= unit;
        const ParetoFit other = fit_pareto(scaled).value();
        EXPECT_NEAR(other.shape, one.shape, 1e-9);
        EXPECT_NEAR(other.scale / unit, one.scale, 1e-9 * one.scale);
    }
}

// The errors of the shape are as large as they are said to be.
TEST(ParetoTail, ShapeErrorsAreCalibrated) {
    for (double shape : {0.2, 0.7}) {
        double squares = 0;
        const int samples = 200;
        for (int s = 0; s < samples; ++s) {
            std::vector<double> x = pareto_sample(300, shape, 100 + static_cast<std::uint64_t>(s));
            std::sort(x.begin(), x.end());
            const ParetoFit fit = fit_pareto(x).value();
            squares += std::pow((fit.shape - shape) / fit.shape_error(), 2);
        }
        EXPECT_GT(squares / samples, 0.6);
        EXPECT_LT(squares / samples, 1.5);
    }
}

TEST(ParetoTail, ShapeOfTheLargestWeights) {
    // x^-a has the shape a; weights that are bounded have a negative one.
    std::mt19937_64 engine(7);
    for (double a : {0.25, 0.6, 0.9}) {
        ParetoTail tail;
        constexpr int n = 100'000;
        for (int i = 0; i < n; ++i)
            tail.add(std::pow((static_cast<double>(engine() >> 11) + 0.5) * 0x1p-53, -a));
        const ParetoFit fit = tail.fit(n).value();
        EXPECT_EQ(fit.points, 948);
        EXPECT_LT(std::abs(fit.shape - a), 5 * fit.shape_error()) << a;
    }
    ParetoTail bounded;
    for (int i = 0; i < 10'000; ++i) bounded.add(static_cast<double>(engine() >> 11) * 0x1p-53);
    EXPECT_LT(bounded.fit(10'000).value().shape, -0.5);
}

// The tail has 3 sqrt(n) of n values, at most a fifth; a fit for another n is not reused.
TEST(ParetoTail, TailIsThatOfTheNumberOfValuesAskedFor) {
    ParetoTail tail;
    tail.add(pareto_sample(10'000, 0.4, 13));
    EXPECT_EQ(tail.fit(10'000).value().points, 300);
    EXPECT_EQ(tail.fit(2'500).value().points, 150);
    EXPECT_EQ(tail.fit(100).value().points, 20);
    EXPECT_FALSE(tail.fit(10));
    EXPECT_EQ(tail.fit(10'000).value().points, 300);
    // More values need a new fit.
    const double threshold = tail.fit(10'000).value().threshold;
    tail.add(1e6);
    EXPECT_GT(tail.fit(10'000).value().threshold, threshold);
}

TEST(ParetoTail, KeepsTheLargestInAnyGrouping) {
    const std::vector<double> x = pareto_sample(5000, 0.5, 11);
    std::vector<double> largest = x;
    std::sort(largest.begin(), largest.end(), std::greater<>());
    largest.resize(100);
    ParetoTail whole(100);
    whole.add(x);
    EXPECT_EQ(whole.values(), largest);
    for (std::size_t part : {1u, 7u, 99u, 100u, 201u, 2500u}) {
        ParetoTail merged(100);
        for (std::size_t i = 0; i < x.size(); i += part) {
            ParetoTail one = merged.empty();
            one.add(std::span(x).subspan(i, std::min(part, x.size() - i)));
            merged.merge(one);
        }
        EXPECT_EQ(merged.values(), largest) << part;
    }
    ParetoTail restored(100);
    restored.restore(whole.values());
    restored.add(whole.values().front() * 2);
    whole.add(whole.values().front() * 2);
    EXPECT_EQ(restored.values(), whole.values());
    EXPECT_EQ(restored.fit(5001)->shape, whole.fit(5001)->shape);
}

TEST(ParetoTail, NoLawWhereThereIsNoTail) {
    ParetoTail none, few, equal;
    for (int i = 0; i < 15; ++i) few.add(1 + i);
    for (int i = 0; i < 5000; ++i) equal.add(3);
    EXPECT_FALSE(none.fit(0));
    EXPECT_FALSE(none.fit(1000));
    EXPECT_FALSE(few.fit(15));
    EXPECT_FALSE(equal.fit(5000));
    EXPECT_FALSE(fit_pareto({}));
}

} // namespace
} // namespace montelux
