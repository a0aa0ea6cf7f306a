// Domains: points lie where they should, volumes and moments are exact.
#include "test/mc/integrate/integrate_testing.h"
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numeric>

#include "montelux/mc/integrate/basic_monte_carlo.h"
#include "montelux/mc/integrate/domain.h"
#include "montelux/mc/integrate/infinity.h"
#include "montelux/mc/integrate/integrate.h"
#include "montelux/mc/integrate/unit_points.h"
#include "montelux/mc/math/constants.h"

namespace montelux {
namespace {

using Point = std::span<const double>;
struct Moment {
    std::string name;
    std::function<double(Point)> f;
    double exact;
};

// Each moment within 6 standard errors (false alarm 2e-9), or within rounding where every value is the same.
void check_moments(const Domain& domain, const std::vector<Moment>& moments,
                   std::uint64_t evaluations = 40'000) {
    auto f = Integrand::vector_valued(static_cast<int>(moments.size()), [&](Point x, std::span<double> y) {
        for (std::size_t c = 0; c < y.size(); ++c) y[c] = moments[c].f(x);
    });
    const IntegrationResult r = integrate(f, domain, BasicMonteCarlo{}, {.evaluations = evaluations},
                                          {.seed = 1, .full_covariance = false});
    EXPECT_EQ(r.non_finite, 0u);
    for (std::size_t c = 0; c < moments.size(); ++c) {
        const double tolerance = 6 * r.standard_error[c] + 1e-12 * std::abs(moments[c].exact);
        EXPECT_NEAR(r.value[c], moments[c].exact, tolerance)
            << moments[c].name << " over " << domain.description();
    }
}

// Calls visit(x, |dx/du|) for points of the domain.
void visit_points(const Domain& domain, std::size_t count, const std::function<void(Point, double)>& visit) {
    PointBuffer u(count, domain.uniforms()), x(count, domain.dimensions());
    fill_random(u, 7, 0, 0);
    std::vector<double> volume(count, 1.0), point(static_cast<std::size_t>(domain.dimensions()));
    domain.map(u, x, volume);
    for (std::size_t i = 0; i < count; ++i) {
        x.view().gather(i, point.data());
        visit(point, volume[i]);
    }
}

double factorial(int n) { return std::tgamma(n + 1.0); }
double ball_volume(int n, double radius) {
    return std::pow(pi, 0.5 * n) / std::tgamma(0.5 * n + 1) * std::pow(radius, n);
}
std::vector<double> off_centre(int n) {
    std::vector<double> centre(static_cast<std::size_t>(n));
    for (std::size_t d = 0; d < centre.size(); ++d) centre[d] = 0.5 * static_cast<double>(d) - 1;
    return centre;
}
double square_distance(Point x, const std::vector<double>& centre) {
    double sum = 0;
    for (std::size_t d = 0; d < x.size(); ++d) sum += (x[d] - centre[d]) * (x[d] - centre[d]);
    return sum;
}

TEST(DomainBox, MomentsInOneToTenDimensions) {
    for (int n = 1; n <= 10; ++n) {
        std::vector<Range> ranges;
        double volume = 1;
        for (int d = 0; d < n; ++d) {
            ranges.push_back({-1.0 - d, 0.5 + d});
            volume *= 1.5 + 2 * d;
        }
        const Range& last = ranges.back();
        const double width = last.upper - last.lower, middle = 0.5 * (last.lower + last.upper);
        check_moments(Domain(ranges), {{"volume", [](Point) { return 1.0; }, volume},
                                       {"mean", [](Point x) { return x.back(); }, volume * middle},
                                       {"square", [](Point x) { return x.back() * x.back(); },
                                        volume * (middle * middle + width * width / 12)}});
        EXPECT_NEAR(Domain(ranges).constant_volume(), volume, 1e-12 * volume);
        visit_points(Domain(ranges), 1000, [&](Point x, double) {
            for (std::size_t d = 0; d < x.size(); ++d)
                ASSERT_TRUE(x[d] >= ranges[d].lower && x[d] <= ranges[d].upper);
        });
    }
}
TEST(DomainBox, HalfInfiniteRangesInOneToTenDimensions) {
    for (int n = 1; n <= 10; ++n) {
        // Odd variables from 2 up, even ones from -1 down; exponentials that are one at the finite end.
        std::vector<Range> ranges;
        for (int d = 0; d < n; ++d) ranges.push_back(d % 2 ? Range{-infinity, -1} : Range{2, infinity});
        auto decay = [](Point x) {
            double sum = 0;
            for (std::size_t d = 0; d < x.size(); ++d) sum += d % 2 ? -1 - x[d] : x[d] - 2;
            return std::exp(-sum);
        };
        check_moments(Domain(ranges),
                      {{"total", decay, 1},
                       {"mean", [=](Point x) { return x[0] * decay(x); }, 3},
                       {"square", [=](Point x) { return (x[0] - 2) * (x[0] - 2) * decay(x); }, 2}},
                      100'000);
        EXPECT_EQ(Domain(ranges).constant_volume(), 0);
    }
}
TEST(DomainBox, InfiniteRangesInOneToTenDimensions) {
    for (int n = 1; n <= 10; ++n) {
        const std::vector<Range> ranges(static_cast<std::size_t>(n), Range{-infinity, infinity});
        auto normal = [](Point x) {
            double sum = 0;
            for (double v : x) sum += v * v;
            return std::exp(-0.5 * sum) / std::pow(2 * pi, 0.5 * static_cast<double>(x.size()));
        };
        check_moments(Domain(ranges),
                      {{"total", normal, 1},
                       {"mean", [=](Point x) { return x.back() * normal(x); }, 0},
                       {"square", [=](Point x) { return x.back() * x.back() * normal(x); }, 1}},
                      200'000);
    }
}
TEST(DomainBox, SlowTailsAreBounded) {
    // 1 / x^2 and 1 / (1 + x^2): constant or nearly so after the map.
    check_moments(Domain({{1, infinity}}), {{"1/x^2", [](Point x) { return 1 / (x[0] * x[0]); }, 1}});
    check_moments(Domain({{-infinity, infinity}}),
                  {{"Cauchy", [](Point x) { return 1 / (1 + x[0] * x[0]); }, pi}});
}
TEST(DomainSimplex, MomentsInOneToTenDimensions) {
    for (int n = 1; n <= 10; ++n) {
        const Domain domain = Domain::simplex(n);
        EXPECT_EQ(domain.uniforms(), n);
        std::vector<Moment> moments{{"volume", [](Point) { return 1.0; }, 1 / factorial(n)}};
        for (std::size_t d : {std::size_t{0}, static_cast<std::size_t>(n - 1)}) {
            moments.push_back({"mean", [=](Point x) { return x[d]; }, 1 / factorial(n + 1)});
            moments.push_back({"square", [=](Point x) { return x[d] * x[d]; }, 2 / factorial(n + 2)});
        }
        if (n > 1) moments.push_back({"product", [](Point x) { return x[0] * x[1]; }, 1 / factorial(n + 2)});
        check_moments(domain, moments);
        visit_points(domain, 1000, [](Point x, double) {
            double sum = 0;
            for (double v : x) {
                ASSERT_GE(v, 0);
                sum += v;
            }
            ASSERT_LE(sum, 1 + 1e-12);
        });
    }
}
TEST(DomainBall, MomentsInOneToTenDimensions) {
    for (int n = 1; n <= 10; ++n) {
        const std::vector<double> centre = off_centre(n);
        const double radius = 1.5, volume = ball_volume(n, radius);
        const Domain domain = Domain::ball(centre, radius);
        std::vector<Moment> moments{{"volume", [](Point) { return 1.0; }, volume},
                                    {"radius squared", [&](Point x) { return square_distance(x, centre); },
                                     volume * radius * radius * n / (n + 2)}};
        for (std::size_t d = 0; d < centre.size(); ++d) {
            moments.push_back({"mean", [=](Point x) { return x[d]; }, volume * centre[d]});
            moments.push_back({"square",
                               [&centre, d](Point x) { return (x[d] - centre[d]) * (x[d] - centre[d]); },
                               volume * radius * radius / (n + 2)});
            if (d > 0)
                moments.push_back(
                    {"product",
                     [&centre, d](Point x) { return (x[d] - centre[d]) * (x[d - 1] - centre[d - 1]); }, 0});
        }
        check_moments(domain, moments);
        visit_points(domain, 1000, [&](Point x, double) {
            ASSERT_LE(square_distance(x, centre), radius * radius * (1 + 1e-12));
        });
    }
}
TEST(DomainSphere, MomentsInTwoToTenDimensions) {
    for (int n = 2; n <= 10; ++n) {
        const std::vector<double> centre = off_centre(n);
        const double radius = 0.7, area = n * ball_volume(n, radius) / radius;
        std::vector<Moment> moments{{"area", [](Point) { return 1.0; }, area}};
        for (std::size_t d = 0; d < centre.size(); ++d) {
            auto at = [&centre, d](Point x) { return x[d] - centre[d]; };
            moments.push_back({"mean", at, 0});
            moments.push_back(
                {"square", [at](Point x) { return at(x) * at(x); }, area * radius * radius / n});
            moments.push_back({"fourth", [at](Point x) { return std::pow(at(x), 4); },
                               area * 3 * std::pow(radius, 4) / (n * (n + 2.0))});
        }
        check_moments(Domain::sphere(centre, radius), moments);
        visit_points(Domain::sphere(centre, radius), 1000, [&](Point x, double) {
            ASSERT_NEAR(square_distance(x, centre), radius * radius, 1e-12);
        });
    }
}
TEST(DomainProduct, IsThePartsSideBySide) {
    // A disc, a half line and a triangle: 2 + 1 + 2 coordinates.
    const Domain domain = Domain::product(Domain::product(Domain::ball({0, 0}, 2), Domain({{0, infinity}})),
                                          Domain::simplex(2));
    EXPECT_EQ(domain.dimensions(), 5);
    EXPECT_EQ(domain.uniforms(), 5);
    const double parts = 4 * pi * 0.5;
    check_moments(domain,
                  {{"total", [](Point x) { return std::exp(-x[2]); }, parts},
                   {"disc", [](Point x) { return x[0] * x[0] * std::exp(-x[2]); }, parts * 1},
                   {"line", [](Point x) { return x[2] * std::exp(-x[2]); }, parts},
                   {"triangle", [](Point x) { return x[4] * std::exp(-x[2]); }, parts / 3}},
                  100'000);
    const Domain box = Domain::product(Domain({{0, 2}}), Domain({{1, 4}}));
    ASSERT_EQ(box.ranges().size(), 2u);
    EXPECT_EQ(box.ranges()[1].upper, 4);
    EXPECT_EQ(box.constant_volume(), 6);
    // One without a constant volume.
    const Domain finite = Domain::product(Domain::simplex(3), Domain::sphere({0, 0, 0}, 2));
    EXPECT_NEAR(finite.constant_volume(), 16 * pi / 6, 1e-12);
    EXPECT_EQ(Domain::product(finite, Domain({{0, infinity}})).constant_volume(), 0);
}
// Two uniform numbers for one coordinate, two for three, and one for one.
TEST(DomainProduct, EachPartTakesItsOwnUniformNumbers) {
    const auto decimal = [](std::span<const double> u, std::span<double> x) {
        x[0] = u[0] + 10 * u[1];
        return 1.0;
    };
    const Domain digits = Domain::mapped(2, 1, decimal, "digits"), sphere = Domain::sphere({0, 0, 0});
    const auto mapped = [](const Domain& domain, const std::vector<double>& numbers) {
        PointBuffer u(1, domain.uniforms()), x(1, domain.dimensions());
        EXPECT_EQ(static_cast<std::size_t>(domain.uniforms()), numbers.size());
        for (int d = 0; d < domain.uniforms(); ++d) u(0, d) = numbers[static_cast<std::size_t>(d)];
        double volume = 1;
        domain.map(u, x, {&volume, 1});
        std::vector<double> point;
        for (int d = 0; d < domain.dimensions(); ++d) point.push_back(x(0, d));
        return point;
    };
    const std::vector<double> direction = mapped(sphere, {0.375, 0.125});
    const std::vector<double> first =
        mapped(Domain::product(Domain::product(digits, sphere), Domain::interval(5, 6)),
               {0.25, 0.5, 0.375, 0.125, 0.75});
    ASSERT_EQ(first.size(), 5u);
    EXPECT_DOUBLE_EQ(first[0], 5.25);
    for (std::size_t d = 0; d < 3; ++d) EXPECT_DOUBLE_EQ(first[1 + d], direction[d]) << d;
    EXPECT_DOUBLE_EQ(first[4], 5.75);
    const std::vector<double> last =
        mapped(Domain::product(Domain::interval(5, 6), Domain::product(sphere, digits)),
               {0.75, 0.375, 0.125, 0.25, 0.5});
    ASSERT_EQ(last.size(), 5u);
    EXPECT_DOUBLE_EQ(last[0], 5.75);
    for (std::size_t d = 0; d < 3; ++d) EXPECT_DOUBLE_EQ(last[1 + d], direction[d]) << d;
    EXPECT_DOUBLE_EQ(last[4], 5.25);
}
TEST(DomainNames, AreThoseGivenElseXWithANumber) {
    const Domain plane = Domain::unit_cube(2);
    EXPECT_EQ(plane.name(1), "x2");
    EXPECT_EQ(Domain::interval(0, 1).name(0), "x");
    EXPECT_EQ(plane.named({"a", "b"}).name(1), "b");
    EXPECT_EQ(plane.named({"a", "b"}).dimensions(), 2);
    EXPECT_THROW(plane.named({"a"}), Error);
}

TEST(DomainMapped, PolarCoordinatesByPointAndByBatch) {
    auto point = [](std::span<const double> u, std::span<double> x) {
        x[0] = u[0] * std::cos(2 * pi * u[1]);
        x[1] = u[0] * std::sin(2 * pi * u[1]);
        return 2 * pi * u[0];
    };
    auto batch = [&](const PointBatch& u, PointBuffer& x, std::span<double> volume) {
        for (std::size_t i = 0; i < x.count(); ++i) {
            const double from[] = {u(i, 0), u(i, 1)};
            double to[2];
            volume[i] *= point(from, to);
            x(i, 0) = to[0];
            x(i, 1) = to[1];
        }
    };
    for (const Domain& domain :
         {Domain::mapped(2, 2, point, "disc"), Domain::mapped_batch(2, 2, batch, "disc")}) {
        EXPECT_EQ(domain.description(), "disc");
        check_moments(domain, {{"area", [](Point) { return 1.0; }, pi},
                               {"square", [](Point x) { return x[0] * x[0]; }, pi / 4},
                               {"product", [](Point x) { return x[0] * x[1]; }, 0}});
        EXPECT_NEAR(Domain::product(domain, domain).dimensions(), 4, 0);
        check_moments(Domain::product(domain, domain),
                      {{"four-volume", [](Point) { return 1.0; }, pi * pi},
                       {"second square", [](Point x) { return x[2] * x[2]; }, pi * pi / 4}});
    }
}
TEST(DomainLarge, TenThousandDimensions) {
    // The mean of the coordinates has expectation 1/2 and variance 1 / (12 n).
    const int n = 10'000;
    auto mean = [](Point x) {
        return std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size());
    };
    const IntegrationResult r =
        integrate(mean, Domain::unit_cube(n), BasicMonteCarlo{}, {.evaluations = 2000}, {.seed = 2});
    EXPECT_LT(std::abs(r.estimate().z_score(0.5)), 5.5);
    EXPECT_NEAR(r.standard_error[0], std::sqrt(1 / (12.0 * n * 2000)), 1e-5);
    // A direction in 300 dimensions by normal variables; the middle of the cube, which has none, too.
    PointBuffer u(1, 300), x(1, 300);
    for (int d = 0; d < 300; ++d) u(0, d) = 0.5;
    double volume = 1;
    Domain::sphere(std::vector<double>(300)).map(u, x, {&volume, 1});
    double square = 0;
    for (int d = 0; d < 300; ++d) square += x(0, d) * x(0, d);
    EXPECT_NEAR(square, 1, 1e-12);
}
TEST(DomainErrors, EachIsASentence) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    expect_error("range 2 is [1, 0]; expected a lower end below the upper one", [] {
        Domain({{0, 1}, {1, 0}});
    });
    expect_error("range 1 is [2, 2]", [] { Domain({{2, 2}}); });
    expect_error("range 1 is [nan, 1]; expected two numbers", [=] { Domain({{nan, 1}}); });
    expect_error("range 1 is [inf, inf]", [] { Domain({{infinity, infinity}}); });
    expect_error("width that is a finite number", [] { Domain({{-1.5e308, 1.5e308}}); });
    expect_error("at least 1 dimensions, got 0", [] { Domain(std::vector<Range>{}); });
    expect_error("at least 1 dimensions, got 0", [] { Domain::unit_cube(0); });
    expect_error("got -3", [] { Domain::simplex(-3); });
    expect_error("volume of the box", [] { Domain(std::vector<Range>(300, Range{0, 1e5})); });
    expect_error("at least 2 dimensions, got 1", [] { Domain::sphere({0}); });
    expect_error("finite radius above zero", [] { Domain::ball({0, 0}, 0); });
    expect_error("finite radius above zero", [=] { Domain::sphere({0, 0}, nan); });
    expect_error("centre of finite numbers", [] { Domain::ball({0, infinity}); });
    // Not a ball whose volume no double holds, without a word.
    expect_error("volume", [] { Domain::ball(std::vector<double>(2000), 1); });
    expect_error("volume", [] { Domain::simplex(1000); });
    expect_error("volume", [] { Domain::sphere(std::vector<double>(400), 1e10); });
}

} // namespace
} // namespace montelux
