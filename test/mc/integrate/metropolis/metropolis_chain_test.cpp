#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <mutex>

#include "montelux/mc/integrate/metropolis/metropolis_chain.h"
#include "montelux/mc/math/constants.h"
#include "montelux/mc/stats/chi_squared.h"
#include "montelux/mc/stats/z_test.h"

namespace montelux {
namespace {

using Point = std::span<const double>;
using Values = std::span<double>;

constexpr double minus_infinity = -std::numeric_limits<double>::infinity();
const auto observe_first = [](Point x, Values v) { v[0] = x[0]; };
double normal(Point x) {
    double square = 0;
    for (double v : x) square += v * v;
    return -0.5 * square;
}
// p = 5 exp(-5 x) on x > 0, up to a constant.
double decaying(Point x) { return x[0] > 0 ? 3 - 5 * x[0] : minus_infinity; }

// Counts of thinned states in cells of equal probability, by the distribution function of the target.
template <typename Density, typename Propose, typename Cdf>
TestResult histogram_test(const Density& density, const Propose& propose, double start, const Cdf& cdf,
                          std::uint64_t thin, std::uint64_t samples = 150000) {
    constexpr std::size_t cells = 40;
    std::vector<double> observed(cells, 0.0);
    std::mutex mutex;
    double total = 0;
    metropolis(density, propose, {{start}}, 1, observe_first,
               [&](int, std::uint64_t, Point x) {
                   const std::lock_guard lock(mutex);
                   ++observed[std::min(cells - 1, static_cast<std::size_t>(cdf(x[0]) * cells))];
                   ++total;
               },
               {.chains = 4, .samples = samples, .thin = thin, .seed = 11});
    return chi_squared_test(observed, std::vector<double>(cells, total / cells));
}

TEST(MetropolisChain, HistogramOfThinnedSamplesIsTheTarget) {
    const TestResult r = histogram_test(
        decaying, GaussianWalk{}, 0.2, [](double x) { return -std::expm1(-5 * x); }, 60);
    EXPECT_TRUE(r.passes(1e-6)) << r.description;
    // The test can see a density that is a little wrong.
    const TestResult wrong = histogram_test(
        decaying, GaussianWalk{}, 0.2, [](double x) { return -std::expm1(-4 * x); }, 60);
    EXPECT_FALSE(wrong.passes(1e-6)) << wrong.description;
}

// y = x e^(s z): log q(x|y) - log q(y|x) = log y - log x.
std::optional<double> multiply(PhiloxStream& numbers, Point x, Values y) {
    const double u = numbers.next_double();
    y[0] = x[0] * std::exp(2 * (u - 0.5));
    return std::log(y[0] / x[0]);
}

TEST(MetropolisChain, AsymmetricProposalNeedsAndGetsItsCorrection) {
    const auto cdf = [](double x) { return -std::expm1(-5 * x); };
    const TestResult right = histogram_test(decaying, multiply, 0.2, cdf, 40);
    EXPECT_TRUE(right.passes(1e-6)) << right.description;
    const auto uncorrected = [](PhiloxStream& numbers, Point x, Values y) -> std::optional<double> {
        multiply(numbers, x, y);
        return 0;
    };
    const TestResult wrong = histogram_test(decaying, uncorrected, 0.2, cdf, 40);
    EXPECT_FALSE(wrong.passes(1e-6)) << wrong.description;
}

// y = rho x + sqrt(1 - rho^2) z leaves the normal density as it is, with every proposal accepted: an AR(1)
// process, whose autocorrelation time is (1 + rho) / (1 - rho).
TEST(MetropolisChain, AutocorrelationTimeOfAnAutoregressiveChainIsExact) {
    for (double rho : {0.0, 0.5, 0.9, 0.98}) {
        const auto propose = [rho](PhiloxStream& numbers, Point x, Values y) -> std::optional<double> {
            const double z = detail::draw_normals(numbers).x;
            y[0] = rho * x[0] + std::sqrt(1 - rho * rho) * z;
            return 0.5 * (y[0] * y[0] - x[0] * x[0]);
        };
        const auto r = metropolis(normal, propose, {{0.0}}, 1, observe_first,
                                  {.chains = 4, .samples = 150000, .seed = 5});
        EXPECT_EQ(r.acceptance_rate, 1);
        const double exact = (1 + rho) / (1 - rho);
        EXPECT_NEAR(r.observables[0].autocorrelation_time / exact, 1, 0.15) << rho;
        EXPECT_NEAR(r.observables[0].effective_sample_size * exact / 6e5, 1, 0.2) << rho;
        EXPECT_NEAR(r.observables[0].variance, 1, 0.08) << rho;
        EXPECT_LT(r.observables[0].r_hat, 1.01);
        EXPECT_TRUE(r.warnings.empty());
    }
}

TEST(MetropolisChain, ErrorsOfMeansAreCalibrated) {
    std::vector<double> z_scores;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        const auto r = metropolis(normal, GaussianWalk{}, {{0.5, -0.5}}, 2,
                                  [](Point x, Values v) {
                                      v[0] = x[0];
                                      v[1] = x[1] * x[1];
                                  },
                                  {.chains = 4, .burn_in = 500, .samples = 2000, .seed = seed});
        z_scores.push_back(r.observables[0].mean / r.observables[0].standard_error);
    }
    const TestResult test = calibration_test(z_scores);
    EXPECT_TRUE(test.passes(1e-4)) << test.description;
    int within_one = 0, within_two = 0;
    for (double z : z_scores) {
        within_one += std::abs(z) < 1;
        within_two += std::abs(z) < 2;
    }
    EXPECT_GE(within_one, 120);
    EXPECT_LE(within_one, 160);
    EXPECT_GE(within_two, 180);
    EXPECT_LE(within_two, 199);
}

TEST(MetropolisChain, WalkAdaptsToScalesThatDifferALot) {
    const auto density = [](Point x) { return -0.5 * (x[0] * x[0] * 1e4 + x[1] * x[1] * 1e-4); };
    const auto r = metropolis(density, GaussianWalk{}, {{0.01, 10.0}}, 2,
                              [](Point x, Values v) {
                                  v[0] = x[0] * x[0] * 1e4;
                                  v[1] = x[1] * x[1] * 1e-4;
                              },
                              {.burn_in = 8000, .samples = 40000});
    for (int k : {0, 1}) {
        EXPECT_NEAR(r.observables[k].mean, 1, 5 * r.observables[k].standard_error);
        EXPECT_LT(r.observables[k].autocorrelation_time, 40);
    }
    EXPECT_NEAR(r.acceptance_rate, 0.29, 0.1);
    // Two dimensions of one scale, but a walk that may not adapt.
    const auto fixed = metropolis(density, GaussianWalk{.step = 0.01, .adapt = false}, {{0.01, 10.0}}, 1,
                                  observe_first, {.samples = 1000});
    EXPECT_GT(fixed.acceptance_rate, 0.5);
}

TEST(MetropolisChain, ChainsThatDisagreeGiveAWarning) {
    // Two peaks that a small step does not cross.
    const auto two = [](Point x) {
        return std::log(std::exp(-0.5 * (x[0] - 20) * (x[0] - 20)) +
                        std::exp(-0.5 * (x[0] + 20) * (x[0] + 20)));
    };
    const auto apart = metropolis(two, GaussianWalk{}, {{-20.0}, {20.0}, {-20.0}, {20.0}}, 1, observe_first);
    EXPECT_GT(apart.observables[0].r_hat, 2);
    EXPECT_FALSE(apart.warnings.empty());
    // Chains that disagree do not claim to know.
    EXPECT_GT(apart.observables[0].standard_error, 5);
}

TEST(MetropolisChain, BitsDoNotDependOnThreads) {
    auto run = [&](int threads) {
        return with_threads(threads, [&] {
            return metropolis(normal, GaussianWalk{}, {{1.0, 1.0, 1.0}}, 1, observe_first,
                              {.chains = 6, .samples = 5000, .seed = 3});
        });
    };
    const auto one = run(1), five = run(5);
    EXPECT_EQ(one.observables[0].mean, five.observables[0].mean);
    EXPECT_EQ(one.observables[0].standard_error, five.observables[0].standard_error);
    EXPECT_EQ(one.acceptance_rate, five.acceptance_rate);
}

TEST(MetropolisChain, DensityItselfServesAndWhatIsNotFiniteIsCounted) {
    const auto density = log_of([](Point x) {
        return x[0] < -3 ? std::numeric_limits<double>::quiet_NaN() : std::exp(-0.5 * x[0] * x[0]);
    });
    const auto r = metropolis(density, GaussianWalk{}, {{0.0}}, 1, observe_first);
    EXPECT_GT(r.non_finite, 0u);
    EXPECT_FALSE(r.warnings.empty());
    EXPECT_NEAR(r.observables[0].mean, 0, 0.1);
}

TEST(MetropolisChain, SenselessOptionsAreRefused) {
    EXPECT_THROW(metropolis(decaying, GaussianWalk{}, {{-1.0}}, 1, observe_first),
                 Error); // density zero
    EXPECT_THROW(metropolis(normal, GaussianWalk{}, {{0.0}}, 1, observe_first, {.chains = 0}), Error);
    EXPECT_THROW(metropolis(normal, GaussianWalk{}, {{0.0}, {1.0}}, 1, observe_first), Error);
    EXPECT_THROW(metropolis(normal, GaussianWalk{}, {{}}, 1, observe_first), Error);
    EXPECT_THROW(metropolis(normal, GaussianWalk{.scale = {1, 1}}, {{0.0}}, 1, observe_first), Error);
    EXPECT_THROW(metropolis(normal, GaussianWalk{}, {{0.0}}, 1, observe_first, {.thin = 0}), Error);
}

TEST(ChainTrace, BatchesKeepMeanAndVarianceInConstantMemory) {
    ChainTrace trace(2);
    constexpr int n = 100000;
    for (int i = 0; i < n; ++i) {
        const double x = i % 7, values[2] = {x, 1e6 + x};
        trace.add(values);
    }
    EXPECT_LT(trace.batches(), ChainTrace::max_batches);
    EXPECT_GE(trace.batches() * trace.batch_length(), n - trace.batch_length());
    const ChainSummary s = summarize({&trace, 1}, 1);
    EXPECT_NEAR(s.mean, 1e6 + 3, 1e-3);
    EXPECT_NEAR(s.variance, 4, 1e-3);
    // Regular values have a mean that is nearly exact.
    EXPECT_LT(s.standard_error, 1e-3);
    EXPECT_GT(correlation_of_means({&trace, 1}, 0, 1), 0.999);
}

// Halves of n alternating values have the variance n / (n - 1); the variance of their means -1, -1, 2 and 2 is 3. R-hat
// is the root of (n - 1) / n + 3 (n - 1) / n, whether chains or halves of a chain disagree.
TEST(ChainTrace, SplitRHatFollowsItsFormula) {
    for (int n : {4, 1000})
        for (bool within_chains : {false, true}) {
            std::vector<ChainTrace> chains(2, ChainTrace(1));
            for (int c = 0; c < 2; ++c)
                for (int i = 0; i < 2 * n; ++i) {
                    const bool far_part = within_chains ? i >= n : c == 1;
                    const double centre = far_part ? 2 : -1, value = centre + (i % 2 == 0 ? -1 : 1);
                    chains[static_cast<std::size_t>(c)].add({&value, 1});
                }
            const double expected = 2 * std::sqrt((n - 1.0) / n);
            EXPECT_NEAR(split_r_hat(chains, 0), expected, 1e-12) << n << within_chains;
            EXPECT_EQ(summarize(chains, 0).r_hat, split_r_hat(chains, 0));
        }
}

} // namespace
} // namespace montelux
