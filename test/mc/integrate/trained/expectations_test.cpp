#include "test/mc/integrate/trained/trained_problems.h"
#include "test/significance.h"
#include <gtest/gtest.h>

#include "montelux/mc/integrate/adaptive/gaussian.h"
#include "montelux/mc/integrate/trained/expectations.h"
#include "montelux/mc/integrate/trained/observables.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/math/special.h"
#include "montelux/mc/stats/z_test.h"

namespace montelux {
namespace {

const std::vector<double> edges{-1, -0.75, -0.5, 2};

Integrand coordinate_of_the_first() {
    return Integrand([](std::span<const double> x) { return x[0]; });
}
std::vector<double> exact_bins() {
    std::vector<double> bins;
    for (std::size_t k = 0; k + 1 < edges.size(); ++k)
        bins.push_back(CutBells::integral(edges[k], edges[k + 1], 0, 2));
    return bins;
}

TEST(Observables, BinsAreHalfOpenButForTheLast) {
    const Integrand bins = histogram_bins(coordinate_of_the_first(), {0, 1, 2});
    PointBuffer x(6, 1);
    const double at[] = {-0.1, 0, 0.5, 1, 2, std::nan("")};
    for (std::size_t i = 0; i < 6; ++i) x(i, 0) = at[i];
    ValueBuffer y(6, 2);
    bins(x, y);
    const double first[] = {0, 1, 1, 0, 0, 0}, second[] = {0, 0, 0, 1, 1, 0};
    EXPECT_TRUE(std::isnan(y(5, 0)) && std::isnan(y(5, 1)));
    for (std::size_t i = 0; i < 5; ++i) {
        EXPECT_EQ(y(i, 0), first[i]) << at[i];
        EXPECT_EQ(y(i, 1), second[i]) << at[i];
    }
    EXPECT_THROW(histogram_bins(coordinate_of_the_first(), {1}), Error);
    EXPECT_THROW(histogram_bins(coordinate_of_the_first(), {1, 1}), Error);
    EXPECT_THROW(histogram_bins(coordinate_of_the_first(), {0, std::nan("")}), Error);
}

TEST(Observables, IntegrateGivesTheMeansInOneRun) {
    const Integrand both =
        together({coordinate_of_the_first(), histogram_bins(coordinate_of_the_first(), edges)});
    const IntegrationResult r = integrate(with_observables(CutBells::value, both), CutBells::domain(),
                                          Vegas{}, {.evaluations = 100'000});
    ASSERT_EQ(r.value.size(), 5u);
    EXPECT_NEAR(r.value[0], CutBells::integral(-1, 3, 0, 2), 5 * r.standard_error[0]);
    const std::vector<double> bins = exact_bins();
    for (std::size_t k = 0; k < bins.size(); ++k)
        EXPECT_NEAR(r.value[k + 2], bins[k], 5 * r.standard_error[k + 2]);
}

// (value - truth)^T C^-1 (value - truth).
double mahalanobis(const std::vector<double>& value, const std::vector<double>& truth,
                   const std::vector<double>& covariance) {
    const std::size_t n = value.size();
    std::vector<double> scaled(n * n), mean(n), x(n);
    for (std::size_t a = 0; a < n; ++a) {
        x[a] = (value[a] - truth[a]) / std::sqrt(covariance[a * n + a]);
        for (std::size_t b = 0; b < n; ++b)
            scaled[a * n + b] =
                covariance[a * n + b] / std::sqrt(covariance[a * n + a] * covariance[b * n + b]);
    }
    return Gaussian(mean, cholesky_factor(std::span<const double>(scaled), static_cast<int>(n)))
        .squared_distance(x);
}

// Histograms with their full covariance: chi-squared against the exact bins over many seeds, in absolute
// numbers and normalised. Of uniform points, whose weights are so uneven that bins and total correlate.
TEST(Expectations, HistogramsAreCalibratedWithTheirCovariance) {
    const TrainedDensity density(std::make_shared<const UnitDensity>(MixtureDensity(2)), CutBells::domain());
    const std::vector<double> exact = exact_bins();
    const double all = CutBells::integral(-1, 3, 0, 2);
    std::vector<double> absolute{all}, normalised;
    for (double bin : exact) {
        absolute.push_back(bin);
        normalised.push_back(bin / all);
    }
    const Integrand bins = histogram_bins(coordinate_of_the_first(), edges);
    std::vector<double> p_absolute, p_normalised;
    for (std::uint64_t seed = 0; seed < 800; ++seed) {
        SamplingOptions options;
        options.seed = seed;
        options.threads = 1;
        const Expectations found = expectations(density, CutBells::value, bins, 8192, options);
        p_absolute.push_back(
            chi_squared_p_value(mahalanobis(found.integral, absolute, found.integral_covariance), 4));
        p_normalised.push_back(
            chi_squared_p_value(mahalanobis(found.mean(), normalised, found.mean_covariance()), 3));
    }
    const auto uniform_cdf = [](double p) { return std::clamp(p, 0.0, 1.0); };
    for (const auto* p : {&p_absolute, &p_normalised}) {
        const TestResult result = kolmogorov_smirnov_test(*p, uniform_cdf);
        EXPECT_TRUE(result.passes(significance)) << result.description;
    }
}

TEST(Expectations, ThreadsChangeNoBitAndLogarithmsNothing) {
    const TrainedDensity density = cut_bells(Vegas{});
    const Integrand bins = histogram_bins(coordinate_of_the_first(), edges);
    SamplingOptions options;
    options.threads = 1;
    const Expectations one = expectations(density, CutBells::value, bins, 30000, options);
    options.threads = 3;
    const Expectations three = expectations(density, CutBells::value, bins, 30000, options);
    EXPECT_EQ(one.integral, three.integral);
    EXPECT_EQ(one.integral_covariance, three.integral_covariance);
    EXPECT_EQ(one.draws, 30000u);
    options.form = IntegrandForm::logarithm;
    auto log_f = [](std::span<const double> x) { return std::log(CutBells::value(x)) + 3000; };
    const Expectations logarithm = expectations(density, log_f, bins, 30000, options);
    EXPECT_NEAR(std::log(logarithm.integral[0]) + logarithm.log_reference, std::log(one.integral[0]) + 3000,
                1e-9);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(logarithm.mean()[k], one.mean()[k], 1e-9);
}

TEST(Expectations, MistakesGetASentence) {
    const TrainedDensity density = cut_bells(Vegas{});
    EXPECT_THROW(expectations(density, CutBells::value, coordinate_of_the_first(), 1), Error);
    const Integrand many = Integrand::vector_valued(1024, [](auto, auto y) { y[0] = 1; });
    EXPECT_THROW(expectations(density, CutBells::value, many, 100), Error);
    auto pole = Integrand([](std::span<const double> x) { return x[0] > 1 ? std::nan("") : 1.0; });
    const Expectations left_out = expectations(density, CutBells::value, pole, 1000);
    EXPECT_EQ(left_out.warnings.size(), 1u);
    EXPECT_GT(left_out.non_finite.count, 50u);
    const Expectations whole = expectations(density, CutBells::value, coordinate_of_the_first(), 1000);
    EXPECT_EQ(left_out.integral[0], whole.integral[0]); // which knows no observable
}

// A peak that the density does not know: few draws carry all, and some bins see none.
TEST(Expectations, ErrorsThatSayNothingGetAWarning) {
    const TrainedDensity untrained(std::make_shared<const UnitDensity>(MixtureDensity(2)),
                                   Domain::unit_cube(2));
    auto peak = [](std::span<const double> x) {
        return std::exp(-3e5 * (std::pow(x[0] - 0.3, 2) + std::pow(x[1] - 0.6, 2)));
    };
    const Integrand bins = histogram_bins(coordinate_of_the_first(), {0, 0.25, 0.35, 1});
    const Expectations found = expectations(untrained, peak, bins, 20000);
    std::string all;
    for (const std::string& warning : found.warnings) all += warning + "\n";
    EXPECT_NE(all.find("unweighted samples"), std::string::npos) << all;
    EXPECT_NE(all.find("zero in all draws"), std::string::npos) << all;
    // Of a rare event, two hits where eight are expected: their error knows how little that is.
    int wrong = 0;
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
        SamplingOptions options;
        options.seed = seed;
        const Expectations rare = expectations(
            untrained, [](std::span<const double>) { return 1.0; },
            Integrand([](std::span<const double> x) { return x[0] < 0.008 ? 1.0 : 0.0; }), 1000, options);
        const double error = std::sqrt(rare.integral_covariance[3]);
        wrong += rare.integral[1] > 0 && std::abs(rare.integral[1] - 0.008) > 4 * error;
    }
    EXPECT_EQ(wrong, 0); // about 5 by the spread of the draws alone
}

} // namespace
} // namespace montelux
