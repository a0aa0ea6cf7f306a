#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "montelux/mc/integrate/chains/sample_chains.h"
#include "montelux/mc/integrate/chains/walker_ensemble.h"
#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/math/special.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/mc/parallel/physical_memory.h"
#include "montelux/mc/stats/chi_squared.h"
#include "montelux/mc/stats/z_test.h"

namespace montelux {
namespace {

using Point = std::span<const double>;

constexpr double no_bound = std::numeric_limits<double>::infinity();

// A density, and a map that makes its draws uniform on the unit square.
struct Target {
    const char* name;
    double (*log_density)(Point);
    void (*uniforms)(Point x, double u[2]);
    std::vector<Range> ranges;
};

// Normal with correlation 0.95 between neighbours and scales 1, 10, 100: the last given the one before does not depend
// on the first.
double correlated(Point x) {
    const double b = (x[1] / 10 - 0.95 * x[0]) / std::sqrt(1 - 0.95 * 0.95);
    const double c = (x[2] / 100 - 0.95 * x[1] / 10) / std::sqrt(1 - 0.95 * 0.95);
    return -0.5 * (x[0] * x[0] + b * b + c * c);
}
void correlated_uniforms(Point x, double u[2]) {
    u[0] = normal_cdf(x[0]);
    u[1] = normal_cdf((x[2] / 100 - 0.95 * x[1] / 10) / std::sqrt(1 - 0.95 * 0.95));
}
// Rosenbrock's banana: x normal, y normal about x^2 with deviation 1/4.
double banana(Point x) { return -0.5 * x[0] * x[0] - 8 * std::pow(x[1] - x[0] * x[0], 2); }
void banana_uniforms(Point x, double u[2]) {
    u[0] = normal_cdf(x[0]);
    u[1] = normal_cdf(4 * (x[1] - x[0] * x[0]));
}
// A shell of radius 2 and thickness 0.2 in three variables: the radius has density r^2 exp(-(r - 2)^2 / 0.08).
double shell(Point x) {
    const double r = std::sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
    return -(r - 2) * (r - 2) / 0.08;
}
void shell_uniforms(Point x, double u[2]) {
    // Integral of (2 + s t)^2 times the normal density, s = 0.2, up to z: (4 + s^2) F(z) - (4 s + s^2 z) f(z).
    constexpr double s = 0.2;
    const double r = std::sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]), z = (r - 2) / s;
    const double density = std::exp(-0.5 * z * z) / std::sqrt(2 * pi);
    u[0] = ((4 + s * s) * normal_cdf(z) - (4 * s + s * s * z) * density) / (4 + s * s);
    u[1] = 0.5 + 0.5 * x[2] / r;
}
// x exp(-3 y) on the part x + y < 1 of a box: bounded by the box, and by where the density is zero.
double bounded(Point x) { return x[0] > 0 && x[0] + x[1] < 1 ? std::log(x[0]) - 3 * x[1] : -no_bound; }
void bounded_uniforms(Point x, double u[2]) {
    // Given y, x^2 / (1 - y)^2 is uniform; y has density (1 - y)^2 exp(-3 y), whose integral from 0 is
    // (5 - exp(-3 y) (5 - 12 y + 9 y^2)) / 27.
    const double y = x[1];
    u[0] = x[0] * x[0] / (1 - y) / (1 - y);
    u[1] = (5 - std::exp(-3 * y) * (5 - 12 * y + 9 * y * y)) / (5 - 2 * std::exp(-3));
}

std::vector<Target> targets() {
    const Range line{-no_bound, no_bound};
    return {{"correlated", correlated, correlated_uniforms, {line, line, line}},
            {"banana", banana, banana_uniforms, {line, line}},
            {"shell", shell, shell_uniforms, {{-5, 5}, {-5, 5}, {-5, 5}}},
            {"bounded", bounded, bounded_uniforms, {{0, 2}, {0, no_bound}}}};
}

class EverySampler : public testing::TestWithParam<ChainSampler> {};
INSTANTIATE_TEST_SUITE_P(SampleChains, EverySampler,
                         testing::Values(ChainSampler::metropolis, ChainSampler::ensemble,
                                         ChainSampler::slice),
                         [](const auto& sampler) {
                             return std::string(chain_sampler_names[static_cast<std::size_t>(sampler.param)]);
                         });

TEST_P(EverySampler, DrawsFollowTheDensity) {
    constexpr int side = 8;
    const bool ensemble = GetParam() == ChainSampler::ensemble, slice = GetParam() == ChainSampler::slice;
    for (const Target& target : targets()) {
        ChainOptions options;
        options.sampler = GetParam();
        options.draws = ensemble ? 150 : slice ? 200 : 1000;
        options.thin = ensemble ? 150 : slice ? 30 : 150;
        options.seed = 7;
        const ChainDraws draws = sample_chains(target.log_density, target.ranges, options);
        std::vector<double> observed(side * side, 0.0);
        const std::size_t d = target.ranges.size();
        for (std::size_t i = 0; i < draws.states.size(); i += d) {
            double u[2];
            target.uniforms(Point(draws.states).subspan(i, d), u);
            const int a = std::min(side - 1, static_cast<int>(u[0] * side)),
                      b = std::min(side - 1, static_cast<int>(u[1] * side));
            ++observed[static_cast<std::size_t>(a * side + b)];
        }
        const double total = static_cast<double>(draws.states.size() / d);
        const TestResult r =
            chi_squared_test(observed, std::vector<double>(observed.size(), total / side / side));
        EXPECT_TRUE(r.passes(1e-6)) << target.name << ": " << r.description << " R-hat "
                                    << draws.variables[0].r_hat << " size "
                                    << draws.variables[0].bulk_effective_size << " of " << total;
    }
}

TEST_P(EverySampler, ErrorsOfMeansAreCalibrated) {
    std::vector<double> z;
    for (std::uint64_t seed = 0; seed < 150; ++seed) {
        ChainOptions options;
        options.sampler = GetParam();
        options.chains = 2;
        options.draws = GetParam() == ChainSampler::metropolis ? 1000 : 300;
        options.burn_in = 200;
        options.seed = seed;
        const ChainDraws draws = sample_chains(
            [](Point x) { return -0.5 * (x[0] * x[0] + x[1] * x[1] - 1.6 * x[0] * x[1]) / 0.36; },
            {{-no_bound, no_bound}, {-no_bound, no_bound}}, options);
        z.push_back(draws.variables[0].mean / draws.variables[0].standard_error);
    }
    const TestResult test = calibration_test(z);
    EXPECT_TRUE(test.passes(1e-4)) << test.description;
    int within_one = 0;
    for (double v : z) within_one += std::abs(v) < 1;
    EXPECT_GE(within_one, 85);
    EXPECT_LE(within_one, 121);
}

TEST_P(EverySampler, BitsDoNotDependOnThreads) {
    auto run = [&](int threads) {
        ChainOptions options;
        options.sampler = GetParam();
        options.draws = 60;
        options.burn_in = 50;
        return with_threads(threads, [&] { return sample_chains(banana, targets()[1].ranges, options); });
    };
    const ChainDraws one = run(1), five = run(5);
    EXPECT_EQ(one.states, five.states);
    EXPECT_EQ(one.variables[1].standard_error, five.variables[1].standard_error);
    EXPECT_EQ(one.evaluations, five.evaluations);
}

TEST_P(EverySampler, ChainsInSeparatePeaksSayThatTheyDisagree) {
    const auto two = [](Point x) {
        return std::log(std::exp(-0.5 * (x[0] - 20) * (x[0] - 20)) +
                        std::exp(-0.5 * (x[0] + 20) * (x[0] + 20)));
    };
    ChainOptions options;
    options.sampler = GetParam();
    options.starts = {{-20}, {20}, {-20}, {20}};
    options.names = {"mass"};
    const ChainDraws draws = sample_chains(two, Domain::interval(-40, 40), options);
    EXPECT_GT(draws.variables[0].r_hat, 1.5);
    EXPECT_GT(draws.variables[0].standard_error, 5);
    ASSERT_FALSE(draws.warnings.empty());
    EXPECT_NE(draws.warnings[0].find("the chains disagree: R-hat of 'mass'"), std::string::npos);
}

// Scaling by powers of two is exact: an affine map of density and starts maps every state.
TEST(SampleChains, EnsemblesAreInvariantUnderAffineMaps) {
    for (ChainSampler sampler : {ChainSampler::ensemble, ChainSampler::slice}) {
        ChainOptions plain;
        plain.sampler = sampler;
        plain.chains = 1;
        plain.walkers = 6;
        plain.draws = 100;
        plain.burn_in = 20;
        for (int w = 0; w < 6; ++w) plain.starts.push_back({0.1 * w, 0.2 * (w * w % 5) - 0.1});
        ChainOptions mapped = plain;
        for (auto& start : mapped.starts) start = {1024 * start[0], start[1] / 64};
        const Range line{-no_bound, no_bound};
        const ChainDraws a = sample_chains(banana, {line, line}, plain);
        const ChainDraws b = sample_chains(
            [](Point x) {
                const double y[] = {x[0] / 1024, 64 * x[1]};
                return banana(y);
            },
            {line, line}, mapped);
        for (std::size_t i = 0; i < a.states.size(); ++i)
            ASSERT_EQ(b.states[i], a.states[i] * (i % 2 == 0 ? 1024 : 1.0 / 64)) << i;
    }
}

TEST(SampleChains, DensityIsCalledForHalvesOfEnsembles) {
    std::atomic<std::size_t> largest{0}, whole{0};
    const Integrand f = Integrand::batch([&](const PointBatch& x, ValueBatch y) {
        whole += x.count() == 16;
        if (x.count() < 16) largest = std::max<std::size_t>(largest, x.count());
        for (std::size_t i = 0; i < x.count(); ++i) y(i) = -0.5 * x(i, 0) * x(i, 0);
    });
    ChainOptions options;
    options.sampler = ChainSampler::slice;
    options.walkers = 16;
    options.draws = 20;
    const ChainDraws draws =
        with_threads(1, [&] { return sample_chains(f, Domain::interval(-no_bound, no_bound), options); });
    EXPECT_EQ(largest, 8u);
    EXPECT_EQ(whole, 4u); // where the ensembles start
    EXPECT_EQ(draws.chains, 64u);
    EXPECT_EQ(draws.acceptance_rate, 1);
}

TEST(SampleChains, ValuesThatAreNotFiniteAreCounted) {
    for (ChainSampler sampler : {ChainSampler::metropolis, ChainSampler::ensemble, ChainSampler::slice}) {
        ChainOptions options;
        options.sampler = sampler;
        const ChainDraws draws = sample_chains(
            [](double x) { return x < -2 ? std::numeric_limits<double>::quiet_NaN() : -0.5 * x * x; },
            Domain::interval(-10, 10), options);
        EXPECT_GT(draws.non_finite, 0u);
        EXPECT_NE(draws.warnings.back().find("were not finite"), std::string::npos);
        for (double x : draws.states) ASSERT_GE(x, -2);
    }
}

// A density that has no integral: its draws run away, and that is said.
TEST(SampleChains, DrawsThatRunToInfinityAreWarnedOf) {
    for (ChainSampler sampler : {ChainSampler::ensemble, ChainSampler::slice}) {
        ChainOptions options;
        options.sampler = sampler;
        if (sampler == ChainSampler::slice) options.burn_in = options.draws = 400;
        const ChainDraws draws =
            sample_chains([](double) { return 0.0; }, Domain::interval(-no_bound, no_bound), options);
        ASSERT_FALSE(draws.warnings.empty());
        EXPECT_NE(draws.warnings[0].find("run to infinity"), std::string::npos) << draws.warnings[0];
        for (double x : draws.states) ASSERT_TRUE(std::isfinite(x));
    }
}

// Walkers cannot move, since the density is zero elsewhere; their proposals show the random numbers.
TEST(WalkerEnsemble, EveryStepHasRandomNumbersOfItsOwn) {
    std::vector<double> asked;
    const Integrand integers([&](double x) {
        asked.push_back(x);
        return x == std::floor(x) ? 0 : -no_bound;
    });
    const std::vector<Range> line{{-no_bound, no_bound}};
    WalkerEnsemble ensemble(EnsembleMove::stretch, {integers, line}, {0, 1, 2, 3}, 5, 0);
    std::vector<std::array<double, 4>> proposals;
    for (int i = 0; i < 70'000; ++i) {
        asked.clear();
        ensemble.step(false);
        ASSERT_EQ(asked.size(), 4u);
        std::copy(asked.begin(), asked.end(), proposals.emplace_back().begin());
    }
    EXPECT_EQ(ensemble.moved(), 0u);
    std::ranges::sort(proposals);
    EXPECT_EQ(std::ranges::adjacent_find(proposals), proposals.end());
}

// The error is about memory, or else about a wrong number of starts, so that nothing runs.
TEST(SampleChains, DrawsThatDoNotFitIntoMemoryAreRefused) {
    auto refusal = [](double draws) {
        ChainOptions options{.draws = static_cast<std::uint64_t>(draws)};
        options.starts = {{0, 0}, {1, 1}};
        try {
            sample_chains(banana, Domain({{-5, 5}, {-5, 5}}), options);
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string("none");
    };
    const double all = physical_memory() / sizeof(double) / 4 / 2; // draws of four chains in two variables
    EXPECT_NE(refusal(1.01 * all).find("GiB of memory; this machine has"), std::string::npos);
    // Diagnostics take at most ten numbers for the two of a state.
    EXPECT_NE(refusal(all / 7).find("2 starts were given"), std::string::npos);
}

TEST(SampleChains, SenselessOptionsAreRefused) {
    const Domain plane({{-5, 5}, {-5, 5}});
    auto refused = [&](ChainOptions options, const char* why) {
        try {
            sample_chains(banana, plane, options);
            ADD_FAILURE() << why;
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
        }
    };
    refused({.chains = 0}, "expected 1 to 10000 chains");
    refused({.walkers = 8}, "chains of metropolis have no walkers");
    refused({.sampler = ChainSampler::ensemble, .walkers = 3},
            "3 walkers were given for 2 variables; expected 4");
    refused({.draws = 7}, "at least 8 draws");
    refused({.thin = 0}, "thinning");
    refused({.draws = std::uint64_t{1} << 30, .thin = std::uint64_t{1} << 60}, "more than 2^62 states");
    refused({.draws = std::uint64_t{1} << 37}, "GiB of memory; this machine has");
    refused({.starts = {{0, 0}, {1, 1}}}, "2 starts were given for 4 chains");
    refused({.starts = {{0}}}, "1 numbers were given as a start of 2 variables");
    refused({.names = {"a"}}, "expected a name for each");
    EXPECT_THROW(sample_chains(banana, Domain::ball({0, 0}), {}), Error);
    EXPECT_THROW(sample_chains([](double x) { return -x; }, plane, {}), Error);
    for (ChainSampler sampler : {ChainSampler::metropolis, ChainSampler::ensemble, ChainSampler::slice}) {
        const auto nowhere = [](Point) { return -no_bound; };
        EXPECT_THROW(sample_chains(nowhere, plane, {.sampler = sampler}), Error);
        EXPECT_THROW(sample_chains(nowhere, plane, {.sampler = sampler, .starts = {{0, 0}}}), Error);
        CancelFlag cancel;
        cancel.request();
        EXPECT_TRUE(sample_chains(banana, plane, {.sampler = sampler, .cancel = &cancel}).cancelled);
    }
}

} // namespace
} // namespace montelux
