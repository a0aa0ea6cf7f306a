#include "test/mc/integrate/bench_integrand.h"
#include "test/mc/integrate/trained/trained_problems.h"
#include "test/significance.h"
#include <gtest/gtest.h>
#include <string>

#include "montelux/mc/integrate/trained/samples.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/stats/chi_squared.h"
#include "montelux/mc/stats/z_test.h"

namespace montelux {
namespace {

constexpr int columns = 16, rows = 8;

int cell_of(const PointBatch& x, std::size_t i) {
    const int a = static_cast<int>((x(i, 0) + 1) / 4 * columns), b = static_cast<int>(x(i, 1) / 2 * rows);
    return a * rows + b;
}
std::vector<double> expected_in_cells(double total) {
    std::vector<double> expected;
    for (int a = 0; a < columns; ++a)
        for (int b = 0; b < rows; ++b)
            expected.push_back(CutBells::integral(-1 + 4. * a / columns, -1 + 4. * (a + 1) / columns,
                                                  2. * b / rows, 2. * (b + 1) / rows));
    double sum = 0;
    for (double cell : expected) sum += cell;
    for (double& cell : expected) cell *= total / sum;
    return expected;
}

TEST(Samples, UnweightedFollowTheTarget) {
    const TrainedDensity untrained(std::make_shared<const UnitDensity>(MixtureDensity(2)),
                                   CutBells::domain());
    for (const TrainedDensity& density : {cut_bells(), cut_bells(Vegas{}), untrained}) {
        UnweightingOptions options;
        options.overweight_share = 0;
        const UnweightedSamples s = unweighted_samples(density, CutBells::value, 50000, options);
        ASSERT_EQ(s.count(), 50000u);
        std::vector<double> counts(columns * rows);
        for (std::size_t i = 0; i < s.count(); ++i)
            counts[static_cast<std::size_t>(cell_of(s.x, i))] += s.weight[i];
        double total = 0;
        for (double c : counts) total += c;
        EXPECT_NEAR(total, 50000, 50); // hardly any weighs more than 1
        const TestResult result = chi_squared_test(counts, expected_in_cells(total));
        EXPECT_TRUE(result.passes(significance)) << result.description;
        EXPECT_NEAR(s.efficiency.value, 50000. / static_cast<double>(s.draws), 1e-4);
        EXPECT_TRUE(s.warnings.empty());
    }
}

// Of a maximum far too low the weights, not the points alone, follow the target.
TEST(Samples, OverweightSamplesKeepTheirWeights) {
    UnweightingOptions options;
    options.overweight_share = 0.2;
    const UnweightedSamples s = unweighted_samples(cut_bells(), CutBells::value, 100'000, options);
    const std::vector<double> expected = expected_in_cells(1);
    std::vector<double> sums(expected.size()), squares(expected.size());
    double all = 0, over = 0;
    for (std::size_t i = 0; i < s.count(); ++i) {
        const auto cell = static_cast<std::size_t>(cell_of(s.x, i));
        sums[cell] += s.weight[i];
        squares[cell] += s.weight[i] * s.weight[i];
        all += s.weight[i];
        if (s.weight[i] > 1) over += s.weight[i] - 1;
    }
    EXPECT_GT(s.overweight, 10'000u);
    EXPECT_NEAR(s.overweight_share, over / all, 1e-12);
    EXPECT_NEAR(s.overweight_share, 0.2, 0.02);
    ASSERT_EQ(s.warnings.size(), 1u);
    EXPECT_NE(s.warnings[0].find("samples weigh up to"), std::string::npos);
    for (std::size_t k = 0; k < expected.size(); ++k)
        if (expected[k] > 0.01) {
            EXPECT_LT(std::abs(sums[k] / all - expected[k]), 5 * std::sqrt(squares[k]) / all) << "cell " << k;
        }
}

// A Gaussian around a corner, which draws most of its points outside: few samples show the bias of ending
// with the last one that was asked for.
TEST(Samples, IntegralOfFewSamplesIsUnbiased) {
    MixtureDensity at_corner(2, {}, {Gaussian({0, 0}, {0.4, 0, 0, 0.4})});
    at_corner.set_shares({16, 48});
    const TrainedDensity density(std::make_shared<const UnitDensity>(at_corner), Domain::unit_cube(2));
    auto f = [](std::span<const double> x) { return 1.5 - x[0]; };
    for (bool unweighted : {false, true}) {
        RunningMoments values;
        for (std::uint64_t seed = 0; seed < 6000; ++seed) {
            UnweightingOptions options;
            options.seed = seed;
            options.threads = 1;
            options.pilot = 64;
            values.add(unweighted ? unweighted_samples(density, f, 64, options).integral.value
                                  : weighted_samples(density, f, 3, options).integral.value);
        }
        const TestResult bias = unbiasedness_test(values, 1);
        EXPECT_TRUE(bias.passes(significance)) << unweighted << ": " << bias.description;
    }
}

TEST(Samples, IntegralIsUnbiasedAndCalibrated) {
    const TrainedDensity density = cut_bells();
    const double truth = CutBells::integral(-1, 3, 0, 2);
    for (bool unweighted : {false, true}) {
        RunningMoments values;
        std::vector<double> z;
        for (std::uint64_t seed = 0; seed < 400; ++seed) {
            UnweightingOptions options;
            options.seed = seed;
            options.threads = 1;
            options.pilot = 256;
            const Estimate found = unweighted
                                       ? unweighted_samples(density, CutBells::value, 600, options).integral
                                       : weighted_samples(density, CutBells::value, 600, options).integral;
            values.add(found.value);
            z.push_back(found.z_score(truth));
        }
        const TestResult bias = unbiasedness_test(values, truth);
        EXPECT_TRUE(bias.passes(significance)) << unweighted << ": " << bias.description;
        const TestResult calibration = calibration_test(z);
        EXPECT_TRUE(calibration.passes(significance)) << unweighted << ": " << calibration.description;
    }
}

TEST(Samples, WeightsAddUpToTheIntegral) {
    const Samples s = weighted_samples(cut_bells(), CutBells::value, 20000);
    double sum = 0, mean = 0;
    for (std::size_t i = 0; i < s.count(); ++i) {
        sum += s.weight[i];
        mean += s.weight[i] * s.x.view()(i, 0);
    }
    EXPECT_NEAR(sum, s.integral.value, 1e-12);
    EXPECT_NEAR(sum, CutBells::integral(-1, 3, 0, 2), 5 * s.integral.standard_error);
    EXPECT_GT(s.effective_sample_size(), 10000);
    EXPECT_LE(s.effective_sample_size(), 20000);
    EXPECT_GE(s.draws, 20000u);
}

// Events of a next-to-leading order weigh 1 or -1.
TEST(Samples, SignsBecomeSignsOfWeights) {
    auto f = [](std::span<const double> x) { return CutBells::value(x) * (x[1] < 0.2 ? -1 : 1); };
    const TrainedDensity density = trained(f, CutBells::domain(), Adaptive{}, 40000);
    UnweightingOptions options;
    options.overweight_share = 0;
    const UnweightedSamples s = unweighted_samples(density, f, 20000, options);
    double sum = 0, sizes = 0;
    for (std::size_t i = 0; i < s.count(); ++i) {
        EXPECT_EQ(s.weight[i] < 0, s.x.view()(i, 1) < 0.2);
        sum += s.weight[i];
        sizes += std::abs(s.weight[i]);
    }
    const double low = CutBells::integral(-1, 3, 0, 0.2), high = CutBells::integral(-1, 3, 0.2, 2);
    EXPECT_NEAR(sum / sizes, (high - low) / (high + low), 5 / std::sqrt(20000.));
    EXPECT_NEAR(s.integral.value, high - low, 5 * s.integral.standard_error);
}

TEST(Samples, LogarithmsGiveTheSameSamples) {
    auto log_f = [](std::span<const double> x) { return std::log(CutBells::value(x)) - 5000; };
    const TrainedDensity density = cut_bells();
    UnweightingOptions logarithm;
    logarithm.form = IntegrandForm::logarithm;
    const UnweightedSamples a = unweighted_samples(density, CutBells::value, 2000);
    const UnweightedSamples b = unweighted_samples(density, log_f, 2000, logarithm);
    EXPECT_NEAR(std::log(b.integral.value) + b.log_reference, std::log(a.integral.value) - 5000, 1e-9);
    EXPECT_EQ(a.draws, b.draws);
    for (std::size_t i = 0; i < a.count(); ++i) EXPECT_EQ(a.x.view()(i, 0), b.x.view()(i, 0));
    EXPECT_NEAR(b.f(7), log_f(std::vector<double>{b.x.view()(7, 0), b.x.view()(7, 1)}), 1e-9);
    const Samples w = weighted_samples(density, log_f, 2000, logarithm);
    EXPECT_NEAR(std::log(w.integral.value) + w.log_reference,
                -5000 + std::log(CutBells::integral(-1, 3, 0, 2)), 5 * w.integral.relative_error());
}

// Whose squares overflow, or underflow.
TEST(Samples, DoNotDependOnTheUnitOfTheTarget) {
    const TrainedDensity density = cut_bells();
    const Samples one = weighted_samples(density, CutBells::value, 1000);
    for (double scale : {0x1p900, 0x1p-900}) {
        auto f = [scale](std::span<const double> x) { return scale * CutBells::value(x); };
        const Samples s = weighted_samples(density, f, 1000);
        for (std::size_t i = 0; i < s.count(); ++i) EXPECT_EQ(s.weight[i] / scale, one.weight[i]);
        EXPECT_EQ(s.integral.standard_error / scale, one.integral.standard_error);
        EXPECT_EQ(unweighted_samples(density, f, 100).draws,
                  unweighted_samples(density, CutBells::value, 100).draws);
    }
}

TEST(Samples, ThreadsChangeNoBit) {
    const TrainedDensity density = cut_bells();
    UnweightingOptions options;
    options.threads = 1;
    const UnweightedSamples one = unweighted_samples(density, CutBells::value, 9000, options);
    options.threads = 3;
    const UnweightedSamples three = unweighted_samples(density, CutBells::value, 9000, options);
    EXPECT_EQ(one.weight, three.weight);
    EXPECT_EQ(one.draws, three.draws);
    EXPECT_EQ(one.integral.value, three.integral.value);
    for (std::size_t i = 0; i < one.count(); ++i) EXPECT_EQ(one.x.view()(i, 0), three.x.view()(i, 0));
    // The first samples are the same, however many are drawn.
    const UnweightedSamples few = unweighted_samples(density, CutBells::value, 10);
    for (std::size_t i = 0; i < few.count(); ++i) EXPECT_EQ(few.x.view()(i, 0), one.x.view()(i, 0));
}

TEST(Samples, LimitsAndMistakes) {
    const TrainedDensity density = cut_bells();
    UnweightingOptions options;
    options.max_draws = 1000;
    const UnweightedSamples s = unweighted_samples(density, CutBells::value, 5000, options);
    EXPECT_EQ(s.draws, 1000u);
    EXPECT_TRUE(s.cancelled);
    EXPECT_NEAR(s.efficiency.value, static_cast<double>(s.count()) / 1000, 1e-12);
    EXPECT_NE(s.warnings.at(0).find("of 5000 samples were found in 1000 draws"), std::string::npos);
    EXPECT_THROW(weighted_samples(density, CutBells::value, 0), Error);
    EXPECT_THROW(unweighted_samples(
                     density, [](std::span<const double>) { return 0.0; }, 10),
                 Error);
    EXPECT_THROW(weighted_samples(
                     density, [](double x) { return x; }, 10),
                 Error);
    const Samples bad = weighted_samples(
        density, [](std::span<const double> x) { return x[0] > 0 ? std::nan("") : 1.0; }, 1000);
    EXPECT_GT(bad.non_finite.count, 0u);
    EXPECT_NE(bad.warnings.back().find("were not finite"), std::string::npos);
    CancelFlag cancel;
    cancel.request();
    SamplingOptions cancelled;
    cancelled.cancel = &cancel;
    EXPECT_TRUE(weighted_samples(density, CutBells::value, 10, cancelled).cancelled);
}

TEST(Samples, PeaksOffTheAxesAreUnweightedFarBetterThanByTheMapsOfVegas) {
    for (bench::Line line :
         {bench::Line{Family::two_peaks, 4}, {Family::three_peaks, 4}, {Family::ridge, 4}}) {
        const BenchIntegrand peaks(line, 1);
        const Integrand f = as_integrand(peaks);
        UnweightingOptions options;
        options.pilot = 8192;
        const auto efficiency = [&](const Method& method) {
            return unweighted_samples(trained(f, domain_of(peaks), method, 100'000), f, 500, options)
                .efficiency;
        };
        const Estimate mixture = efficiency(Adaptive{}), map = efficiency(Vegas{});
        EXPECT_GT(mixture.value, 2 * map.value) << bench::line_name(line);
        RecordProperty(bench::line_name(line),
                       std::to_string(mixture.value) + " vs " + std::to_string(map.value));
    }
}

// What lies in memory between two calls of `take` does not grow with the number of variables.
TEST(Samples, BlocksOfManyVariablesAreFewer) {
    for (int n : {2, 500}) {
        const TrainedDensity density(std::make_shared<const UnitDensity>(MixtureDensity(n)),
                                     Domain::unit_cube(n));
        const SamplingOptions options;
        const Target target(
            density, [](std::span<const double>) { return 1.0; }, options);
        std::uint64_t most = 0, before = 0;
        draw_blocks(
            target, Target::Stream::samples, options,
            [&](std::uint64_t done) {
                most = std::max(most, done - before);
                before = done;
                return std::uint64_t{1} << 40;
            },
            [&](TargetDraws&, std::uint64_t first, std::uint64_t) { return first < Target::block * 9; });
        if (n == 500) {
            EXPECT_EQ(most, Target::block * 8); // 2^24 numbers over 504 a draw
        } else {
            EXPECT_EQ(most, 0u); // all within the first round
        }
    }
}

} // namespace
} // namespace montelux
