#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <utility>
#include <vector>

#include "montelux/mc/integrate/integrate.h"
#include "montelux/mc/integrate/integrate_log.h"
#include "montelux/mc/integrate/witness/imprecise_mass.h"

namespace montelux {
namespace {

// The integrand, whose relative rounding error is a function of a point.
template <typename F>
Integrand with_relative(const Integrand& f, F error) {
    return f.with_rounding([f, error](const PointBatch& x, ValueBatch y) {
        ValueBuffer values(x.count(), f.components());
        f(x, values);
        std::vector<double> point(static_cast<std::size_t>(x.dimensions()));
        for (std::size_t i = 0; i < x.count(); ++i) {
            x.gather(i, point.data());
            for (int c = 0; c < f.components(); ++c) {
                const double value = std::as_const(values)(i, c), half = value * error(point);
                y(i, 2 * c) = value + half;
                y(i, 2 * c + 1) = value - half;
            }
        }
    });
}

using Point = std::span<const double>;

// Within four standard errors of the mean over 64 seeds; 8 cases: false alarms 5e-4 if the means were normal, none with
// these seeds.
TEST(ImpreciseMass, IsUnbiasedAtAllScales) {
    struct Case {
        Integrand f;
        Domain domain;
        double exact;
        std::vector<std::vector<double>> landmarks = {};
    };
    const Integrand one([](Point) { return 1.0; });
    const auto lost_below = [](const Integrand& f, double size) {
        return with_relative(f, [=](Point x) {
            double product = 1;
            for (double u : x) product *= std::abs(u);
            return product < size ? 2.0 : 0.0;
        });
    };
    const double volume = 1e-8, logarithm = -std::log(volume);
    const std::vector<Case> cases = {
        {lost_below(one, 1e-6), Domain::unit_cube(1), 1e-6},
        {lost_below([](double x) { return 1 / std::sqrt(x); }, 1e-8), Domain::interval(0, 1), 2e-4},
        {lost_below(one, volume), Domain::unit_cube(2), volume * (1 + logarithm)},
        {lost_below(one, volume), Domain::unit_cube(3), volume * (1 + logarithm + logarithm * logarithm / 2)},
        // At the origin inside, at a landmark, far out.
        {lost_below(one, 1e-7), Domain::interval(-1, 2), 2e-7},
        {with_relative(one, [](Point x) { return std::abs(x[0] - 0.3) < 1e-7 ? 1.0 : 0.0; }),
         Domain::unit_cube(1),
         2e-7,
         {{0.3}}},
        {with_relative([](double x) { return 1 / (x * x); }, [](Point x) { return x[0] > 1e6 ? 1.0 : 0.0; }),
         Domain::interval(1, std::numeric_limits<double>::infinity()), 1e-6},
        // Where values are precise to two digits, their error counts.
        {with_relative(one, [](Point x) { return x[0] < 0.5 ? 1e-3 : 0.02; }), Domain::unit_cube(1),
         0.5 * 1e-3 + 0.5},
    };
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const Evaluator evaluator(cases[i].f, cases[i].domain);
        constexpr int seeds = 64;
        double sum = 0, squares = 0;
        for (std::uint64_t seed = 0; seed < seeds; ++seed) {
            const double mass = imprecise_mass(evaluator, cases[i].landmarks, seed).at(0) / cases[i].exact;
            sum += mass;
            squares += mass * mass;
        }
        const double mean = sum / seeds, error = std::sqrt((squares / seeds - mean * mean) / seeds);
        EXPECT_NEAR(mean, 1, 4 * error) << i;
        EXPECT_LT(8 * error, 0.2) << i; // of one seed
    }
}

TEST(ImpreciseMass, OfEachComponentAndOnlyWhereRoundingIsKnown) {
    const Integrand f = Integrand::vector_valued(2, [](Point x, std::span<double> y) {
        y[0] = 1;
        y[1] = -3 * x[0];
    });
    EXPECT_TRUE(imprecise_mass(Evaluator(f, Domain::unit_cube(1)), {}, 0).empty());
    const auto all = [](double error) { return [=](Point) { return error; }; };
    const auto mass = [](const Integrand& g, int n = 1) {
        return imprecise_mass(Evaluator(g, Domain::unit_cube(n)), {}, 0);
    };
    const std::vector<double> lost = mass(with_relative(f, all(1)));
    ASSERT_EQ(lost.size(), 2u);
    EXPECT_NEAR(lost[0], 1, 0.1);
    EXPECT_NEAR(lost[1], 1.5, 0.15);
    EXPECT_TRUE(mass(with_relative([](Point) { return 1.0; }, all(1)), 65).empty());
    EXPECT_EQ(mass(with_relative(f, all(std::nan("")))), std::vector<double>(2, 0.0));
}

// Zeros by rounding in half of the range count with their errors, at most with the mean of imprecise values, or of all.
TEST(ImpreciseMass, OfZerosByRounding) {
    const auto mass = [](double other, double error_of_zeros, double error_of_others) {
        const Integrand f = Integrand([=](double x) {
                                return x < 0.5 ? 0 : other;
                            }).with_rounding([=](const PointBatch& x, ValueBatch y) {
            for (std::size_t i = 0; i < x.count(); ++i) {
                const bool zero = x(i, 0) < 0.5;
                y(i, 0) = zero ? 0 : other;
                y(i, 1) = zero ? error_of_zeros : other + error_of_others;
            }
        });
        return imprecise_mass(Evaluator(f, Domain::unit_cube(1)), {}, 0).at(0);
    };
    EXPECT_NEAR(mass(4, 0.01, 0), 0.005, 0.0005);
    EXPECT_NEAR(mass(4, 1e6, 0), 0.5 * 2, 0.1);
    EXPECT_NEAR(mass(4, 1e6, 1), 0.5 * 4 + 2, 0.3);
    EXPECT_NEAR(mass(0, 3, 0), 1.5, 0.15);
}

// A quarter of the integral of one component has no digits; scales of components do not matter.
TEST(ImpreciseMass, IsInTheErrorOfEveryMethod) {
    const auto f = [](double x, double y) { return std::array{1e30 * x, y}; };
    const Integrand plain = Integrand::vector_valued(2, [f](std::span<const double> x, std::span<double> y) {
        std::ranges::copy(f(x[0], x[0]), y.begin());
    });
    const auto rounded = [f](double relative) {
        return [f, relative](const PointBatch& x, ValueBatch y) {
            for (std::size_t i = 0; i < x.count(); ++i) {
                const double error = x(i, 0) < 0.5 ? relative : 0;
                const auto [big, small] = f(x(i, 0), x(i, 0));
                y(i, 0) = big * (1 - error);
                y(i, 1) = big * (1 + error);
                y(i, 2) = small;
                y(i, 3) = small * (1 + 1e-15);
            }
        };
    };
    for (const char* method : {"auto", "adaptive", "vegas", "quasi", "cubature", "basic"}) {
        const auto run = [&](const Integrand& g) {
            return integrate(g, Domain::unit_cube(1), Method::named(method),
                             {.relative_error = 1e-2, .evaluations = 100'000});
        };
        const IntegrationResult r = run(plain.with_rounding(rounded(1)));
        EXPECT_FALSE(r.converged()) << method;
        EXPECT_NEAR(r.standard_error[0], 0.125e30, 0.02e30) << method;
        EXPECT_LT(r.standard_error[1], 1e-2) << method;
        EXPECT_NE(to_string(r).find("loses by cancellation"), std::string::npos) << method;
        // One part in 1e-15 is no matter.
        const IntegrationResult known = run(plain.with_rounding(rounded(1e-15))), unknown = run(plain);
        EXPECT_TRUE(known.converged()) << method;
        EXPECT_EQ(known.value, unknown.value) << method;
        EXPECT_EQ(known.standard_error, unknown.standard_error) << method;
        EXPECT_EQ(known.evaluations, unknown.evaluations) << method;
    }
}

// A rounding function of 0.1 ms a point, of which 4096 would take four times the limit.
TEST(ImpreciseMass, TakesAPartOfTheTime) {
    const auto slow = [](double x) {
        const auto stop = std::chrono::steady_clock::now() + std::chrono::microseconds(100);
        while (std::chrono::steady_clock::now() < stop) {
        }
        return x;
    };
    const Integrand f = Integrand(slow).with_rounding([slow](const PointBatch& x, ValueBatch y) {
        for (std::size_t i = 0; i < x.count(); ++i) y(i, 0) = y(i, 1) = slow(x(i, 0));
    });
    const IntegrationResult r = integrate(f, Domain::unit_cube(1), Method(),
                                          {.relative_error = 1e-3, .time = std::chrono::milliseconds(100)});
    EXPECT_NEAR(r.value[0], 0.5, 1e-3);
}

// An error of 1 in a logarithm is a factor of e.
TEST(ImpreciseMass, OfLogarithmsIsThatOfTheIntegrand) {
    for (double error : {1.0, 1e-15}) {
        const Integrand log_f = Integrand([](double x) {
                                    return -2000 - x;
                                }).with_rounding([error](const PointBatch& x, ValueBatch y) {
            for (std::size_t i = 0; i < x.count(); ++i) {
                y(i, 0) = -2000 - x(i, 0) - error;
                y(i, 1) = -2000 - x(i, 0) + error;
            }
        });
        const LogIntegrationResult r =
            integrate_log(log_f, Domain::unit_cube(1), Method(), {.relative_error = 1e-3});
        EXPECT_EQ(r.relative.converged(), error < 1e-3) << error;
    }
}

} // namespace
} // namespace montelux
