#include "test/significance.h"
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <limits>
#include <vector>

#include "montelux/mc/integrate/adaptive/monotone_map.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/stats/chi_squared.h"

namespace montelux {
namespace {

// Neighbours joined, neighbours that jump, a bin alone, steep ends.
std::vector<MonotoneMap> maps() {
    return {MonotoneMap(), MonotoneMap({0, 0.3, 1}, {2, 1}), MonotoneMap({0, 0.37, 0.4, 1}, {1, 0.08, 1e-3}),
            MonotoneMap({0, 0.25, 0.5, 0.75, 1}, {1, 3, 9, 1}),
            MonotoneMap({0, 0.01, 0.5, 0.51, 0.999, 1}, {0.9, 1e-5, 20, 0.1, 0.3})};
}

double integral(const std::function<double(double)>& f, double a, double b, int panels = 2000) {
    double sum = f(a) + f(b); // Simpson's rule
    for (int i = 1; i < 2 * panels; ++i) sum += (i % 2 == 1 ? 4 : 2) * f(a + (b - a) * i / (2.0 * panels));
    return sum * (b - a) / (6.0 * panels);
}

TEST(MonotoneMap, BinsHaveTheirMasses) {
    const std::vector<double> edges{0, 0.1, 0.35, 0.4, 1}, masses{1, 3, 6, 10};
    const MonotoneMap map(edges, masses);
    EXPECT_EQ(map.bins(), 4);
    double u = 0;
    for (std::size_t k = 0; k < masses.size(); ++k) {
        // Just inside the bin, since the density may jump at its ends.
        const double inside = 1e-12;
        EXPECT_NEAR(integral([&](double x) { return map.pdf(x); }, edges[k] + inside, edges[k + 1] - inside),
                    masses[k] / 20, 1e-8);
        u += masses[k] / 20;
        if (k + 1 < masses.size()) {
            EXPECT_NEAR(map.quantile(u), edges[k + 1], 1e-14);
        }
    }
}

TEST(MonotoneMap, DensityIsTheInverseOfTheQuantilesSlope) {
    for (const MonotoneMap& map : maps()) {
        double before = 0;
        for (int i = 0; i < 1000; ++i) {
            const double u = (i + 0.5) / 1000, h = 1e-8, x = map.quantile(u);
            EXPECT_GT(x, before);
            before = x;
            const double slope = (map.quantile(u + h) - map.quantile(u - h)) / (2 * h);
            EXPECT_NEAR(map.pdf(x) * slope, 1, 1e-4) << "bins " << map.bins() << ", u " << u;
        }
    }
}

TEST(MonotoneMap, SamplesComeWithTheirDensity) {
    for (const MonotoneMap& map : maps()) {
        std::vector<double> u, x(999), density(999, 2.0), other(999, 3.0);
        for (int i = 1; i < 1000; ++i) u.push_back(i / 1000.0 + 1e-5);
        map.sample(u, x, density);
        map.multiply_pdf(x, other);
        for (std::size_t i = 0; i < u.size(); ++i) {
            EXPECT_EQ(x[i], map.quantile(u[i]));
            EXPECT_NEAR(density[i], 2 * map.pdf(x[i]), 1e-9 * density[i]);
            EXPECT_EQ(other[i], 3 * map.pdf(x[i]));
        }
    }
}

TEST(MonotoneMap, SamplesFollowTheDensity) {
    for (const MonotoneMap& map : maps()) {
        const TestResult r = interval_chi_squared_test([&](double u) { return map.quantile(u); },
                                                       [&](double x) { return map.pdf(x); }, 0, 1,
                                                       {.samples = 100'000, .cells_x = 100});
        EXPECT_TRUE(r.passes(significance / 5)) << "bins " << map.bins() << ": " << r.description;
    }
}

TEST(MonotoneMap, ContinuousBetweenBinsUnlessTheyDifferMuch) {
    const MonotoneMap joined({0, 0.4, 1}, {1, 4}), apart({0, 0.4, 1}, {1, 40});
    const double h = 1e-9;
    EXPECT_NEAR(joined.pdf(0.4 - h), joined.pdf(0.4 + h), 1e-6);
    EXPECT_GT(apart.pdf(0.4 + h), 10 * apart.pdf(0.4 - h));
}

TEST(MonotoneMap, NeverZeroNorOutsideTheOpenInterval) {
    for (const MonotoneMap& map : maps()) {
        for (int i = 0; i <= 10'000; ++i) {
            const double p = map.pdf(i / 10'000.0);
            EXPECT_GT(p, 0);
            EXPECT_TRUE(std::isfinite(p));
        }
        for (double u : {0.0, std::numeric_limits<double>::denorm_min(), 1 - 0x1p-53, 1.0}) {
            EXPECT_GT(map.quantile(u), 0);
            EXPECT_LT(map.quantile(u), 1);
        }
    }
}

TEST(MonotoneMap, SavedMapHasTheSameBits) {
    for (const MonotoneMap& map : maps()) {
        StateWriter saved;
        map.save(saved);
        StateReader reader({saved.words().begin(), saved.words().end()});
        const MonotoneMap loaded = MonotoneMap::load(reader);
        EXPECT_TRUE(reader.at_end());
        for (int i = 0; i < 1000; ++i) {
            EXPECT_EQ(loaded.quantile(i / 1000.0), map.quantile(i / 1000.0));
            EXPECT_EQ(loaded.pdf(i / 1000.0), map.pdf(i / 1000.0));
        }
    }
}

TEST(MonotoneMap, RefusesBinsThatMakeNoMap) {
    using V = std::vector<double>;
    EXPECT_THROW(MonotoneMap(V{0, 1}, V{}), Error);
    EXPECT_THROW(MonotoneMap(V{0, 0.5, 1}, V{1}), Error);
    EXPECT_THROW(MonotoneMap(V{0.1, 1}, V{1}), Error);
    EXPECT_THROW(MonotoneMap(V{0, 0.9}, V{1}), Error);
    EXPECT_THROW(MonotoneMap(V{0, 0.5, 0.5, 1}, V{1, 1, 1}), Error);
    EXPECT_THROW(MonotoneMap(V{0, 0.5, 1}, V{1, 0}), Error);
    EXPECT_THROW(MonotoneMap(V{0, 0.5, 1}, V{1, std::nan("")}), Error);
    EXPECT_THROW(MonotoneMap(V{0, 0.5, 1}, V{1, std::numeric_limits<double>::infinity()}), Error);
}

// The map fitted to points weighted by f; one in each of equal cells, as the coordinates of Sobol' points
// are.
MonotoneMap fitted(const std::function<double(double)>& f, int points, const MapFit& settings = {}) {
    TestUniforms uniforms(3);
    std::vector<double> x, weights;
    for (int i = 0; i < points; ++i) {
        x.push_back((i + uniforms.next()) / points);
        weights.push_back(f(x.back()));
    }
    return fit_monotone_map(x, weights, settings);
}

TEST(FitMonotoneMap, RecoversDensities) {
    struct Case {
        std::function<double(double)> pdf;
        double distance; // integral of |fit - density|, at most; 2 is the greatest there is
    };
    const std::vector<Case> cases{
        {[](double) { return 1.0; }, 0.03},
        {[](double x) { return 2 * x; }, 0.06},
        {[](double x) { return 20 * std::exp(-20 * x) / (1 - std::exp(-20.0)); }, 0.06},
        {[](double x) {
             return (std::exp(-200 * (x - 0.3) * (x - 0.3)) + std::exp(-200 * (x - 0.7) * (x - 0.7))) /
                    (2 * std::sqrt(pi / 200));
         },
         0.12},
        {[](double x) { return x < 0.6 ? 0.15 : 2.275; }, 0.06}};
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const MonotoneMap map = fitted(cases[i].pdf, 20'000, {.bins = 32});
        const double distance =
            integral([&](double x) { return std::abs(map.pdf(x) - cases[i].pdf(x)); }, 0, 1);
        EXPECT_LT(distance, cases[i].distance) << "case " << i;
    }
}

TEST(FitMonotoneMap, JumpToZeroIsKeptWithAMargin) {
    const int points = 8000;
    const double jump = 0.37;
    for (bool falling : {true, false}) {
        auto on = [&](double x) { return falling ? x : 1 - x; };
        const MonotoneMap map = fitted([&](double x) { return on(x) < jump ? 1.0 : 0.0; }, points);
        // One point beyond the last that saw something is likely not to have been seen: the full density goes
        // on there.
        EXPECT_GT(map.pdf(on(jump)), 0.8 / jump);
        EXPECT_GT(map.pdf(on(jump + 2.0 / points)), 0.8 / jump);
        EXPECT_LT(map.pdf(on(jump + 100.0 / points)), 0.05);
        EXPECT_GT(map.pdf(on(0.99)), 0);
        // Little is wasted.
        double beyond = 0;
        const double from = jump + 1e-9;
        beyond = integral([&](double x) { return map.pdf(on(x)); }, from, 1 - 1e-9, 20'000);
        EXPECT_LT(beyond, 20.0 / points);
        EXPECT_NEAR(map.pdf(on(0.2)), 1 / jump, 0.1 / jump);
    }
}

// The denser side of a jump reaches beyond it: a sliver at the low density would hold rare and heavy points.
TEST(FitMonotoneMap, JumpBetweenDensitiesIsKeptWithAMargin) {
    constexpr double edge = 0.05, contrast = 300;
    int slivers = 0;
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
        for (bool mirrored : {false, true}) {
            TestUniforms uniforms(seed);
            std::vector<double> x(2048), weights;
            for (std::size_t i = 0; i < x.size(); ++i) {
                const double at = uniforms.next();
                weights.push_back(at < edge ? contrast : 1);
                x[i] = mirrored ? 1 - at : at;
            }
            const MonotoneMap map = fit_monotone_map(x, weights);
            const double inside = edge * (1 - 1e-6);
            slivers += map.pdf(mirrored ? 1 - inside : inside) < 0.2 / edge;
        }
    }
    // A margin of five mean distances is too short with a probability of e^-5 each.
    EXPECT_LE(slivers, 8);
}

TEST(FitMonotoneMap, NoiseIsNotFitted) {
    TestUniforms uniforms(8);
    const MonotoneMap map = fitted([&](double) { return -std::log(1 - uniforms.next()); }, 2000);
    for (int i = 0; i <= 100; ++i) {
        EXPECT_GT(map.pdf(i / 100.0), 0.4);
        EXPECT_LT(map.pdf(i / 100.0), 2.5);
    }
}

TEST(FitMonotoneMap, IdentityWhereNothingWasSeen) {
    const MonotoneMap map = fitted([](double) { return 0.0; }, 1000);
    EXPECT_EQ(map.bins(), 1);
    EXPECT_EQ(map.pdf(0.3), 1);
    EXPECT_EQ(fit_monotone_map({}, {}).bins(), 1);
}

TEST(FitMonotoneMap, BinsAreAtMostTheRequestedNumber) {
    auto f = [](double x) { return std::exp(-30 * x); };
    EXPECT_LE(fitted(f, 20'000, {.bins = 5}).bins(), 5);
    EXPECT_LE(fitted(f, 100, {.bins = 64, .points_per_bin = 24}).bins(), 4);
    EXPECT_GT(fitted(f, 20'000, {.bins = 64}).bins(), 8);
}

// x^-0.7: the power is found, and the density has no tail left at 0.
TEST(MonotoneMap, FollowsASingularityAtZero) {
    std::vector<double> x, weights;
    for (int i = 0; i < 4000; ++i) {
        x.push_back(std::pow((i + 0.5) / 4000, 2)); // drawn with the density 0.5 x^-0.5
        weights.push_back(std::pow(x.back(), -0.2));
    }
    const MonotoneMap map = fit_monotone_map(x, weights);
    for (double at : {1e-12, 1e-9, 1e-6, 1e-4}) {
        const double ratio = map.pdf(at) / (0.3 * std::pow(at, -0.7));
        EXPECT_GT(ratio, 0.3) << at;
        EXPECT_LT(ratio, 3) << at;
    }
    for (double u : {1e-6, 0.001, 0.1, 0.5, 0.99}) {
        std::vector<double> position(1), density{1.0};
        map.sample(std::vector<double>{u}, position, density);
        EXPECT_NEAR(density[0] / map.pdf(position[0]), 1, 1e-9) << u;
        const double h = 1e-4 * u; // the density is du / dx
        EXPECT_NEAR(2 * h / (map.quantile(u + h) - map.quantile(u - h)) / density[0], 1, 1e-3) << u;
    }
    std::vector<double> even;
    for (int i = 0; i < 4000; ++i) even.push_back((i + 0.5) / 4000);
    const MonotoneMap flat = fit_monotone_map(even, std::vector<double>(even.size(), 1.0));
    EXPECT_NEAR(flat.pdf(1e-9), 1, 0.2);
    EXPECT_THROW(MonotoneMap({0, 1}, {1}, 0), Error);
    EXPECT_THROW(MonotoneMap({0, 1}, {1}, 1.5), Error);
}

} // namespace
} // namespace montelux
