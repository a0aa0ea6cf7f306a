// Evidence and posterior of the standard problems of Bayesian inference, from integrate_log and the density
// that it trains: Gaussian shells and the eggbox of Feroz, Hobson, Bridges 2009, "MultiNest".
#include "test/mc/integrate/trained/trained_problems.h"
#include "test/significance.h"
#include <gtest/gtest.h>

#include "montelux/mc/integrate/cubature/cubature.h"
#include "montelux/mc/integrate/integrate_log.h"
#include "montelux/mc/integrate/trained/samples.h"
#include "montelux/mc/stats/z_test.h"

namespace montelux {
namespace {

constexpr double shell_radius = 2, shell_width = 0.1, half_width = 6;

// Likelihood of two shells around +-3.5 on the first axis, with the uniform prior of the box.
double log_shells(std::span<const double> x) {
    double rest = 0;
    for (std::size_t d = 1; d < x.size(); ++d) rest += x[d] * x[d];
    const auto shell = [&](double centre) {
        const double r = std::sqrt((x[0] - centre) * (x[0] - centre) + rest) - shell_radius;
        return -0.5 * r * r / (shell_width * shell_width) - std::log(std::sqrt(2 * pi) * shell_width);
    };
    const double a = shell(-3.5), b = shell(3.5), larger = std::max(a, b);
    return larger + std::log(std::exp(a - larger) + std::exp(b - larger)) -
           static_cast<double>(x.size()) * std::log(2 * half_width);
}
Domain shell_box(int dimensions) {
    return Domain(std::vector<Range>(static_cast<std::size_t>(dimensions), {-half_width, half_width}));
}
// Both shells by one integral over the radius.
double shell_evidence(int n) {
    const double area = 2 * std::exp(0.5 * n * std::log(pi) - std::lgamma(0.5 * n));
    const auto f = [&](double r) { return std::pow(r, n - 1) * bell(r, shell_radius, shell_width); };
    const double radial =
        integrate(f, Domain::interval(1, 3), Cubature{}, {.relative_error = 1e-10}).value[0];
    return std::log(2 * area * radial) - n * std::log(2 * half_width);
}

double log_eggbox(std::span<const double> x) {
    return std::pow(2 + std::cos(x[0] / 2) * std::cos(x[1] / 2), 5) - 2 * std::log(10 * pi);
}
const Domain egg_box{{0, 10 * pi}, {0, 10 * pi}};
double eggbox_evidence() {
    return integrate_log(log_eggbox, egg_box, Cubature{}, {.relative_error = 1e-6}).log_value;
}

TEST(Posterior, EvidenceOfGaussianShells) {
    for (int n : {2, 5, 10}) {
        const auto r = integrate_log(log_shells, shell_box(n), Adaptive{},
                                     {.evaluations = n < 10 ? 200'000u : 1'000'000u});
        EXPECT_LT(std::abs(r.log_value - shell_evidence(n)), 3 * r.log_error) << n << " variables";
        EXPECT_LT(r.log_error, n < 10 ? 0.01 : 0.05) << n << " variables";
        RecordProperty("shells_" + std::to_string(n), std::to_string(r.log_value) + " +- " +
                                                          std::to_string(r.log_error) + " exact " +
                                                          std::to_string(shell_evidence(n)));
    }
}

TEST(Posterior, EvidenceOfTheEggbox) {
    const double exact = eggbox_evidence();
    EXPECT_NEAR(exact, 235.856, 0.01); // published; the prior's density is 1 over the area
    const auto r = integrate_log(log_eggbox, egg_box, Adaptive{}, {.evaluations = 200'000});
    EXPECT_LT(std::abs(r.log_value - exact), 3 * r.log_error);
    EXPECT_LT(r.log_error, 0.01);
}

// log Z with its error, and means of the coordinates over weighted and over unweighted samples of the posterior, with
// the errors that the effective sample size gives.
void expect_calibrated(const Integrand& log_f, const Domain& domain, std::uint64_t evaluations, double log_z,
                       const std::vector<double>& truth) {
    std::vector<double> evidence, weighted, unweighted;
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
        const auto r = integrate_log(log_f, domain, Adaptive{}, {.evaluations = evaluations},
                                     {.seed = seed, .threads = 1});
        evidence.push_back((r.log_value - log_z) / r.log_error);
        const auto& density = r.relative.density;
        UnweightingOptions options;
        options.seed = seed;
        options.form = IntegrandForm::logarithm;
        options.pilot = 8192;
        const Samples all[] = {weighted_samples(*density, log_f, 8000, options),
                               unweighted_samples(*density, log_f, 2000, options)};
        for (int kind = 0; kind < 2; ++kind) {
            const Samples& s = all[kind];
            for (std::size_t d = 0; d < truth.size(); ++d) {
                const auto at = [&](std::size_t i) { return s.x.view()(i, static_cast<int>(d)); };
                double sum = 0, mean = 0, spread = 0;
                for (std::size_t i = 0; i < s.count(); ++i) sum += s.weight[i];
                for (std::size_t i = 0; i < s.count(); ++i) mean += s.weight[i] / sum * at(i);
                for (std::size_t i = 0; i < s.count(); ++i)
                    spread += std::pow(s.weight[i] / sum * (at(i) - mean), 2);
                (kind == 0 ? weighted : unweighted).push_back((mean - truth[d]) / std::sqrt(spread));
            }
        }
    }
    for (const auto* z : {&evidence, &weighted, &unweighted}) {
        const TestResult result = calibration_test(*z);
        EXPECT_TRUE(result.passes(significance)) << result.description;
        RunningMoments mean;
        for (double v : *z) mean.add(v);
        const TestResult bias = unbiasedness_test(mean, 0);
        EXPECT_TRUE(bias.passes(significance)) << bias.description;
    }
}

TEST(PosteriorSlowTest, EvidenceAndMeansOfShellsAndEggboxAreCalibrated) {
    const auto shells = [](int n, std::uint64_t evaluations) {
        expect_calibrated(log_shells, shell_box(n), evaluations, shell_evidence(n),
                          std::vector<double>(static_cast<std::size_t>(n), 0.0));
    };
    shells(2, 60'000);
    shells(5, 300'000);
    expect_calibrated(log_eggbox, egg_box, 60'000, eggbox_evidence(), {5 * pi, 5 * pi});
}
TEST(PosteriorSlowTest, EvidenceAndMeansOfShellsInTenVariablesAreCalibrated) {
    expect_calibrated(log_shells, shell_box(10), 1'000'000, shell_evidence(10), std::vector<double>(10, 0.0));
}

// A density that was trained on too little says so.
TEST(Posterior, SamplesOfAPoorDensityAreWarnedOf) {
    const auto density =
        integrate_log(log_shells, shell_box(10), Adaptive{}, {.evaluations = 60'000}).relative.density;
    SamplingOptions options;
    options.form = IntegrandForm::logarithm;
    const Samples s = weighted_samples(*density, log_shells, 5000, options);
    ASSERT_FALSE(s.warnings.empty());
    EXPECT_NE(s.warnings.back().find("are worth"), std::string::npos);
}

} // namespace
} // namespace montelux
