#include <cmath>
#include <gtest/gtest.h>
#include <vector>

#include "montelux/mc/integrate/integrate.h"
#include "montelux/mc/integrate/witness/imprecise_mass.h"

namespace montelux {
namespace {

// Sets the rounding error of each component to a function of a point.
template <typename F>
Integrand::BatchFunction rounding_of(F f) {
    return [f](const PointBatch& x, ValueBatch y) {
        std::vector<double> point(static_cast<std::size_t>(x.dimensions()));
        for (std::size_t i = 0; i < x.count(); ++i) {
            x.gather(i, point.data());
            for (int c = 0; c < y.components(); ++c) y(i, c) = f(point);
        }
    };
}

using Point = std::span<const double>;

// Within four standard errors of the mean over 64 seeds; 8 cases: false alarms 5e-4 if the means were normal, none with
// these seeds.
TEST(ImpreciseMass, IsUnbiasedAtAllScales) {
    struct Case {
        Integrand f;
        Integrand::BatchFunction rounding;
        Domain domain;
        double exact;
        std::vector<std::vector<double>> landmarks = {};
    };
    const auto one = [](Point) { return 1.0; };
    const auto below = [](double size) {
        return rounding_of([=](Point x) {
            double product = 1;
            for (double u : x) product *= std::abs(u);
            return product < size ? 2.0 : 0.0;
        });
    };
    const double volume = 1e-8, logarithm = -std::log(volume);
    const std::vector<Case> cases = {
        {one, below(1e-6), Domain::unit_cube(1), 1e-6},
        {[](double x) { return 1 / std::sqrt(x); }, below(1e-8), Domain::interval(0, 1), 2e-4},
        {one, below(volume), Domain::unit_cube(2), volume * (1 + logarithm)},
        {one, below(volume), Domain::unit_cube(3), volume * (1 + logarithm + logarithm * logarithm / 2)},
        // At the origin inside, at a landmark, far out.
        {one, below(1e-7), Domain::interval(-1, 2), 2e-7},
        {one,
         rounding_of([](Point x) { return std::abs(x[0] - 0.3) < 1e-7 ? 1.0 : 0.0; }),
         Domain::unit_cube(1),
         2e-7,
         {{0.3}}},
        {[](double x) { return 1 / (x * x); }, rounding_of([](Point x) { return x[0] > 1e6 ? 1.0 : 0.0; }),
         Domain::interval(1, std::numeric_limits<double>::infinity()), 1e-6},
        // Where values are precise to two digits, their error counts.
        {one, rounding_of([](Point x) { return x[0] < 0.5 ? 1e-3 : 0.02; }), Domain::unit_cube(1),
         0.5 * 1e-3 + 0.5},
    };
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const Evaluator evaluator(cases[i].f.with_rounding(cases[i].rounding), cases[i].domain);
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
    const auto all_lost = rounding_of([](Point) { return 1.0; });
    const std::vector<double> mass =
        imprecise_mass(Evaluator(f.with_rounding(all_lost), Domain::unit_cube(1)), {}, 0);
    ASSERT_EQ(mass.size(), 2u);
    EXPECT_NEAR(mass[0], 1, 0.1);
    EXPECT_NEAR(mass[1], 1.5, 0.15);
    EXPECT_TRUE(imprecise_mass(Evaluator(Integrand([](Point) { return 1.0; }).with_rounding(all_lost),
                                         Domain::unit_cube(65)),
                               {}, 0)
                    .empty());
    const auto not_a_number = rounding_of([](Point) { return std::nan(""); });
    EXPECT_EQ(imprecise_mass(Evaluator(f.with_rounding(not_a_number), Domain::unit_cube(1)), {}, 0),
              std::vector<double>(2, 0.0));
}

} // namespace
} // namespace montelux
