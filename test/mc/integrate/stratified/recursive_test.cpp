// A5: recursive stratified sampling.
#include "test/mc/integrate/estimator_checks.h"
#include <atomic>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "montelux/mc/integrate/basic_monte_carlo.h"
#include "montelux/mc/integrate/stratified/bisection.h"
#include "montelux/mc/integrate/stratified/recursive.h"

namespace montelux {
namespace {

constexpr double narrow = 100;
// A normal density in the middle of a part of the cube, nearly all of it inside.
KnownIntegral peak(int dimensions) {
    return {[](std::span<const double> x) {
                double square = 0;
                for (double v : x) square += (v - 0.3) * (v - 0.3);
                return std::exp(-narrow * square);
            },
            Domain::unit_cube(dimensions),
            {std::pow(0.5 * std::sqrt(std::numbers::pi / narrow) *
                          (std::erf(0.7 * std::sqrt(narrow)) + std::erf(0.3 * std::sqrt(narrow))),
                      dimensions)}};
}
KnownIntegral jump() {
    return {[](std::span<const double> x) { return x[0] < 0.37 && x[1] < 0.61 ? 5.0 : 1.0; },
            Domain::unit_cube(2),
            {1 + 4 * 0.37 * 0.61}};
}

TEST(Bisection, BoxesFillTheCubeAndSamplesAddUp) {
    const KnownIntegral f = peak(3);
    const Evaluator evaluator(f.f, f.domain);
    const auto boxes = bisect({evaluator, 1}, 100000, 0.1, 5, nullptr);
    ASSERT_TRUE(boxes);
    const Strata strata = boxes->strata();
    EXPECT_GT(strata.count, 100u);
    EXPECT_EQ(boxes->pilot + boxes->offsets.back(), 100000u);
    EXPECT_LT(boxes->pilot, 20000u);
    std::vector<double> lower(3), width(3);
    double volume = 0, centroid = 0;
    std::uint64_t near = 0;
    for (std::uint64_t k = 0; k < strata.count; ++k) {
        strata.box(k, lower, width);
        const double v = width[0] * width[1] * width[2];
        volume += v;
        centroid += v * (lower[1] + 0.5 * width[1]);
        EXPECT_GE(boxes->offsets[k + 1], boxes->offsets[k] + 2);
        double off = 0;
        for (std::size_t d = 0; d < 3; ++d)
            off = std::max(off, std::abs(std::clamp(0.3, lower[d], lower[d] + width[d]) - 0.3));
        if (off < 0.15) near += boxes->offsets[k + 1] - boxes->offsets[k];
    }
    EXPECT_NEAR(volume, 1, 1e-12);
    EXPECT_NEAR(centroid, 0.5, 1e-12);
    // Half of the samples go to a cube of 3 % of the volume.
    EXPECT_GT(static_cast<double>(near), 0.5 * static_cast<double>(boxes->offsets.back()));
}

TEST(Recursive, UnbiasedAndCalibrated) {
    expect_unbiased_and_calibrated(two_components(), Recursive{}, {.evaluations = 3000}, 1000);
    expect_unbiased_and_calibrated(peak(2), Recursive{}, {.evaluations = 10000}, 400);
    expect_unbiased_and_calibrated(jump(), Recursive{}, {.evaluations = 10000}, 400);
}

TEST(Recursive, FarBetterThanBasicOnPeaksAndJumps) {
    auto gain = [](const KnownIntegral& f, std::uint64_t evaluations) {
        auto error = [&](const Method& m) {
            double square = 0;
            for (std::uint64_t seed = 0; seed < 10; ++seed) {
                const IntegrationResult r =
                    integrate(f.f, f.domain, m, {.evaluations = evaluations}, {.seed = seed});
                EXPECT_EQ(r.evaluations, evaluations);
                square += std::pow(r.value[0] - f.truth[0], 2);
            }
            return std::sqrt(square);
        };
        return error(BasicMonteCarlo{}) / error(Recursive{});
    };
    EXPECT_GT(gain(peak(3), 100000), 5);
    EXPECT_GT(gain(jump(), 100000), 5);
}

TEST(Recursive, TargetsAreMet) {
    const KnownIntegral f = peak(3);
    const IntegrationResult r = integrate(f.f, f.domain, Recursive{}, {.relative_error = 2e-3});
    EXPECT_EQ(r.stop, StopReason::error_target);
    EXPECT_NEAR(r.value[0] / f.truth[0], 1, 8e-3);
    EXPECT_GT(r.degrees_of_freedom, 0);
}

TEST(Recursive, KeepsPromises) {
    expect_keeps_promises(Recursive{}, 20000);
    expect_same_bits_after_resume(two_components(), Recursive{.pilot = 0.3}, 20000);
}

// The count includes the pilot and the samples of the boxes.
TEST(Recursive, EveryValueThatIsNotFiniteIsCounted) {
    std::atomic<std::uint64_t> met = 0;
    const auto f = [&](std::span<const double> x) {
        const bool bad = x[0] + x[1] < 0.3;
        met += bad;
        return bad ? std::nan("") : x[0];
    };
    const IntegrationResult r = integrate(f, Domain::unit_cube(2), Recursive{}, {.evaluations = 10000});
    EXPECT_GT(r.non_finite, 100u);
    EXPECT_EQ(r.non_finite, met.load());
}

TEST(Recursive, BudgetsThatAreTooSmallAndMistakes) {
    const KnownIntegral f = peak(2);
    EXPECT_THROW(integrate(f.f, f.domain, Recursive{}, {.evaluations = 1}), Error);
    EXPECT_EQ(integrate(f.f, f.domain, Recursive{}, {.evaluations = 50}).evaluations, 50u);
    EXPECT_EQ(integrate(f.f, Domain::unit_cube(500), Recursive{}, {.evaluations = 30000}).evaluations,
              30000u);
    EXPECT_THROW(integrate(f.f, f.domain, Recursive{.pilot = 0}), Error);
    EXPECT_THROW(integrate(f.f, f.domain, Recursive{.pilot = 0.9}), Error);
}

} // namespace
} // namespace montelux
