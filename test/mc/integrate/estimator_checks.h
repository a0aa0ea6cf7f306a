// What every estimator promises, as checks that any method can be put through: unbiased, calibrated, the same
// bits for any number of threads and after a resume, values that are not finite counted, budgets kept.
#pragma once

#include "test/significance.h"
#include <cmath>
#include <gtest/gtest.h>
#include <set>
#include <vector>

#include "montelux/mc/integrate/integrate.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/math/special.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/mc/stats/z_test.h"

namespace montelux {

struct KnownIntegral {
    Integrand f;
    Domain domain;
    std::vector<double> truth;
};

// Over many seeds, for each component: the mean is the truth, and the truth lies within 1, 2, 3 standard
// errors as often as Student's law says (the normal law for degrees_of_freedom = 0).
inline void expect_unbiased_and_calibrated(const KnownIntegral& problem, const Method& method,
                                           const Budget& budget, int seeds, int degrees_of_freedom = 0) {
    std::vector<RunningMoments> values(problem.truth.size());
    std::vector<std::vector<double>> z(problem.truth.size());
    for (int seed = 0; seed < seeds; ++seed) {
        const IntegrationResult r = integrate(problem.f, problem.domain, method, budget,
                                              {.seed = static_cast<std::uint64_t>(seed), .threads = 1});
        ASSERT_EQ(r.value.size(), problem.truth.size());
        ASSERT_EQ(r.non_finite, 0u);
        ASSERT_TRUE(r.statistical);
        if (budget.evaluations > 0) {
            ASSERT_LE(r.evaluations, budget.evaluations);
        }
        for (std::size_t c = 0; c < problem.truth.size(); ++c) {
            values[c].add(r.value[c]);
            double score = (r.value[c] - problem.truth[c]) / r.standard_error[c];
            if (degrees_of_freedom > 0) {
                // By the lower tail, where the quantile keeps its digits.
                const double tail = student_t_cdf(-std::abs(score), degrees_of_freedom);
                score = std::copysign(normal_quantile(tail), score);
            }
            z[c].push_back(score);
        }
    }
    for (std::size_t c = 0; c < problem.truth.size(); ++c) {
        const TestResult bias = unbiasedness_test(values[c], problem.truth[c]);
        EXPECT_TRUE(bias.passes(significance))
            << method.name() << ", component " << c << ": " << bias.description;
        const TestResult calibration = calibration_test(z[c]);
        EXPECT_TRUE(calibration.passes(significance))
            << method.name() << ", component " << c << ": " << calibration.description;
    }
}

inline void expect_equal_bits(const Tally& a, const Tally& b) {
    EXPECT_EQ(a.value, b.value);
    EXPECT_EQ(a.standard_error, b.standard_error);
    EXPECT_EQ(a.covariance, b.covariance);
    EXPECT_EQ(a.evaluations, b.evaluations);
    EXPECT_EQ(a.non_finite.count, b.non_finite.count);
    EXPECT_EQ(a.non_finite.first_point, b.non_finite.first_point);
    EXPECT_EQ(a.chi_squared, b.chi_squared);
    EXPECT_EQ(a.degrees_of_freedom, b.degrees_of_freedom);
    EXPECT_EQ(a.ready, b.ready);
    EXPECT_EQ(a.warnings, b.warnings);
}

// Steps until nothing advances or `steps` are done.
inline int advance(Estimator& estimator, std::uint64_t evaluations, int steps = 1 << 20) {
    int done = 0;
    for (; done < steps; ++done) {
        const std::uint64_t before = estimator.tally().evaluations;
        if (before >= evaluations ||
            estimator.step({.max_evaluations = evaluations - before}) != StepOutcome::advanced)
            break;
        EXPECT_LE(estimator.tally().evaluations, evaluations);
    }
    return done;
}

inline void expect_same_bits_for_any_threads(const KnownIntegral& problem, const Method& method,
                                             std::uint64_t evaluations) {
    const Evaluator evaluator(problem.f, problem.domain);
    auto run = [&](int threads) {
        return with_threads(threads, [&] {
            auto estimator = method.estimator({evaluator, 7});
            advance(*estimator, evaluations);
            return estimator->tally();
        });
    };
    const Tally one = run(1);
    EXPECT_GT(one.evaluations, 0u);
    expect_equal_bits(one, run(2));
    expect_equal_bits(one, run(7));
}

// Interrupted after some of the steps, saved, loaded by a fresh estimator and continued; and a step that
// is cancelled changes nothing.
inline void expect_same_bits_after_resume(const KnownIntegral& problem, const Method& method,
                                          std::uint64_t evaluations) {
    const Evaluator evaluator(problem.f, problem.domain);
    auto uninterrupted = method.estimator({evaluator, 3});
    const int steps = advance(*uninterrupted, evaluations);
    EXPECT_GE(steps, 1);
    for (int cut : std::set<int>{0, 1, 2, steps / 2, steps - 1, steps}) {
        auto first = method.estimator({evaluator, 3});
        advance(*first, evaluations, cut);
        CancelFlag cancel;
        cancel.request();
        const std::uint64_t before = first->tally().evaluations;
        if (before < evaluations) {
            const StepOutcome outcome =
                first->step({.max_evaluations = evaluations - before, .cancel = &cancel});
            EXPECT_NE(outcome, StepOutcome::advanced);
        }
        StateWriter saved;
        first->save(saved);
        StateReader reader({saved.words().begin(), saved.words().end()});
        auto second = method.estimator({evaluator, 3});
        second->load(reader);
        EXPECT_TRUE(reader.at_end());
        expect_equal_bits(first->tally(), second->tally());
        advance(*second, evaluations);
        expect_equal_bits(second->tally(), uninterrupted->tally());
    }
}

// NaN at a part of the domain of about a tenth of the samples: left out, counted and located.
inline void expect_non_finite_counted(const Domain& domain, const Method& method, std::uint64_t evaluations) {
    auto f = [](std::span<const double> x) { return x[0] < 0.1 ? std::nan("") : 1.0; };
    const IntegrationResult r = integrate(f, domain, method, {.evaluations = evaluations});
    EXPECT_GT(r.non_finite, 0u);
    EXPECT_LT(r.non_finite, r.evaluations / 2);
    ASSERT_FALSE(r.first_non_finite_point.empty());
    EXPECT_LT(r.first_non_finite_point[0], 0.1);
    EXPECT_TRUE(std::isfinite(r.value[0]));
    EXPECT_FALSE(r.warnings.empty());
    EXPECT_THROW(integrate(f, domain, method, {.evaluations = evaluations},
                           {.non_finite = NonFinitePolicy::throw_error}),
                 Error);
}

// x e^-y and y^2 over [0, 1] x [0, 2].
inline KnownIntegral two_components() {
    return {Integrand::vector_valued(2,
                                     [](std::span<const double> x, std::span<double> y) {
                                         y[0] = x[0] * std::exp(-x[1]);
                                         y[1] = x[1] * x[1];
                                     }),
            Domain({{0, 1}, {0, 2}}),
            {0.5 * (1 - std::exp(-2.0)), 8.0 / 3}};
}

inline void expect_keeps_promises(const Method& method, std::uint64_t evaluations) {
    expect_same_bits_for_any_threads(two_components(), method, evaluations);
    expect_same_bits_after_resume(two_components(), method, evaluations);
    expect_non_finite_counted(Domain::unit_cube(2), method, evaluations);
}

} // namespace montelux
