#include <cmath>
#include <gtest/gtest.h>

#include "montelux/mc/integrate/integrate.h"
#include "montelux/mc/integrate/metropolis/metropolis.h"
#include "montelux/mc/integrate/metropolis/student_mixture.h"
#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/stats/z_test.h"

namespace montelux {
namespace {

using Point = std::span<const double>;

// A correlated Gaussian inside the unit square times a factor that changes sign: its integral over all of
// space is slope * mean-free part 0 + offset * norm, and the cube cuts off less than 1e-12 of it.
struct SignedGaussian {
    double offset;
    static constexpr double a = 300, b = 180; // exp(-a (s^2 + t^2) + b s t)
    double operator()(Point x) const {
        const double s = x[0] - 0.5, t = x[1] - 0.45;
        return (offset + 8 * s) * std::exp(-a * (s * s + t * t) + b * s * t);
    }
    double integral() const { return offset * 2 * pi / std::sqrt(4 * a * a - b * b); }
};

void expect_calibrated(const SignedGaussian& f, const char* what) {
    constexpr int runs = 200;
    int within_one = 0, within_two = 0;
    for (std::uint64_t seed = 0; seed < runs; ++seed) {
        const auto r =
            integrate(f, Domain::unit_cube(2), Metropolis{.chains = 16, .burn_in = 200, .pilot = 1024},
                      {.evaluations = 12000}, {.seed = seed, .threads = 1});
        EXPECT_LE(r.evaluations, 12000u);
        const double z = std::abs(r.value[0] - f.integral()) / r.standard_error[0];
        within_one += z < 1;
        within_two += z < 2;
    }
    EXPECT_GE(within_one, 0.60 * runs) << what;
    EXPECT_LE(within_one, 0.80 * runs) << what;
    EXPECT_GE(within_two, 0.90 * runs) << what;
    EXPECT_LE(within_two, 0.99 * runs) << what;
}

TEST(Metropolis, ErrorsAreCalibratedForOneSignAndForTwo) {
    expect_calibrated({5}, "positive");
    expect_calibrated({0.2}, "signed");
}

TEST(Metropolis, ErrorFallsWithTheRootOfTheEvaluations) {
    const SignedGaussian f{0.2};
    const auto few = integrate(f, Domain::unit_cube(2), Metropolis{}, {.evaluations = 100000});
    const auto many = integrate(f, Domain::unit_cube(2), Metropolis{}, {.evaluations = 1600000});
    EXPECT_NEAR(many.value[0], f.integral(), 5 * many.standard_error[0]);
    EXPECT_NEAR(few.standard_error[0] / many.standard_error[0], 4, 1.2);
    EXPECT_TRUE(many.warnings.empty()) << many;
    EXPECT_LT(many.standard_error[0], 0.02 * f.integral());
}

TEST(Metropolis, VectorsHaveValuesOfEachComponentAndCovariances) {
    const Integrand f = Integrand::vector_valued(2, [](Point x, std::span<double> y) {
        y[0] = SignedGaussian{1}(x);
        y[1] = 1000 * SignedGaussian{-0.5}(x);
    });
    const auto r = integrate(f, Domain::unit_cube(2), Metropolis{}, {.evaluations = 300000});
    EXPECT_NEAR(r.value[0], SignedGaussian{1}.integral(), 5 * r.standard_error[0]);
    EXPECT_NEAR(r.value[1], 1000 * SignedGaussian{-0.5}.integral(), 5 * r.standard_error[1]);
    ASSERT_EQ(r.covariance.size(), 4u);
    EXPECT_NEAR(std::sqrt(r.covariance[0]), r.standard_error[0], 1e-9 * r.standard_error[0]);
    EXPECT_EQ(r.covariance[1], r.covariance[2]);
}

TEST(Metropolis, InfiniteRangesAreWalkedThroughTheirMap) {
    const double inf = std::numeric_limits<double>::infinity();
    const Integrand f = [](Point x) { return std::exp(-0.5 * ((x[0] - 3) * (x[0] - 3) + x[1] * x[1])); };
    const auto r = integrate(f, Domain({{-inf, inf}, {-inf, inf}}), Metropolis{}, {.evaluations = 200000});
    EXPECT_NEAR(r.value[0], 2 * pi, 5 * r.standard_error[0]);
    EXPECT_LT(r.standard_error[0], 0.05);
}

// Chains that start in either peak never cross between them.
TEST(Metropolis, PeaksThatChainsDoNotConnectGiveAWarning) {
    const Integrand f = [](Point x) {
        return std::exp(-8000 * (x[0] - 0.1) * (x[0] - 0.1)) - std::exp(-8000 * (x[0] - 0.9) * (x[0] - 0.9));
    };
    const auto r = integrate(f, Domain::unit_cube(1), Metropolis{}, {.evaluations = 60000});
    EXPECT_FALSE(r.warnings.empty()) << r;
}

TEST(Metropolis, BitsDoNotDependOnThreads) {
    const Budget budget{.evaluations = 100000};
    const auto one =
        integrate(SignedGaussian{0.2}, Domain::unit_cube(2), Metropolis{}, budget, {.threads = 1});
    const auto four =
        integrate(SignedGaussian{0.2}, Domain::unit_cube(2), Metropolis{}, budget, {.threads = 4});
    EXPECT_EQ(one.value, four.value);
    EXPECT_EQ(one.standard_error, four.standard_error);
    EXPECT_EQ(one.evaluations, four.evaluations);
}

TEST(Metropolis, SavedAndRestoredRunEndsWithTheSameBits) {
    const Evaluator g(SignedGaussian{0.2}, Domain::unit_cube(2));
    const Problem problem{g, 9};
    const StepRequest request{.max_evaluations = 1 << 20};
    for (int broken_after : {0, 1, 2, 4}) {
        auto whole = Metropolis{}.estimator(problem), first = Metropolis{}.estimator(problem);
        for (int k = 0; k < 5; ++k) ASSERT_EQ(whole->step(request), StepOutcome::advanced);
        for (int k = 0; k < broken_after; ++k) first->step(request);
        StateWriter written;
        first->save(written);
        StateReader reader({written.words().begin(), written.words().end()});
        auto second = Metropolis{}.estimator(problem);
        second->load(reader);
        EXPECT_TRUE(reader.at_end());
        for (int k = broken_after; k < 5; ++k) second->step(request);
        EXPECT_EQ(whole->tally().value, second->tally().value);
        EXPECT_EQ(whole->tally().standard_error, second->tally().standard_error);
        EXPECT_EQ(whole->tally().evaluations, second->tally().evaluations);
    }
}

TEST(Metropolis, ZeroDensityGivesAWarning) {
    const auto r =
        integrate([](Point) { return 0.0; }, Domain::unit_cube(2), Metropolis{}, {.evaluations = 100000});
    EXPECT_FALSE(r.warnings.empty());
    EXPECT_FALSE(std::isfinite(r.standard_error[0]));
    const auto endless =
        integrate([](Point) { return 0.0; }, Domain::unit_cube(2), Metropolis{}, {.relative_error = 0.01});
    EXPECT_EQ(endless.stop, StopReason::finished);
}

TEST(Metropolis, SettingsOutOfRangeAreRefused) {
    const Evaluator g([](Point x) { return x[0]; }, Domain::unit_cube(2));
    EXPECT_THROW(Metropolis{.chains = 1}.estimator({g, 0}), Error);
    EXPECT_THROW(Metropolis{.burn_in = 3}.estimator({g, 0}), Error);
    const Evaluator wide([](Point x) { return x[0]; }, Domain::unit_cube(300));
    EXPECT_THROW(Metropolis{}.estimator({wide, 0}), Error);
}

// The mean of 1 / q over points of q that fall into the cube is the cube's volume.
TEST(StudentMixture, DensityBelongsToItsSamples) {
    CovarianceMoments moments(3);
    PhiloxStream numbers(4);
    for (int i = 0; i < 1000; ++i) {
        const double a = numbers.next_double();
        const double b = numbers.next_double();
        const double c = numbers.next_double();
        const double x[3] = {0.5 + 0.1 * a, 0.4 + 0.2 * b + 0.1 * a, 0.9 * c};
        moments.add(x);
    }
    const StudentMixture mixture(moments);
    RunningMoments volume, mean;
    for (int i = 0; i < 200000; ++i) {
        double x[3];
        const bool inside = mixture.sample(numbers, x);
        const double weight = inside ? 1 / mixture.density(x) : 0;
        volume.add(weight);
        mean.add(weight * x[0] * x[1] * (1 + x[2]));
    }
    EXPECT_TRUE(unbiasedness_test(Estimate::from_moments(volume), 1).passes(1e-6));
    EXPECT_TRUE(unbiasedness_test(Estimate::from_moments(mean), 0.375).passes(1e-6));
}

} // namespace
} // namespace montelux
