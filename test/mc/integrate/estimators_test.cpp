// A2, A3, A4, A6, A7, A9: basic, general, importance-sampled, quasi-random and multiply sampled estimates
// are unbiased, and say honestly how far off they are.
#include <cmath>
#include <gtest/gtest.h>
#include <vector>

#include "montelux/mc/integrate/basic.h"
#include "montelux/mc/integrate/importance.h"
#include "montelux/mc/integrate/multiple_importance.h"
#include "montelux/mc/integrate/quasi.h"
#include "montelux/mc/stats/z_test.h"

namespace montelux {
namespace {

constexpr double significance = 1e-6;

// Over many seeds: the mean is the truth, and the truth lies within 1, 2, 3 standard errors as often as the
// normal law says.
template <typename Run>
void expect_unbiased_and_calibrated(double truth, const Run& run, int seeds = 2000) {
    RunningMoments values;
    std::vector<double> z;
    for (int seed = 0; seed < seeds; ++seed) {
        Estimate e = run(static_cast<std::uint64_t>(seed));
        ASSERT_EQ(e.non_finite, 0u);
        values.add(e.value);
        z.push_back(e.z_score(truth));
    }
    auto bias = unbiasedness_test(values, truth);
    EXPECT_TRUE(bias.passes(significance)) << bias.description;
    auto calibration = calibration_test(z);
    EXPECT_TRUE(calibration.passes(significance)) << calibration.description;
}

const auto sine = [](double x) { return std::sin(x); };

TEST(BasicMonteCarlo, UnbiasedAndCalibrated) {
    // Enough seeds that a standard error 7% off is seen.
    expect_unbiased_and_calibrated(
        1,
        [](std::uint64_t seed) {
            return basic_monte_carlo(sine, 0, pi / 2, {.samples = 1000, .seed = seed});
        },
        8000);
}

TEST(BasicMonteCarlo, FourTimesTheSamplesHalveTheError) {
    // The true error, from the spread over seeds: slope -1/2 over a factor of 256 in N.
    RunningMoments few, many;
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
        few.add(basic_monte_carlo(sine, 0, pi / 2, {.samples = 64, .seed = seed}).value);
        many.add(basic_monte_carlo(sine, 0, pi / 2, {.samples = 64 * 256, .seed = seed}).value);
    }
    double slope = std::log(many.standard_deviation() / few.standard_deviation()) / std::log(256.0);
    // Each logarithm of a deviation is off by 1 / sqrt(2 * 400); five of those of the difference.
    EXPECT_NEAR(slope, -0.5, 5 * std::sqrt(2.0 / 800) / std::log(256.0));
}

TEST(BasicMonteCarlo, BoxInThreeDimensions) {
    auto f = [](const std::array<double, 3>& x) { return x[0] * x[1] * x[1] * std::exp(x[2]); };
    double truth = (2 * 2 - 1) / 2.0 * 9 * (std::exp(1) - std::exp(-1));
    Estimate e = basic_monte_carlo<3>(f, {1, 0, -1}, {2, 3, 1}, {.samples = 200000, .seed = 3});
    auto r = unbiasedness_test(e, truth);
    EXPECT_TRUE(r.passes(significance)) << r.description;
    EXPECT_LT(e.relative_error(), 0.01);
    EXPECT_EQ(e.evaluations, 200000u);
}

TEST(BasicMonteCarlo, SameBitsForAnyNumberOfThreads) {
    auto run = [] { return basic_monte_carlo(sine, 0, 1, {.samples = 100000, .seed = 8}); };
    Estimate first = run();
    ThreadLimit one(1);
    Estimate second = run();
    EXPECT_EQ(first.value, second.value);
    EXPECT_EQ(first.standard_error, second.standard_error);
    EXPECT_NE(first.value, basic_monte_carlo(sine, 0, 1, {.samples = 100000, .seed = 9}).value);
}

TEST(BasicMonteCarlo, NonFiniteSamplesAreLeftOutCountedAndLocated) {
    auto f = [](double x) { return x < 0.25 ? NAN : 1.0; };
    Estimate e = basic_monte_carlo(f, 0, 1, {.samples = 40000, .seed = 1});
    EXPECT_NEAR(e.value, 0.75, 0.02);
    EXPECT_NEAR(static_cast<double>(e.non_finite), 10000, 500);
    ASSERT_NE(e.first_non_finite, Estimate::no_index);
    EXPECT_LT(sample_uniforms<1>(1, 0, e.first_non_finite)[0], 0.25); // replayed alone
    for (std::uint64_t i = 0; i < e.first_non_finite; ++i) EXPECT_GE(sample_uniforms<1>(1, 0, i)[0], 0.25);
    EXPECT_THROW(basic_monte_carlo(sine, 0, 1, {.samples = 0}), Error);
    EXPECT_THROW(basic_monte_carlo(sine, 0, INFINITY), Error);
}

TEST(ImportanceSampling, AnyDensityGivesTheSameIntegral) {
    auto check = [](const auto& density) {
        expect_unbiased_and_calibrated(
            1,
            [&](std::uint64_t seed) {
                return importance_sampling(sine, density, {.samples = 1000, .seed = seed});
            },
            1000);
    };
    check(UniformDistribution(0, pi / 2));
    check(LinearDistribution(0, pi / 2));
    // Wider than the support of the integrand, which is cut off at pi/2.
    auto cut = [](double x) { return x < pi / 2 ? std::sin(x) : 0; };
    expect_unbiased_and_calibrated(
        1,
        [&](std::uint64_t seed) {
            return importance_sampling(cut, ExponentialDistribution(0.5), {.samples = 4000, .seed = seed});
        },
        1000);
}

TEST(ImportanceSampling, ProductAndFunctionTechniques) {
    // Integral of cos x * 2y^2 over [0, pi/2) x [0, 1) = 2/3 by p = cos x * 2y.
    auto f = [](const std::array<double, 2>& x) { return std::cos(x[0]) * 2 * x[1] * x[1]; };
    ProductDistribution density{CosineDistribution(), LinearDistribution()};
    Estimate e = importance_sampling(f, density, {.samples = 50000, .seed = 2});
    EXPECT_TRUE(unbiasedness_test(e, 2 / 3.0).passes(significance)) << e;
    auto technique = make_technique<1>([](const std::array<double, 1>& xi) { return xi[0] * xi[0]; },
                                       [](double x) { return 0.5 / std::sqrt(x); });
    Estimate r = importance_sampling([](double x) { return std::cos(x) / std::sqrt(x); }, technique,
                                     {.samples = 50000});
    EXPECT_TRUE(unbiasedness_test(r, 1.8090484758005442).passes(significance)) << r;
}

TEST(ImportanceSampling, PerfectDensityHasNoVariance) {
    Estimate e = importance_sampling([](double x) { return 3 * std::cos(x); }, CosineDistribution(),
                                     {.samples = 1000});
    EXPECT_NEAR(e.value, 3, 1e-13);
    EXPECT_NEAR(e.standard_error, 0, 1e-14);
}

TEST(ImportanceSampling, DensityThatMissesTheIntegrandIsFoundByProbes) {
    EXPECT_FALSE(find_uncovered(sine, LinearDistribution(0, pi / 2), 0, pi / 2));
    auto x = find_uncovered(sine, LinearDistribution(0, 1), 0, pi / 2);
    ASSERT_TRUE(x);
    EXPECT_NEAR(*x, 1, 1e-3);
    // A sampler that contradicts its density is counted.
    auto wrong = make_technique<1>([](const std::array<double, 1>& xi) { return xi[0]; },
                                   [](double v) { return v < 0.5 ? 2.0 : 0.0; });
    EXPECT_GT(importance_sampling([](double) { return 1.0; }, wrong, {.samples = 1000}).non_finite, 400u);
}

// A4: the race of p0 = 2/pi against p1 = 8x/pi^2 on the integral of sin x, with the same xi.
TEST(ImportanceSampling, TheRaceHasTheVariancesOfTheClosedForm) {
    double v0 = pi * pi / 8 - 1;
    double v1 = pi * pi / 16 * (euler_gamma + std::log(pi) - cosine_integral(pi)) - 1;
    EXPECT_NEAR(v0, 0.23370, 5e-6);
    EXPECT_NEAR(v1, 0.01674, 5e-6);
    EXPECT_NEAR(v0 / v1, 13.96, 5e-3);

    UniformDistribution p0(0, pi / 2);
    LinearDistribution p1(0, pi / 2);
    RunningMoments f0, f1, fourth0, fourth1;
    for (std::uint64_t i = 0; i < 400000; ++i) {
        auto xi = sample_uniforms<1>(4, 0, i);
        double y0 = importance_weighted(sine, as_technique(p0), xi),
               y1 = importance_weighted(sine, as_technique(p1), xi);
        f0.add(y0);
        f1.add(y1);
        fourth0.add((y0 - 1) * (y0 - 1)); // squared deviations from the known mean: their error is known too
        fourth1.add((y1 - 1) * (y1 - 1));
    }
    auto r0 = unbiasedness_test(fourth0, v0), r1 = unbiasedness_test(fourth1, v1);
    EXPECT_TRUE(r0.passes(significance)) << r0.description;
    EXPECT_TRUE(r1.passes(significance)) << r1.description;
    double relative = std::hypot(fourth0.standard_error() / v0, fourth1.standard_error() / v1);
    EXPECT_NEAR(f0.variance() / f1.variance(), 13.96, 5 * 13.96 * relative + 0.005);
    // The estimator draws these very numbers.
    Estimate e = importance_sampling(sine, p1, {.samples = 400000, .seed = 4});
    EXPECT_NEAR(e.value, f1.mean(), 1e-12);
}

// A7: three techniques with different counts, none of which covers the integrand well alone.
TEST(MultipleImportanceSampling, UnbiasedAndCalibratedForEveryHeuristic) {
    auto f = [](double x) { return 1 / std::sqrt(x) + (x > 0.9 ? 40 * (x - 0.9) : 0); };
    double truth = 2 + 20 * 0.01;
    auto root = make_technique<1>([](const std::array<double, 1>& xi) { return xi[0] * xi[0]; },
                                  [](double x) { return 0.5 / std::sqrt(x); });
    LinearDistribution linear;
    UniformDistribution end(0.9, 1); // zero over most of the domain
    for (auto h : {MisHeuristic::balance(), MisHeuristic::power(2), MisHeuristic::power(0.7),
                   MisHeuristic::cutoff(0.3), MisHeuristic::maximum()})
        expect_unbiased_and_calibrated(
            truth,
            [&](std::uint64_t seed) {
                return multiple_importance_sampling(f, h, seed, WeightedTechnique{root, 700},
                                                    WeightedTechnique{linear, 200},
                                                    WeightedTechnique{end, 400});
            },
            1000);
}

TEST(MultipleImportanceSampling, OneTechniqueIsImportanceSampling) {
    LinearDistribution p(0, pi / 2);
    Estimate one = multiple_importance_sampling(sine, MisHeuristic::balance(), 5, WeightedTechnique{p, 1000});
    Estimate plain = importance_sampling(sine, p, {.samples = 1000, .seed = 5});
    EXPECT_NEAR(one.value, plain.value, 1e-14);
    EXPECT_NEAR(one.standard_error, plain.standard_error, 1e-14);
    EXPECT_THROW(multiple_importance_sampling(sine, MisHeuristic::balance(), 5, WeightedTechnique{p, 0}),
                 Error);
}

// A6: error from replicates. A Kronecker sequence of the golden ratio, shifted at random.
TEST(RandomisedQuasiMonteCarlo, UnbiasedCalibratedAndBetterThanRandom) {
    auto run = [](std::uint64_t seed) {
        return randomised_quasi_monte_carlo(
            sine, UniformDistribution(0, pi / 2),
            [seed](std::uint64_t i, std::uint32_t replicate) {
                std::array<double, 1> point{std::fmod(static_cast<double>(i) * (std::numbers::phi - 1), 1.0)};
                return random_shift(point, seed, replicate);
            },
            {.points = 256, .replicates = 8});
    };
    RunningMoments values;
    std::vector<double> z;
    for (std::uint64_t seed = 0; seed < 1500; ++seed) {
        Estimate e = run(seed);
        values.add(e.value);
        // Student's law with seven degrees of freedom, brought to the normal one.
        z.push_back(normal_quantile(student_t_cdf(e.z_score(1), 7)));
    }
    auto bias = unbiasedness_test(values, 1);
    EXPECT_TRUE(bias.passes(significance)) << bias.description;
    // The law of one replicate's error is not quite normal; a wrong error would still show at once.
    auto calibration = calibration_test(z);
    EXPECT_TRUE(calibration.passes(significance)) << calibration.description;
    double random_deviation = std::sqrt((pi * pi / 8 - 1) / (256 * 8));
    EXPECT_LT(values.standard_deviation(), 0.2 * random_deviation);
}

} // namespace
} // namespace montelux
