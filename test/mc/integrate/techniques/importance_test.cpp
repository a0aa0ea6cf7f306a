// A3, A4: general Monte Carlo and importance sampling.
#include "test/mc/integrate/estimator_checks.h"
#include <array>
#include <gtest/gtest.h>

#include "montelux/mc/dist/families.h"
#include "montelux/mc/dist/marginal_conditional.h"
#include "montelux/mc/integrate/techniques/importance.h"
#include "montelux/mc/integrate/unit_points.h"
#include "montelux/mc/math/constants.h"

namespace montelux {
namespace {

const auto sin_x = [](double x) { return std::sin(x); };
const Domain quarter_wave = Domain::interval(0, pi / 2);

TEST(Importance, AnyDensityGivesTheSameIntegral) {
    for (const Technique& p :
         {Technique(UniformDistribution(0, pi / 2)), Technique(LinearDistribution(0, pi / 2)),
          // Wider than the domain: what falls outside counts as zero.
          Technique(ExponentialDistribution(0.5)), Technique(UniformDistribution(-1, 3))})
        expect_unbiased_and_calibrated({sin_x, quarter_wave, {1}}, Importance{p}, {.evaluations = 4000},
                                       1000);
    // x = 2 arcsin(u) / pi and its arcsine density, which is infinite at an end.
    const Technique arcsine = Technique::functions([](double u) { return std::sin(pi / 2 * u); },
                                                   [](double x) { return 2 / pi / std::sqrt(1 - x * x); });
    expect_unbiased_and_calibrated({[](double x) { return 1 / std::sqrt(1 - x); }, Domain::unit_cube(1), {2}},
                                   Importance{arcsine}, {.evaluations = 2000}, 1000);
}

TEST(Importance, SobolPointsAreUnbiasedCalibratedAndMuchBetter) {
    const KnownIntegral problem{sin_x, quarter_wave, {1}};
    const Technique p = LinearDistribution(0, pi / 2);
    expect_unbiased_and_calibrated(problem, Importance{p, ImportancePoints::sobol}, {.evaluations = 4000},
                                   1000, 14);
    auto error = [&](ImportancePoints points) {
        return integrate(sin_x, quarter_wave, Importance{p, points}, {.evaluations = 20000})
            .standard_error[0];
    };
    EXPECT_LT(error(ImportancePoints::sobol), 0.01 * error(ImportancePoints::random));
}

TEST(Importance, AllFormsOfATechniqueAgree) {
    // Integral of cos x * 2y^2 over [0, pi/2) x [0, 1) = 2/3 by p = cos x * 2y.
    auto f = [](std::span<const double> x) { return std::cos(x[0]) * 2 * x[1] * x[1]; };
    const Domain domain({{0, pi / 2}, {0, 1}});
    const CosineDistribution cosine;
    const LinearDistribution linear;
    const Technique forms[] = {
        ProductDistribution{cosine, linear}, std::vector<Distribution>{cosine, linear},
        RuntimeProduct<Distribution>({cosine, linear}),
        Technique::functions(
            2, 2,
            [=](std::span<const double> u, std::span<double> x) {
                x[0] = cosine.sample(u[0]);
                x[1] = linear.sample(u[1]);
            },
            [=](std::span<const double> x) { return cosine.pdf(x[0]) * linear.pdf(x[1]); }),
        Technique::batch(
            2, 2,
            [=](const PointBatch& u, PointBuffer& x) {
                for (std::size_t i = 0; i < u.count(); ++i) {
                    x(i, 0) = cosine.sample(u(i, 0));
                    x(i, 1) = linear.sample(u(i, 1));
                }
            },
            [=](const PointBatch& x, std::span<double> p) {
                for (std::size_t i = 0; i < p.size(); ++i) p[i] = cosine.pdf(x(i, 0)) * linear.pdf(x(i, 1));
            })};
    std::vector<double> values;
    for (const Technique& t : forms) {
        const IntegrationResult r = integrate(f, domain, Importance{t}, {.evaluations = 50000}, {.seed = 2});
        const TestResult test = unbiasedness_test(r.estimate(), 2 / 3.0);
        EXPECT_TRUE(test.passes(significance)) << test.description;
        EXPECT_LT(r.standard_error[0], 0.002);
        EXPECT_TRUE(r.warnings.empty());
        values.push_back(r.value[0]);
    }
    for (double v : values) EXPECT_NEAR(v, values[0], 1e-13);
}

TEST(Importance, MarginalConditionalDrawsDependentVariables) {
    // Integral of x e^-y over the triangle 0 <= y < x < 1 = 1/2 - (1 - 2/e), drawn by p(x) = 2x, p(y | x) =
    // 1/x.
    const MarginalConditional triangle(LinearDistribution(),
                                       [](double x) { return UniformDistribution(0, x); });
    auto f = [](std::span<const double> x) { return x[1] < x[0] ? x[0] * std::exp(-x[1]) : 0; };
    const IntegrationResult r =
        integrate(f, Domain::unit_cube(2), Importance{triangle}, {.evaluations = 50000}, {.seed = 5});
    const TestResult test = unbiasedness_test(r.estimate(), 2 / std::exp(1.0) - 0.5);
    EXPECT_TRUE(test.passes(significance)) << test.description;
    EXPECT_LT(r.standard_error[0], 0.001);
    EXPECT_TRUE(r.warnings.empty());

    // Three variables: the same with z uniform on [0, x + y) behind them; the volume of where it can be.
    const MarginalConditional chain(
        triangle, [](const std::array<double, 2>& v) { return UniformDistribution(0, v[0] + v[1]); });
    auto inside = [](std::span<const double> x) { return x[1] < x[0] && x[2] < x[0] + x[1] ? 1.0 : 0.0; };
    const IntegrationResult volume = integrate(inside, Domain{{0, 1}, {0, 1}, {0, 2}}, Importance{chain},
                                               {.evaluations = 50000}, {.seed = 6});
    const TestResult volume_test = unbiasedness_test(volume.estimate(), 0.5);
    EXPECT_TRUE(volume_test.passes(significance)) << volume_test.description;
}

TEST(Importance, PerfectDensityHasNoVariance) {
    const IntegrationResult r = integrate([](double x) { return 3 * std::cos(x); }, quarter_wave,
                                          Importance{CosineDistribution()}, {.evaluations = 1000});
    EXPECT_NEAR(r.value[0], 3, 1e-13);
    // Half of the rule of three: all values equal.
    EXPECT_NEAR(r.standard_error[0], 1.5 * 3 / 970, 2e-4);
}

TEST(Importance, InfiniteDomainsAndUniformTechniques) {
    // 5 e^-5x over [0, inf) by a density of another rate.
    expect_unbiased_and_calibrated(
        {[](double x) { return 5 * std::exp(-5 * x); }, Domain::interval(0, INFINITY), {1}},
        Importance{ExponentialDistribution(4)}, {.evaluations = 2000}, 1000);
    const Domain box({{-1, 2}, {0, 5}});
    const IntegrationResult r = integrate([](std::span<const double>) { return 2.0; }, box,
                                          Importance{Technique::uniform(box)}, {.evaluations = 1000});
    EXPECT_NEAR(r.value[0], 30, 1e-12);
    EXPECT_THROW(Technique::uniform(Domain::interval(0, INFINITY)), Error);
}

TEST(Importance, DensityThatMissesTheIntegrandIsFoundByProbes) {
    const IntegrationResult good =
        integrate(sin_x, quarter_wave, Importance{LinearDistribution(0, pi / 2)}, {.evaluations = 20000});
    EXPECT_TRUE(good.warnings.empty());
    const IntegrationResult r =
        integrate(sin_x, quarter_wave, Importance{LinearDistribution(0, 1)}, {.evaluations = 20000});
    ASSERT_EQ(r.warnings.size(), 1u);
    EXPECT_FALSE(r.converged());
    EXPECT_NE(r.warnings[0].find("density is zero at (1."), std::string::npos) << r.warnings[0];
    EXPECT_NE(r.warnings[0].find("missing, about 0.5"), std::string::npos)
        << "cos 1 = 0.54: " << r.warnings[0];
    EXPECT_NEAR(r.value[0], 1 - std::cos(1), 5 * r.standard_error[0]) << "what the density can see";
    const Method blind = Importance{LinearDistribution(0, 1), ImportancePoints::random, false};
    EXPECT_TRUE(integrate(sin_x, quarter_wave, blind, {.evaluations = 20000}).warnings.empty());
    // Where only the tails of the density underflow, nothing that could be seen is missing.
    const auto wide = [](std::span<const double> x) { return std::exp(-x[0] * x[0] / 3); };
    const Domain line = Domain::interval(-INFINITY, INFINITY);
    const IntegrationResult tails =
        integrate(wide, line, Importance{NormalDistribution()}, {.evaluations = 50000});
    EXPECT_TRUE(tails.warnings.empty()) << tails;
    EXPECT_NEAR(tails.value[0], std::sqrt(3 * pi), 5 * tails.standard_error[0]);
    // One of two components that is not covered is enough, whichever it is.
    for (std::size_t covered : {0u, 1u}) {
        const auto two = Integrand::vector_valued(2, [=](std::span<const double> x, std::span<double> y) {
            y[covered] = x[0] < 1 ? std::sin(x[0]) : 0;
            y[1 - covered] = std::sin(x[0]);
        });
        EXPECT_EQ(integrate(two, quarter_wave, Importance{LinearDistribution(0, 1)}, {.evaluations = 20000})
                      .warnings.size(),
                  1u)
            << covered;
    }
    // A sampler that contradicts its density is counted.
    const Technique wrong =
        Technique::functions([](double u) { return u; }, [](double x) { return x < 0.5 ? 2.0 : 0.0; });
    EXPECT_GT(
        integrate([](double) { return 1.0; }, Domain::unit_cube(1), Importance{wrong}, {.evaluations = 1000})
            .non_finite,
        400u);
}

TEST(Importance, MistakesGiveAMessage) {
    auto density = [](double p) {
        return Importance{Technique::functions([](double u) { return u; }, [p](double) { return p; })};
    };
    auto message = [](const Integrand& f, const Domain& domain, const Method& m) -> std::string {
        try {
            integrate(f, domain, m, {.evaluations = 1000});
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    };
    const Domain line = Domain::unit_cube(1);
    EXPECT_NE(message(sin_x, line, density(-1)).find("density is -1 at (0."), std::string::npos);
    EXPECT_NE(message(sin_x, line, density(std::nan(""))).find("nan at (0."), std::string::npos);
    EXPECT_NE(message([](std::span<const double>) { return 1.0; }, Domain::unit_cube(3),
                      Importance{UniformDistribution()})
                  .find("1 dimensions, but the domain has 3"),
              std::string::npos);
    EXPECT_THROW(Technique(std::vector<Distribution>{}), Error);
    EXPECT_THROW(Technique::functions({}, [](double) { return 1.0; }), Error);
}

TEST(Importance, KeepsPromises) {
    const Technique p =
        std::vector<Distribution>{UniformDistribution(-0.2, 1.3), ExponentialDistribution(0.5)};
    const Technique cube = Technique::uniform(Domain::unit_cube(2));
    for (ImportancePoints points : {ImportancePoints::random, ImportancePoints::sobol}) {
        expect_same_bits_for_any_threads(two_components(), Importance{p, points}, 30000);
        expect_same_bits_after_resume(two_components(), Importance{p, points}, 30000);
        expect_non_finite_counted(Domain::unit_cube(2), Importance{cube, points}, 30000);
        expect_unbiased_and_calibrated(two_components(), Importance{p, points}, {.evaluations = 2000}, 300,
                                       points == ImportancePoints::sobol ? 14 : 0);
    }
}

// A4: the race of p0 = 2/pi against p1 = 8x/pi^2 on the integral of sin x, with the same xi.
TEST(Importance, TheRaceHasTheVariancesOfTheClosedForm) {
    const double v0 = pi * pi / 8 - 1;
    const double v1 = pi * pi / 16 * (euler_gamma + std::log(pi) - cosine_integral(pi)) - 1;
    EXPECT_NEAR(v0, 0.23370, 5e-6);
    EXPECT_NEAR(v1, 0.01674, 5e-6);
    EXPECT_NEAR(v0 / v1, 13.96, 5e-3);

    constexpr std::uint64_t n = 400000;
    const Technique techniques[] = {UniformDistribution(0, pi / 2), LinearDistribution(0, pi / 2)};
    const double variances[] = {v0, v1};
    PointBuffer xi(n, 1), x;
    fill_random(xi, 4, 0, 0);
    double measured[2], relative_square = 0;
    for (int k = 0; k < 2; ++k) {
        std::vector<double> p(n);
        techniques[k].sample(xi, x);
        techniques[k].density(x, p);
        RunningMoments values, squares;
        for (std::uint64_t i = 0; i < n; ++i) {
            const double xk = k == 0 ? pi / 2 * xi(i, 0) : pi / 2 * std::sqrt(xi(i, 0));
            ASSERT_NEAR(x(i, 0), xk, 1e-14);
            const double y = std::sin(xk) / p[i];
            values.add(y);
            squares.add((y - 1) * (y - 1)); // deviations from the known mean: their error is known too
        }
        const TestResult test = unbiasedness_test(squares, variances[k]);
        EXPECT_TRUE(test.passes(significance)) << test.description;
        relative_square += std::pow(squares.standard_error() / variances[k], 2);
        // The estimator draws these very numbers.
        const IntegrationResult r =
            integrate(sin_x, quarter_wave, Importance{techniques[k], ImportancePoints::random, false},
                      {.evaluations = n}, {.seed = 4});
        EXPECT_NEAR(r.value[0], values.mean(), 1e-12);
        measured[k] = r.standard_error[0] * r.standard_error[0] * n;
        EXPECT_NEAR(measured[k] / values.variance(), 1, 1e-9);
    }
    EXPECT_NEAR(measured[0] / measured[1], 13.96, 5 * 13.96 * std::sqrt(relative_square) + 0.005);
}

} // namespace
} // namespace montelux
