#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "montelux/mc/integrate/infinity.h"
#include "montelux/mc/integrate/integrate.h"
#include "montelux/mc/integrate/witness/ridge.h"

namespace montelux {
namespace {

const Domain plane{{-infinity, infinity}, {-infinity, infinity}};

struct Ridge {
    std::string name;
    bool diverges;
    double (*f)(std::span<const double> x);
};
double ridge_of(double across, double along) { return std::exp(-across * across) * along; }
const std::vector<Ridge> ridges{
    {"constant", true, [](std::span<const double> x) { return ridge_of(x[0] - x[1], 1); }},
    {"beside the diagonal", true, [](std::span<const double> x) { return ridge_of(x[0] - x[1] - 1, 1); }},
    {"other diagonal", true, [](std::span<const double> x) { return ridge_of(x[0] + x[1], 1); }},
    {"1 / x", true,
     [](std::span<const double> x) { return ridge_of(x[0] - x[1], 1 / (1 + std::abs(x[0]))); }},
    {"heavy sides", true, [](std::span<const double> x) { return 1 / (1 + std::pow(x[0] - x[1], 2)); }},
    {"x^-1.2", false,
     [](std::span<const double> x) { return ridge_of(x[0] - x[1], std::pow(1 + std::abs(x[0]), -1.2)); }},
    {"x^-2", false, [](std::span<const double> x) { return ridge_of(x[0] - x[1], 1 / (1 + x[0] * x[0])); }},
    {"thinner and thinner", false,
     [](std::span<const double> x) { return ridge_of((x[0] - x[1]) * (1 + x[0] * x[0]), 1); }},
    {"long", false, [](std::span<const double> x) {
         return ridge_of(x[0] - x[1], std::exp(-1e-6 * (x[0] + x[1]) * (x[0] + x[1])));
     }}};
const std::vector<Ridge> ends_far_out{
    {"1e6 long", false,
     [](std::span<const double> x) { return ridge_of(x[1], std::exp(-1e-12 * x[0] * x[0])); }},
    {"1e8 long", false,
     [](std::span<const double> x) { return ridge_of(x[1], std::exp(-1e-16 * x[0] * x[0])); }},
    {"1 / x along x", true,
     [](std::span<const double> x) { return ridge_of(x[1], 1 / (1 + std::abs(x[0]))); }}};

TEST(Ridge, MassesThatDoNotFall) {
    for (const Ridge& ridge : ridges) {
        const Evaluator evaluator(Integrand(ridge.f), plane);
        RawValues raw(evaluator);
        const double far = std::exp2(-24), other = ridge.name == "other diagonal" ? 1 - far : far;
        EXPECT_EQ(ridge_diverges(raw, {far, other}, [](const auto& row) { return row[0]; }), ridge.diverges)
            << ridge.name;
        EXPECT_LT(raw.evaluations(), 700u) << ridge.name;
    }
}

// Along a variable, distances count that points of the cube do not reach.
TEST(Ridge, OneThatEndsFarOutDoesNotDiverge) {
    for (const Ridge& ridge : ends_far_out) {
        const Evaluator evaluator(Integrand(ridge.f), plane);
        RawValues raw(evaluator);
        EXPECT_EQ(ridge_diverges(raw, {std::exp2(-18), 0.5}, [](const auto& row) { return row[0]; }),
                  ridge.diverges)
            << ridge.name;
    }
}

TEST(Ridge, OnlyFarOutOfInfiniteRanges) {
    const Domain half{{0, infinity}, {0, 1}};
    EXPECT_TRUE(is_far_out(half, std::vector{1 - 1e-6, 0.5}));
    EXPECT_FALSE(is_far_out(half, std::vector{1e-6, 0.5}));
    EXPECT_FALSE(is_far_out(half, std::vector{0.5, 1 - 1e-6}));
    EXPECT_FALSE(is_far_out(Domain::unit_cube(2), std::vector{1e-6, 0.5}));
}

TEST(Ridge, DivergenceIsToldAndConvergenceIsNotDenied) {
    for (const Ridge& ridge : ridges) {
        const IntegrationResult r =
            integrate(Integrand(ridge.f), plane, Method(), {.relative_error = 1e-2, .evaluations = 100'000},
                      {.threads = 1});
        EXPECT_EQ(r.stop == StopReason::diverges, ridge.diverges) << ridge.name << ": " << to_string(r);
        EXPECT_FALSE(ridge.diverges && r.converged()) << ridge.name;
    }
}

// Ridges along curves, whose guide is zero on them.
TEST(Ridge, OfAGuideIsFollowedToInfinity) {
    struct Curve {
        std::string name;
        bool diverges;
        double (*guide)(std::span<const double> x);
        double (*along)(double x);
    };
    const auto rooted = [](std::span<const double> x) { return x[1] - std::sqrt(x[0]); };
    const auto line = [](std::span<const double> x) { return x[0] - 2 * x[1]; };
    const auto square = [](std::span<const double> x) { return x[1] - x[0] * x[0]; };
    const std::vector<Curve> curves{
        {"root, 1/x", true, rooted, [](double x) { return 1 / (1 + x); }},
        {"root, x^-1.2", false, rooted, [](double x) { return std::pow(1 + x, -1.2); }},
        {"root, long", false, rooted, [](double x) { return std::exp(-1e-5 * x); }},
        {"line, constant", true, line, [](double) { return 1.0; }},
        {"line, long", false, line, [](double x) { return std::exp(-1e-5 * x); }},
        {"square, 1/x", true, square, [](double x) { return 1 / (1 + x); }},
        {"square, x^-1.5", false, square, [](double x) { return std::pow(1 + x, -1.5); }},
    };
    const Domain quadrant{{0, infinity}, {0, infinity}};
    const Magnitude magnitude = [](const std::vector<double>& row) { return row[0]; };
    for (const Curve& curve : curves) {
        const Integrand guide(curve.guide);
        const Integrand f([curve](std::span<const double> x) {
            return std::exp(-std::pow(curve.guide(x), 2)) * curve.along(x[0]);
        });
        const Evaluator evaluator(f, quadrant);
        RawValues raw(evaluator);
        const RidgeToEnd ridge = follow_ridge(
            raw, [&](const PointBatch& x, ValueBatch y) { guide(x, y); }, {0.5, 0.5}, 0, 1, magnitude, 0,
            1000);
        EXPECT_GE(ridge.tops.size(), 3u) << curve.name;
        EXPECT_EQ(ridge.diverges, curve.diverges) << curve.name;
        EXPECT_LT(raw.evaluations(), 1600u) << curve.name;
    }
}

// The ridge of a curve that doubles resolve up to y = 15 of infinity: beyond, masses fall like 1 / y^2.
TEST(Ridge, WhatLiesBeyondDoublesIsEstimated) {
    const Integrand guide([](std::span<const double> x) { return x[0] - std::exp(x[1]); });
    const Integrand f([](std::span<const double> x) {
        return 1 / (1 + std::pow(x[0] - std::exp(x[1]), 2)) / (1 + x[1] * x[1]);
    });
    const Evaluator evaluator(f, plane);
    RawValues raw(evaluator);
    const RidgeToEnd ridge = follow_ridge(
        raw, [&](const PointBatch& x, ValueBatch y) { guide(x, y); }, {0.75, 0.6}, 0, 1,
        [](const std::vector<double>& row) { return row[0]; }, 0, 3000);
    ASSERT_GT(ridge.tops.size(), 6u);
    const Witness& last = ridge.tops.back();
    // The volume stands for an octave of x at the height of its top: half of the width pi of the ridge.
    const double y = -std::log2(1 - last.u[0]) * std::numbers::ln2;
    EXPECT_GT(y, 13);
    const double tail = std::numbers::pi * (std::numbers::pi / 2 - std::atan(y));
    EXPECT_GT(ridge.beyond * last.value[0] * last.volume, 0.2 * tail);
    EXPECT_LT(ridge.beyond * last.value[0] * last.volume, 2 * tail);
}

// The integrand vanishes on the curve, and is largest beside it.
TEST(Ridge, ALineInAValleyIsNoRidge) {
    const auto curve = [](std::span<const double> x) { return x[1] - x[0] * x[0]; };
    const Integrand guide(curve);
    const Integrand f([curve](std::span<const double> x) {
        const double square = std::pow(curve(x), 2);
        return square * std::exp(-square) / (1 + x[0] * x[0]);
    });
    const Evaluator evaluator(f, Domain({{0, infinity}, {0, infinity}}));
    RawValues raw(evaluator);
    const RidgeToEnd ridge = follow_ridge(
        raw, [&](const PointBatch& x, ValueBatch y) { guide(x, y); }, {0.5, 0.5}, 0, 1,
        [](const std::vector<double>& row) { return row[0]; }, 0, 1000);
    EXPECT_TRUE(ridge.tops.empty());
    EXPECT_FALSE(ridge.diverges);
}

} // namespace
} // namespace montelux
