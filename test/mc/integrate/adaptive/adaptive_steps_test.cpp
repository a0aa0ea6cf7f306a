#include "test/mc/integrate/adaptive/adaptive_problems.h"
#include "test/mc/integrate/estimator_checks.h"
#include <algorithm>
#include <atomic>
#include <gtest/gtest.h>
#include <set>
#include <vector>

#include "montelux/mc/integrate/adaptive/adaptive.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

// Steps with targets, which decide between the phases.
struct Steps {
    std::uint64_t evaluations; // in all
    double relative_error = 0;
};
StepOutcome step(Estimator& estimator, const Steps& steps, const CancelFlag* cancel = nullptr) {
    const std::uint64_t done = estimator.tally().evaluations;
    if (done >= steps.evaluations) return StepOutcome::exhausted;
    const StepOutcome outcome = estimator.step({.max_evaluations = steps.evaluations - done,
                                                .relative_error = steps.relative_error,
                                                .cancel = cancel});
    EXPECT_LE(estimator.tally().evaluations, steps.evaluations);
    return outcome;
}
std::vector<std::uint64_t> words_of(const Estimator& estimator) {
    StateWriter state;
    estimator.save(state);
    return {state.words().begin(), state.words().end()};
}

struct Stop {};

// Between any two steps: saved and loaded it resumes to the same bits, and a step that is cancelled, or in
// which the integrand throws at its first or its last evaluations, changes nothing. Returns the phases it
// went through, which is the first word of the state.
std::set<std::uint64_t> check_every_step(const KnownIntegral& problem, const Steps& steps) {
    constexpr std::uint64_t unlimited = ~std::uint64_t{0};
    std::atomic<std::uint64_t> made = 0, allowed = unlimited;
    const Integrand f = problem.f.with_function([&](const PointBatch& x, ValueBatch y) {
        if ((made += x.count()) > allowed) throw Stop();
        problem.f(x, y);
    });
    const Evaluator evaluator(f, problem.domain);
    auto estimator = Adaptive{}.estimator({evaluator, 11});
    std::set<std::uint64_t> phases;
    std::vector<std::vector<std::uint64_t>> states{words_of(*estimator)};
    while (true) {
        const std::vector<std::uint64_t>& before = states.back();
        phases.insert(before.front());
        CancelFlag cancel;
        cancel.request();
        EXPECT_NE(step(*estimator, steps, &cancel), StepOutcome::finished);
        if (before.front() != 1) { // the search for peaks is too short to be cancelled
            EXPECT_EQ(words_of(*estimator), before);
        } else {
            StateReader again(before);
            estimator->load(again);
        }
        StateReader copied(before);
        auto copy = Adaptive{}.estimator({evaluator, 11});
        copy->load(copied);
        made = 0;
        step(*copy, steps);
        const std::uint64_t needed = made;
        for (std::uint64_t enough_for :
             {std::uint64_t{0}, needed / 2, std::max<std::uint64_t>(needed, 1) - 1}) {
            made = 0;
            allowed = enough_for;
            if (needed > 0) {
                EXPECT_THROW(step(*estimator, steps), Stop);
            }
            EXPECT_EQ(words_of(*estimator), before)
                << "phase " << before.front() << ", thrown after " << enough_for << " of " << needed;
        }
        allowed = unlimited;
        if (step(*estimator, steps) != StepOutcome::advanced) break;
        states.push_back(words_of(*estimator));
    }
    EXPECT_EQ(words_of(*estimator), states.back());
    for (std::size_t cut = 0; cut + 1 < states.size(); ++cut) {
        StateReader reader(states[cut]);
        auto loaded = Adaptive{}.estimator({evaluator, 11});
        loaded->load(reader);
        EXPECT_TRUE(reader.at_end());
        EXPECT_EQ(words_of(*loaded), states[cut]);
        EXPECT_EQ(step(*loaded, steps), StepOutcome::advanced);
        EXPECT_EQ(words_of(*loaded), states[cut + 1]) << "phase " << states[cut].front();
    }
    return phases;
}

TEST(Adaptive, EveryPhaseResumesWithTheSameBitsAndCanBeInterrupted) {
    // explore 0, search 1, train 2, weighted 3, uniform 4
    EXPECT_EQ(check_every_step(two_peaks(6, 300), {60'000}), (std::set<std::uint64_t>{0, 1, 2, 3}));
    EXPECT_EQ(check_every_step(discontinuous(), {60'000, 1e-4}), (std::set<std::uint64_t>{0, 2, 3}));
    EXPECT_EQ(check_every_step(flat(), {60'000, 1e-5}), (std::set<std::uint64_t>{0, 4}));
    check_every_step(two_components(), {30'000});
    const KnownIntegral ridge{rosenbrock_ridge, Domain(std::vector<Range>(4, {-5, 5})), {0}};
    EXPECT_EQ(check_every_step(ridge, {200'000, 1e-3}), (std::set<std::uint64_t>{0, 1, 2, 3}));
}

// Walkers find a part of the ridge that the first density misses. It is abandoned, but its evaluations count.
TEST(Adaptive, EvaluationsOfDensitiesThatWereGivenUpCount) {
    const KnownIntegral problem{rosenbrock_ridge, Domain(std::vector<Range>(4, {-5, 5})), {0}};
    std::atomic<std::uint64_t> made = 0;
    const Integrand f = problem.f.with_function([&](const PointBatch& x, ValueBatch y) {
        made += x.count();
        problem.f(x, y);
    });
    const Evaluator evaluator(f, problem.domain);
    auto estimator = Adaptive{}.estimator({evaluator, 1});
    const auto phase = [&] { return words_of(*estimator).front(); };
    bool given_up = false;
    while (!given_up) {
        const std::uint64_t before = phase();
        ASSERT_EQ(step(*estimator, {400'000, 1e-2}), StepOutcome::advanced);
        EXPECT_EQ(estimator->tally().evaluations, made);
        given_up = before == 3 && phase() == 2; // trains again after weighted samples
    }
}

TEST(Adaptive, ResultsOfUniformPointsAreNotJudgedByTheTrainedDensity) {
    const KnownIntegral problem = two_peaks(6, 300);
    const Evaluator evaluator(problem.f, problem.domain);
    auto estimator = Adaptive{}.estimator({evaluator, 11});
    std::set<std::uint64_t> phases;
    while (step(*estimator, {60'000}) == StepOutcome::advanced) {
        const std::uint64_t phase = words_of(*estimator).front();
        phases.insert(phase);
        if (phase < 3) {
            EXPECT_EQ(estimator->sampled_density(), nullptr) << phase;
        }
    }
    EXPECT_NE(estimator->sampled_density(), nullptr);
    EXPECT_TRUE(phases.contains(2) && phases.contains(3)); // trained, then sampled
}

TEST(Adaptive, DamagedStatesAreRefused) {
    const KnownIntegral problem = discontinuous();
    const Evaluator evaluator(problem.f, problem.domain);
    auto estimator = Adaptive{}.estimator({evaluator, 1});
    advance(*estimator, 20'000);
    std::vector<std::uint64_t> words = words_of(*estimator);
    words.pop_back();
    StateReader cut(words);
    EXPECT_THROW(Adaptive{}.estimator({evaluator, 1})->load(cut), Error);
    StateReader other(words_of(*estimator));
    EXPECT_THROW((Adaptive{.replicates = 8}.estimator({evaluator, 1})->load(other)), Error);
}

} // namespace
} // namespace montelux
