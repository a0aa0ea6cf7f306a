// No rule is believed on its own word: what random points find, and what is claimed where all values are
// equal.
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <string>
#include <utility>

#include "montelux/mc/integrate/auto.h"
#include "montelux/mc/integrate/cubature/cubature.h"
#include "montelux/mc/integrate/cubature/cubature_check.h"
#include "montelux/mc/integrate/infinity.h"
#include "montelux/mc/integrate/integrate.h"
#include "montelux/mc/random/hash.h"

namespace montelux {
namespace {

double uniform(std::uint64_t seed, std::uint64_t index) {
    return static_cast<double>(hash_key(seed, index) >> 11) * 0x1p-53;
}

struct Hidden {
    const char* name;
    Integrand f;
    Domain domain;
    double exact;
};

int claims_far_off(const Hidden& h, const Method& method, double target, int seeds) {
    int far_off = 0;
    for (int seed = 0; seed < seeds; ++seed) {
        const IntegrationResult r =
            integrate(h.f, h.domain, method, {.relative_error = target, .evaluations = 2'000'000},
                      {.seed = static_cast<std::uint64_t>(seed)});
        far_off += r.converged() && std::abs(r.value[0] - h.exact) > 4 * r.standard_error[0];
    }
    return far_off;
}

// Integrals of which the first regions see a part that looks smooth.
std::vector<Hidden> hidden() {
    constexpr double pi = std::numbers::pi;
    return {
        {"eggbox", Integrand([](std::span<const double> x) {
             return std::exp(std::pow(2 + std::cos(x[0] / 2) * std::cos(x[1] / 2), 5));
         }),
         Domain({{0, 10 * pi}, {0, 10 * pi}}), 2.6624297e105},
        {"rosenbrock", Integrand([](std::span<const double> x) {
             return std::exp(-std::pow(1 - x[0], 2) - 100 * std::pow(x[1] - x[0] * x[0], 2));
         }),
         Domain({{-5, 5}, {-5, 5}}), 0.3015070},
        {"ring", Integrand([](std::span<const double> x) {
             return std::exp(-std::pow((std::hypot(x[0], x[1]) - 0.7) / 0.005, 2) / 2);
         }),
         Domain({{-1.3, 1.3}, {-1.3, 1.3}}), 2 * pi * 0.7 * 0.005 * std::sqrt(2 * pi)},
    };
}

// The range [1, 3] of the second component, widened by half of it, four claimed errors of a region of half of the
// cube's volume, and a quarter of the tolerance: by 1 + 4 * 0.25 / 0.5 + 0.1.
TEST(CubatureVerification, ValuesFarBelowTheRangeSurpriseLikeThoseFarAbove) {
    CubatureRegions regions(1, 2);
    regions.add_cube();
    regions.half_width(0)[0] = 0.25;
    regions.lowest(0)[1] = 1;
    regions.highest(0)[1] = 3;
    regions.error(0)[1] = 0.25;
    constexpr double allowed = 3.1, tolerance = 0.4;
    for (double beyond : {0.5, 100.0}) {
        EXPECT_NEAR(surprise(regions, 0, 1, 3 + allowed + beyond, tolerance), beyond, 1e-12);
        EXPECT_NEAR(surprise(regions, 0, 1, 1 - allowed - beyond, tolerance), beyond, 1e-12);
    }
    for (double value : {-2.0, 1.0, 2.0, 3.0, 6.0})
        EXPECT_EQ(surprise(regions, 0, 1, value, tolerance), 0) << value;
}

// Parts of a long ridge between the points of one check: without more points for them, 5 of 6 claims were 3 to 16 errors
// low.
TEST(CubatureVerification, ThinRidgesCallForMorePoints) {
    const Hidden tilted{"tilted", Integrand([](std::span<const double> x) {
                            return std::exp(-std::pow(x[0] + x[1] - 3, 2) -
                                            std::pow(x[0] - x[1] + 1, 2) / 400);
                        }),
                        Domain({{-infinity, infinity}, {-infinity, infinity}}), 10 * std::numbers::pi};
    EXPECT_LE(claims_far_off(tilted, Cubature(), 1e-3, 12), 1);
}

// A dip at the end of a range, closer than the outermost points of a rule: its values lie within those that the rule saw.
TEST(CubatureVerification, DipsAtAnEndAreSeen) {
    for (const auto& [slow, fast] :
         {std::pair(0.005862, 4.947), std::pair(1e-3, 1.0), std::pair(0.02, 30.0)}) {
        const double scale = slow * fast / (fast - slow), end = 1.2e5;
        const Hidden decay{"daughter", Integrand([=](double t) {
                               return scale * (std::exp(-slow * t) - std::exp(-fast * t));
                           }),
                           Domain::interval(0, end), scale * (1 / slow - 1 / fast)};
        for (double target : {1e-2, 1e-4})
            EXPECT_EQ(claims_far_off(decay, Cubature(), target, 3), 0) << slow << " at " << target;
    }
}

// The first check, of equal values, leaves a large error, which stood above the target for ever.
TEST(CubatureVerification, ErrorsOfEarlierChecksEndWithAnother) {
    for (double power : {2.0, 3.0})
        for (std::uint64_t seed = 0; seed < 5; ++seed) {
            const IntegrationResult r = integrate(
                [=](double x) { return 0.5 + 10 * std::exp(-1e5 * std::pow(std::pow(x, power) - 0.35, 2)); },
                Domain::interval(0, 1), Cubature(), {.relative_error = 1e-3, .evaluations = 100'000},
                {.seed = seed});
            EXPECT_TRUE(r.converged()) << r;
            EXPECT_LT(r.evaluations, 10'000u);
        }
}

// Equal narrow peaks, of which rules see one: points on the other flanks have values far below the tolerance.
TEST(CubatureVerification, HintsLeadToOtherPeaks) {
    const std::vector<Hidden> peaks{
        {"two", Integrand([](double x) { return std::exp(-1e4 * std::pow(x * x - 2, 2)); }),
         Domain::interval(-3, 7), 0.0125331538},
        {"six", Integrand([](double x) { return std::exp(-1e6 * std::pow(std::sin(3 * x) - 0.2, 2)); }),
         Domain::interval(0, 2 * std::numbers::pi), 0.00361801},
        {"seven", Integrand([](double x) { return std::exp(1e5 * (std::cos(7 * x - 1) - 1)); }),
         Domain::interval(0, 2 * std::numbers::pi), 0.00792666}};
    for (const Hidden& h : peaks) EXPECT_EQ(claims_far_off(h, Cubature(), 1e-3, 20), 0) << h.name;
}

TEST(CubatureVerification, PartsOfAnIntegralAreNotTakenForIt) {
    for (const Hidden& h : hidden())
        for (const Method& method : {Method(Auto{})})
            for (double target : {1e-2, 1e-3})
                for (std::uint64_t seed : {0, 1}) {
                    const IntegrationResult r =
                        integrate(h.f, h.domain, method,
                                  {.relative_error = target, .absolute_error = 0, .evaluations = 400'000},
                                  {.seed = seed, .threads = 1});
                    if (!r.converged()) continue;
                    EXPECT_LE(std::abs(r.value[0] - h.exact), 6 * r.standard_error[0] + 1e-5 * h.exact)
                        << h.name << " " << target << " seed " << seed << "\n"
                        << r;
                }
}

// A spike of half of the integral on a plateau; without a check its regions are as smooth as can be.
TEST(CubatureVerification, FindsSpikesOnPlateaus) {
    constexpr double width = 0.004;
    int missed = 0;
    for (std::uint64_t seed = 0; seed < 30; ++seed) {
        const double cx = 0.1 + 0.8 * uniform(seed, 0), cy = 0.1 + 0.8 * uniform(seed, 1);
        const double height = 1 / (2 * std::numbers::pi * width * width);
        const Integrand f([=](std::span<const double> x) {
            return 1 + height *
                           std::exp(-(std::pow(x[0] - cx, 2) + std::pow(x[1] - cy, 2)) / (2 * width * width));
        });
        const IntegrationResult r = integrate(f, Domain::unit_cube(2), Cubature{}, {.relative_error = 1e-3},
                                              {.seed = seed, .threads = 1});
        if (r.converged() && std::abs(r.value[0] - 2) > 4 * r.standard_error[0]) {
            ++missed;
            ADD_FAILURE() << r;
        }
        if (seed > 0) continue;
        Cubature believed;
        believed.check_points = 0;
        EXPECT_NEAR(integrate(f, Domain::unit_cube(2), believed, {.relative_error = 1e-3}).value[0], 1, 1e-3);
    }
    // exp(-16384 * 0.8 pi (4.5 width)^2) is 2e-6; the seeds are fixed.
    EXPECT_EQ(missed, 0);
}

// Points of the last check before the target is claimed.
std::uint64_t points_of_check(const Integrand& f, int dimensions, double target,
                              std::uint64_t points_of_others) {
    const Evaluator evaluator(f, Domain::unit_cube(dimensions));
    const auto estimator = Cubature{.check_points = points_of_others}.estimator({evaluator, 1});
    std::uint64_t before = 0, points = 0;
    for (StepOutcome outcome{};
         outcome != StepOutcome::finished && estimator->tally().evaluations < 100'000;) {
        outcome = estimator->step({.max_evaluations = 3'000'000, .relative_error = target});
        const std::uint64_t checked = estimator->tally().check_evaluations;
        if (checked > before) points = checked - before;
        before = checked;
    }
    return points;
}

// A jump shows nothing of another that lies between the points of all rules.
TEST(CubatureVerification, JumpsAskForMorePoints) {
    const Integrand disk(
        [](std::span<const double> x) { return x[0] * x[0] + x[1] * x[1] < 0.7 ? 1.0 : 0.5; });
    EXPECT_EQ(points_of_check(disk, 2, 2e-2, 300), 300u);
    EXPECT_EQ(points_of_check(disk, 2, 4e-3, 300), 500u);
    EXPECT_EQ(points_of_check(disk, 2, 4e-3, 80), 400u); // at most five times as many
    // Smooth integrands do not.
    const Integrand smooth([](std::span<const double> x) { return std::exp(3 * x[0] * x[1]); });
    EXPECT_EQ(points_of_check(smooth, 2, 1e-3, 1000), 1000u);
}

// Around a singular point of two scales halving along one axis at a time moves the value by a small part of its error
// only, and null rules see even less.
TEST(CubatureVerification, ErrorsGrowWhereTheValueDriftsFromCheckToCheck) {
    const Integrand f([](std::span<const double> x) { return std::pow(x[0] + x[1] * x[1] * x[1], -0.9); });
    // 10 (1 + y^3)^0.1 - 10 y^0.3 after the first integration, by midpoints.
    double exact = -10 / 1.3;
    for (int i = 0; i < 10'000; ++i) exact += 1e-3 * std::pow(1 + std::pow((i + 0.5) / 10'000, 3), 0.1);
    for (double target : {1e-3, 1e-4, 1e-5})
        for (std::uint64_t seed = 1; seed <= 4; ++seed) {
            const IntegrationResult r = integrate(f, Domain::unit_cube(2), Cubature{},
                                                  {.relative_error = target}, {.seed = seed, .threads = 1});
            EXPECT_LT(std::abs(r.value[0] - exact), 4 * r.standard_error[0]) << r;
        }
}

// Pulses on a flat background: where three were found there may be more, which few random points meet.
TEST(CubatureVerification, SeparateFeaturesCallForMorePoints) {
    struct Train {
        double period, width, end;
    };
    int missed = 0;
    for (const Train& train : {Train{0.05, 0.0025, 1}, Train{0.02, 0.001, 1}, Train{7, 0.5, 364}})
        for (double target : {1e-2, 1e-3})
            for (std::uint64_t seed = 0; seed < 4; ++seed) {
                const Integrand f(
                    [=](double t) { return std::fmod(t, train.period) < train.width ? 1.0 : 0.0; });
                const double exact = train.width * std::round(train.end / train.period);
                for (const Method& method : {Method(Auto{}), Method(Cubature{})}) {
                    const IntegrationResult r =
                        integrate(f, Domain::interval(0, train.end), method, {.relative_error = target},
                                  {.seed = seed, .threads = 1});
                    missed += r.converged() && r.warnings.empty() &&
                              std::abs(r.value[0] - exact) > 4 * r.standard_error[0];
                }
            }
    // Nearly all of 48 without.
    EXPECT_LE(missed, 2);
    // One peak, found by the look, costs as little as before.
    const IntegrationResult peak =
        integrate([](double x) { return std::exp(-1e4 * x * x); }, Domain::interval(-1, 1), Cubature{},
                  {.relative_error = 1e-3}, {.seed = 1, .threads = 1});
    EXPECT_LT(peak.evaluations, 2000u);
}

TEST(CubatureVerification, EqualValuesHaveAnError) {
    // 1.2e-4 of the square is missing, which 65 points do not see.
    const Integrand f([](std::span<const double> x) { return x[0] * x[1] < 1.3e-5 ? 0.0 : 1.0; });
    const double exact = 1 - 1.3e-5 * (1 - std::log(1.3e-5));
    for (const Method& method : {Method(Auto{}), Method(Cubature{})})
        for (std::uint64_t seed = 0; seed < 8; ++seed) {
            const IntegrationResult r = integrate(f, Domain::unit_cube(2), method, {.relative_error = 1e-3},
                                                  {.seed = seed, .threads = 1});
            EXPECT_TRUE(r.converged()) << r;
            EXPECT_GT(r.standard_error[0], 1e-6);
            EXPECT_LE(std::abs(r.value[0] - exact), 4 * r.standard_error[0]) << r;
        }
    // A constant costs what its error takes, and no more than two million evaluations.
    const Integrand one([](std::span<const double>) { return 3.0; });
    const IntegrationResult rough = integrate(one, Domain::unit_cube(3), Method(), {.relative_error = 1e-4});
    EXPECT_TRUE(rough.converged());
    EXPECT_LT(rough.evaluations, 40'000U);
    const IntegrationResult fine = integrate(one, Domain::unit_cube(3), Method(), {.relative_error = 1e-9});
    EXPECT_FALSE(fine.converged());
    EXPECT_LT(fine.evaluations, 2'200'000U);
    EXPECT_EQ(fine.value[0], 3);
    EXPECT_FALSE(fine.warnings.empty());
}

TEST(CubatureVerification, TargetsBelowRoundingEndWithTheBestThereIs) {
    for (double target : {1e-16, 1e-20}) {
        const IntegrationResult r = integrate([](double x) { return std::sin(x); }, Domain::interval(0, 1),
                                              Method(), {.relative_error = target});
        EXPECT_EQ(r.stop, StopReason::finished);
        EXPECT_LT(r.evaluations, 1000U);
        EXPECT_NEAR(r.value[0], 1 - std::cos(1), 1e-15);
        ASSERT_EQ(r.warnings.size(), 1U);
        EXPECT_NE(r.warnings[0].find("rounding"), std::string::npos);
    }
}

TEST(CubatureVerification, VectorsHaveACovariance) {
    const Integrand f = Integrand::vector_valued(3, [](std::span<const double> x, std::span<double> y) {
        y[0] = std::exp(x[0] - x[1]);
        y[1] = 2 * y[0];
        y[2] = x[0] * x[0] * x[1];
    });
    const IntegrationResult r = integrate(f, Domain::unit_cube(2), Method(), {.relative_error = 1e-6});
    EXPECT_EQ(r.method, "cubature");
    ASSERT_EQ(r.covariance.size(), 9U);
    auto correlation = [&](std::size_t a, std::size_t b) {
        return r.covariance[3 * a + b] / (r.standard_error[a] * r.standard_error[b]);
    };
    for (std::size_t a = 0; a < 3; ++a) EXPECT_NEAR(correlation(a, a), 1, 1e-9);
    EXPECT_NEAR(correlation(0, 1), 1, 1e-9);
    EXPECT_LT(std::abs(correlation(0, 2)), 1);
    IntegrationOptions without;
    without.full_covariance = false;
    EXPECT_TRUE(
        integrate(f, Domain::unit_cube(2), Method(), {.relative_error = 1e-6}, without).covariance.empty());
}

// What lies in too small a part of the domain for random points is said, or compared with sampling.
TEST(CubatureVerification, ConcentratedIntegrandsAreComparedWithSampling) {
    const Integrand f([](std::span<const double> x) {
        double r = 0;
        for (double v : x) r += std::pow((v - 0.4) / 0.01, 2);
        return std::exp(-r / 2);
    });
    const double exact = std::pow(0.01 * std::sqrt(2 * std::numbers::pi), 3);
    const IntegrationResult rule =
        integrate(f, Domain::unit_cube(3), Cubature{}, {.relative_error = 1e-3}, {.threads = 1});
    EXPECT_FALSE(rule.warnings.empty());
    const IntegrationResult both =
        integrate(f, Domain::unit_cube(3), Auto{}, {.relative_error = 1e-3}, {.threads = 1});
    EXPECT_TRUE(both.converged()) << both;
    EXPECT_NEAR(both.value[0], exact, 4 * both.standard_error[0]);
}

// A run that ends before its check says so, whatever the rules claim.
TEST(CubatureVerification, RulesThatWereNotCheckedSaySo) {
    const Integrand f([](std::span<const double> x) { return std::exp(std::sin(9 * x[0]) + x[1]); });
    auto run = [&](std::uint64_t evaluations) {
        return integrate(f, Domain::unit_cube(2), Cubature{},
                         {.relative_error = 1e-12, .absolute_error = 0, .evaluations = evaluations});
    };
    const IntegrationResult ended = run(300);
    EXPECT_EQ(ended.stop, StopReason::evaluations);
    ASSERT_EQ(ended.warnings.size(), 1U);
    EXPECT_NE(ended.warnings[0].find("confirmed"), std::string::npos) << ended.warnings[0];
    const IntegrationResult whole = run(100'000);
    EXPECT_TRUE(whole.converged());
    EXPECT_TRUE(whole.warnings.empty());
}

} // namespace
} // namespace montelux
