#include "bench/integrate/escalation.h"
#include "bench/integrate/markdown.h"
#include "bench/integrate/options.h"
#include "bench/integrate/published.h"
#include "bench/integrate/rivals/rivals.h"
#include "bench/integrate/summary.h"
#include <cmath>
#include <gtest/gtest.h>

#include "montelux/mc/math/error.h"
#include "montelux/mc/stats/moments.h"

namespace montelux::bench {
namespace {

constexpr Goal at_1e3{1e-3, 1000000};

// Runs of one method on one line, each given as the true and the claimed error in targets of 1e-3.
struct Outcome {
    double true_error, claimed_error;
    std::uint64_t evaluations = 100;
    bool warned = false;
};
Cell cell_of(const std::vector<Outcome>& outcomes, Goal goal = at_1e3) {
    Plan plan;
    plan.lines = {{Family::gaussian, 5}};
    plan.methods.resize(1);
    plan.goals = {goal};
    std::vector<Run> runs;
    for (const Outcome& outcome : outcomes) {
        Run run{};
        run.exact = 2;
        run.evaluations = outcome.evaluations;
        run.answer.value = 2 * (1 + 1e-3 * outcome.true_error);
        run.answer.error = 2 * 1e-3 * outcome.claimed_error;
        run.answer.converged = outcome.claimed_error <= 1;
        run.answer.warned = outcome.warned;
        runs.push_back(run);
    }
    return Summary(plan, runs).cell(0, 0, 0);
}

TEST(BenchSummary, HonestWhereTheTrueErrorsAreAboutTheTarget) {
    const Cell good = cell_of({{0.95, 0.9}, {-1.2, 0.8}, {0.1, 0.9}});
    EXPECT_TRUE(good.honest);
    EXPECT_EQ(good.answered, 3);
    EXPECT_NEAR(good.rms, 1e-3 * std::sqrt((0.9025 + 1.44 + 0.01) / 3), 1e-12);
    EXPECT_NEAR(good.coverage.within[0], 1.0 / 3, 1e-12);
    EXPECT_NEAR(good.coverage.within[1], 1, 1e-12);

    const Cell bad = cell_of({{0.5, 0.9}, {2.9, 0.9}, {-0.5, 0.5}});
    EXPECT_FALSE(bad.honest);
    EXPECT_EQ(bad.silent, 0);
}

TEST(BenchSummary, ALostPeakIsSilentUnlessThereIsAWarning) {
    const Cell silent = cell_of({{-500, 0.9}, {0, 0.9}});
    EXPECT_EQ(silent.silent, 1);
    const Cell with_warning = cell_of({{-500, 0.9, 100, true}, {0, 0.9}, {0, 0.9}});
    EXPECT_EQ(with_warning.silent, 0);
    EXPECT_EQ(with_warning.silent_warnings_ignored, 1);
    EXPECT_EQ(with_warning.warned, 1);
    EXPECT_TRUE(with_warning.honest);
}

TEST(BenchSummary, MedianCountsRunsWithoutAnAnswerAsInfinite) {
    EXPECT_EQ(cell_of({{0, 0.9, 10}, {0, 0.9, 30}, {0, 2, 99}}).median_evaluations, 30);
    const Cell none = cell_of({{0, 0.9, 10}, {0, 2, 20}, {0, 2, 30}});
    EXPECT_EQ(none.median_evaluations, std::nullopt);
    EXPECT_FALSE(none.honest);
    // Where evaluations are spent, each run counts whatever it claims.
    const Cell spent = cell_of({{3, 2}, {-4, 2}}, {0, 1000});
    EXPECT_EQ(spent.coverage.runs, 2);
    EXPECT_NEAR(spent.rms, 1e-3 * std::sqrt(12.5), 1e-12);
}

TEST(Escalation, StopsAtTheTargetAndNeverPassesTheCap) {
    const BenchIntegrand integrand({Family::gaussian, 2}, 0);
    auto drive = [&](double sigma, double target, std::uint64_t cap, Growth growth) {
        const CountedIntegrand f(integrand);
        const double x[2] = {0.5, 0.5};
        const Answer answer = escalate(f, {target, cap}, 100, growth, [&](std::uint64_t n) {
            for (std::uint64_t i = 0; i < n; ++i) f(x);
            return Trial{1, sigma / std::sqrt(static_cast<double>(n))};
        });
        EXPECT_LE(f.evaluations(), cap);
        return std::pair(answer, f.evaluations());
    };
    EXPECT_EQ(drive(0.1, 0.02, 100000, {}).second, 100u); // the first trial is enough
    const auto [second, spent] = drive(1, 0.02, 100000, {2, 1e9});
    EXPECT_TRUE(second.converged);
    EXPECT_EQ(spent, 100u + 3000u); // 100 * 1.2 * (0.1 / 0.02)^2
    EXPECT_EQ(drive(1, 0.02, 100000, Growth::by(4)).second, 100u + 400u + 1600u + 6400u);
    EXPECT_FALSE(drive(1, 1e-6, 100000, {2, 16}).first.converged); // hopeless: given up at once
    EXPECT_EQ(drive(1, 1e-6, 100000, {2, 16}).second, 100u);
    EXPECT_EQ(drive(1, 0, 5000, {}).second, 5000u); // no target: all of them
}

// The replicates' mean is unbiased and its claimed error is that of 8 numbers: Student's law with 7 degrees
// of freedom, 65.1 % within one error. The bounds are passed by 1 correct program in 10^6 each.
TEST(SobolReplicates, UnbiasedWithAnErrorOfStudentsLaw) {
    const BenchIntegrand integrand({Family::continuous, 5}, 3);
    const Method sobol8 = sobol_methods().front();
    RunningMoments values;
    int within = 0;
    constexpr int runs = 400;
    for (std::uint64_t seed = 0; seed < runs; ++seed) {
        const CountedIntegrand f(integrand);
        const Answer answer = sobol8.run(f, {0, 8 * 256, seed});
        EXPECT_EQ(f.evaluations(), 8u * 256u);
        values.add(answer.value);
        within += std::abs(answer.value - integrand.exact()) <= answer.error;
    }
    EXPECT_LT(std::abs(values.mean() - integrand.exact()), 4.9 * values.standard_error());
    EXPECT_NEAR(within, 0.651 * runs, 4.9 * std::sqrt(0.651 * 0.349 * runs));
    // Far better than random points: their relative standard deviation is about 3 here.
    EXPECT_LT(std::sqrt(values.variance()) / integrand.exact(), 0.02);
}

TEST(BenchOptions, AreReadAndRefused) {
    const Options options = parse_options({"--lines", "osc,gauss-5", "--targets", "1e-2", "--seeds", "3"});
    EXPECT_EQ(options.lines, (std::vector<std::string>{"osc", "gauss-5"}));
    EXPECT_EQ(options.targets, std::vector<double>{1e-2});
    EXPECT_EQ(options.seeds, 3u);
    EXPECT_TRUE(parse_options({"--targets", "none"}).targets.empty());
    EXPECT_THROW(parse_options({"--seeds"}), Error);
    EXPECT_THROW(parse_options({"--seeds", "many"}), Error);
    EXPECT_THROW(parse_options({"--cap", "1e6x"}), Error);
    EXPECT_THROW(parse_options({"--unknown"}), Error);
}

TEST(BenchTables, NumbersAreShort) {
    EXPECT_EQ(short_count(84), "84");
    EXPECT_EQ(short_count(8192), "8.2k");
    EXPECT_EQ(short_count(172032), "172k");
    EXPECT_EQ(short_count(13.6e6), "14M");
    EXPECT_EQ(short_error(0.00012), "1.2e-4");
    EXPECT_EQ((Goal{1e-3, 5}).name(), "1e-3");
    EXPECT_EQ((Goal{0, 1000000}).name(), "1e6 evaluations");
    for (Line line : bench_lines()) {
        EXPECT_TRUE(published_medians(line, 1e-3)) << line_name(line);
        EXPECT_TRUE(published_medians(line, 1e-4)) << line_name(line);
    }
    EXPECT_FALSE(published_medians({Family::gaussian, 5}, 1e-2));
}

} // namespace
} // namespace montelux::bench
