#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "montelux/mc/integrate/infinity.h"
#include "montelux/mc/integrate/integrate.h"
#include "montelux/mc/integrate/integrate_log.h"
#include "montelux/mc/integrate/witness/first_look.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

FirstLook look_at(const Integrand& f, const Domain& domain, std::vector<std::vector<double>> landmarks = {}) {
    return first_look(Evaluator(f, domain), {.landmarks = landmarks, .seed = 1});
}

TEST(FirstLook, CostsLittleWhereNothingStandsOut) {
    const FirstLook look = look_at([](double x) { return std::sin(x); }, Domain::interval(0, 1.5));
    EXPECT_EQ(look.evaluations, 24u);
    EXPECT_TRUE(look.peaks.empty());
    EXPECT_TRUE(look.divergence.empty());
    const FirstLook three =
        look_at([](std::span<const double> x) { return x[0] + x[1] * x[2]; }, Domain::unit_cube(3));
    EXPECT_LT(three.evaluations, 400u);
}

TEST(FirstLook, FindsPeaksOfAnyWidthAtZeroAtEndsAndAtLandmarks) {
    for (double width : {1.0, 1e-3, 1e3}) {
        const FirstLook look = look_at([=](double x) { return std::exp(-x * x / (width * width)); },
                                       Domain::interval(-1e6, 1e6));
        ASSERT_EQ(look.peaks.size(), 1u) << width;
        // Half of its height at 0.83 widths on either side.
        EXPECT_NEAR(look.peaks[0].volume * 2e6 / width, 1.665, 1.0) << width;
    }
    EXPECT_EQ(look_at([](double x) { return std::exp(-1e4 * x); }, Domain::interval(0, 1)).peaks.size(), 1u);
    const auto shifted = [](double x) { return std::exp(-(x - 777) * (x - 777)); };
    EXPECT_TRUE(look_at(shifted, Domain::interval(-1e6, 1e6)).peaks.empty());
    EXPECT_EQ(look_at(shifted, Domain::interval(-1e6, 1e6), {{777}}).peaks.size(), 1u);
    const auto ball = [](std::span<const double> x) {
        double squares = 0;
        for (double v : x) squares += v * v;
        return std::exp(-squares);
    };
    for (int n : {2, 5})
        EXPECT_GE(
            look_at(ball, Domain(std::vector<Range>(static_cast<std::size_t>(n), {-1e4, 1e4}))).peaks.size(),
            1u);
}

TEST(FirstLook, TellsDivergenceAtEndsAndAtInfinity) {
    EXPECT_EQ(look_at([](double x) { return 1 / x; }, Domain::interval(0, 1)).divergence, "x -> 0");
    EXPECT_EQ(look_at([](double x) { return 1 / x; }, Domain::interval(0, 1).named({"t"})).divergence,
              "t -> 0");
    const auto line = [](std::span<const double> x) { return 1 / x[1]; };
    EXPECT_EQ(look_at(line, Domain::unit_cube(2)).divergence, "x2 -> 0");
    EXPECT_EQ(look_at(line, Domain::unit_cube(2).named({"x", "y"})).divergence, "y -> 0");
    // Far out x^4 overflows, and its quotients are zero or no numbers.
    EXPECT_EQ(look_at([](double x) { return x * x * x / (1 + x * x * x * x); }, Domain::interval(0, infinity))
                  .divergence,
              "x -> inf");
    EXPECT_EQ(look_at([](double x) { return 1 / (1 + x); }, Domain::interval(0, infinity)).divergence,
              "x -> inf");
    EXPECT_EQ(look_at([](double x) { return std::exp(x); }, Domain::interval(0, infinity)).divergence,
              "x -> inf");
    EXPECT_EQ(
        look_at([](double x) { return x / (1 + x * x); }, Domain::interval(-infinity, infinity)).divergence,
        "x -> -inf");
    EXPECT_FALSE(
        look_at([](std::span<const double> x) { return std::cos(x[0]) / x[1]; }, Domain::unit_cube(2))
            .divergence.empty());
    EXPECT_TRUE(
        look_at([](double x) { return std::pow(x, -0.99); }, Domain::interval(0, 1)).divergence.empty());
    EXPECT_TRUE(look_at([](double x) { return std::pow(1 + x, -1.1); }, Domain::interval(0, infinity))
                    .divergence.empty());
    EXPECT_TRUE(
        look_at([](std::span<const double> x) { return 1 / std::hypot(x[0], x[1]); }, Domain::unit_cube(2))
            .divergence.empty());
}

// The place is one of many landmarks, and has another coordinate in each variable.
TEST(FirstLook, FindsPeaksAtPointsOfLandmarks) {
    const std::vector<double> place{0.37, -0.61, 0.5, 1.2, -2.9};
    std::vector<std::vector<double>> landmarks{place};
    for (double v = 0.125; v < 1.6; v += 0.125) landmarks.emplace_back(5, v);
    for (int n : {5, 2}) {
        const auto d = static_cast<std::size_t>(n);
        for (auto& x : landmarks) x.resize(d);
        const auto f = [&](std::span<const double> x) {
            double squares = 0, from_place = 0;
            for (std::size_t i = 0; i < x.size(); ++i) {
                squares += x[i] * x[i];
                from_place += std::pow(x[i] - place[i], 2);
            }
            return std::exp(-squares / 2) + 1e5 * std::exp(-1e6 * from_place);
        };
        const FirstLook look = look_at(f, Domain(std::vector<Range>(d, {-5, 5})), landmarks);
        ASSERT_FALSE(look.peaks.empty()) << n;
        for (std::size_t i = 0; i < d; ++i) EXPECT_NEAR(look.peaks[0].u[i], (place[i] + 5) / 10, 1e-4) << n;
        EXPECT_LE(look.evaluations, LookSettings().most_evaluations) << n;
    }
    EXPECT_THROW(look_at([](std::span<const double> x) { return x[0]; }, Domain({{0, 1}, {0, 1}}), {{0.5}}),
                 Error);
}

// A lobe around a direction at which the azimuth begins and ends: half of it lies at either end.
TEST(FirstLook, FindsPeaksAtLandmarksOfShapes) {
    const auto lobe = [](std::span<const double> x) { return std::exp(1e6 * (0.6 * x[0] + 0.8 * x[1] - 1)); };
    const FirstLook look = look_at(lobe, Domain::sphere({0, 0, 0}), {{1.2, 1.6, 0}});
    ASSERT_EQ(look.peaks.size(), 2u);
    for (const Witness& peak : look.peaks) EXPECT_NEAR(peak.u[0], 0.2, 1e-3);
    EXPECT_NEAR(std::abs(look.peaks[0].u[1] - look.peaks[1].u[1]), 1, 1e-3);
    const auto inside = [](std::span<const double> x) {
        return 1 + 1e6 * std::exp(-1e6 * (std::pow(x[0] - 0.3, 2) + std::pow(x[1] + 0.5, 2) + x[2] * x[2]));
    };
    EXPECT_EQ(look_at(inside, Domain::ball({0, 0, 0}), {{0.3, -0.5, 0}}).peaks.size(), 1u);
    EXPECT_THROW(look_at(inside, Domain::ball({0, 0, 0}), {{0.3, -0.5}}), Error);
    EXPECT_EQ(look_at([](std::span<const double> x) { return 1 / (1 - x[2]); }, Domain::sphere({0, 0, 0}),
                      {{0, 0, 1}})
                  .divergence,
              "(x1, x2, x3) -> (0, 0, 1)");
}

// The search for the nearest point costs no more where a map has many variables.
TEST(FirstLook, LandmarksOfMapsOfManyVariablesCostNothing) {
    std::size_t mapped = 0;
    const auto domain = [&](int n) {
        return Domain::mapped(n, n, [&](std::span<const double> u, std::span<double> x) {
            std::ranges::copy(u, x.begin());
            ++mapped;
            return 1.0;
        });
    };
    const auto one = [](std::span<const double>) { return 1.0; };
    look_at(one, domain(2), {{0.3, 0.4}});
    EXPECT_GT(mapped, 300u);
    mapped = 0;
    const FirstLook look = look_at(one, domain(100), {std::vector<double>(100, 0.3)});
    EXPECT_LE(mapped, look.evaluations);
}

// A pole that holds little of the integral diverges all the same; a lobe that only rises from nothing does not.
TEST(FirstLook, TellsDivergenceOfAnySizeButOfRounding) {
    for (double power : {1.0, 0.99, 0.95}) {
        const auto pole = [=](double x) { return 1 + 1e-6 * std::pow(std::abs(x - 0.7), -power); };
        EXPECT_EQ(look_at(pole, Domain::interval(0, 1), {{0.7}}).divergence, power == 1 ? "x -> 0.7" : "");
    }
    for (int n : {4, 5}) {
        std::vector<double> direction(static_cast<std::size_t>(n), 0.0);
        direction[0] = 0.6;
        direction[3] = 0.8;
        const auto lobe = [&](std::span<const double> x) {
            return std::exp(1000 * (0.6 * x[0] + 0.8 * x[3] - 1));
        };
        const Evaluator sphere(Integrand(lobe), Domain::sphere(std::vector<double>(direction.size(), 0.0)));
        const std::vector<std::vector<double>> landmarks{direction};
        for (std::uint64_t seed = 0; seed < 20; ++seed)
            EXPECT_EQ(first_look(sphere, {.landmarks = landmarks, .seed = seed}).divergence, "") << seed;
    }
}

TEST(FirstLook, TellsDivergenceByOverflowAndBeforeValuesEnd) {
    EXPECT_EQ(look_at([](double x) { return std::exp(x * x); }, Domain::interval(0, infinity)).divergence,
              "x -> inf");
    const auto corner = [](std::span<const double> x) {
        double sum = 0;
        for (double v : x) sum += 1 - std::cos(v);
        return 1 / sum; // infinite at distances below 1e-8
    };
    EXPECT_FALSE(look_at(corner, Domain({{0, 3}, {0, 3}})).divergence.empty());
    EXPECT_TRUE(look_at(corner, Domain({{0, 3}, {0, 3}, {0, 3}})).divergence.empty());
}

// Numerators that are rounded to zero before the innermost shells, and values that end there in truth.
TEST(FirstLook, TellsDivergenceBeforeNumeratorsAreRounded) {
    const Domain unit = Domain::interval(0, 1);
    const auto cosine = [](double x) { return (1 - std::cos(x)) / (x * x * x); };
    const auto sine = [](double x) { return (x - std::sin(x)) / std::pow(x, 4); };
    EXPECT_EQ(look_at(cosine, unit).divergence, "x -> 0");
    EXPECT_EQ(look_at(sine, unit).divergence, "x -> 0");
    EXPECT_EQ(look_at([=](double x) { return cosine(std::abs(x - 0.3)); }, unit, {{0.3}}).divergence,
              "x -> 0.3");
    EXPECT_EQ(look_at([=](double x) { return x * cosine(x); }, unit).divergence, "");
    // Zero from the ladder's second shell on.
    const auto eighth = [](double x, double power) {
        return (1 - std::cos(std::pow(x, 8))) / std::pow(x, power);
    };
    EXPECT_EQ(look_at([=](double x) { return eighth(x, 17); }, unit).divergence, "x -> 0");
    const FirstLook convergent = look_at([=](double x) { return eighth(x, 16.5); }, unit);
    EXPECT_EQ(convergent.divergence, "");
    ASSERT_EQ(convergent.unresolved.size(), 1u);
    EXPECT_NEAR(convergent.unresolved[0], 0.32, 0.1);
    for (double cut : {1e-3, 1e-6, 1e-9, 1e-12})
        EXPECT_EQ(look_at([=](double x) { return x > cut ? 1 / x : 0; }, unit).divergence, "") << cut;
}

// The exponential's terms cancel to noise below 2^-26; what is seen there is no evidence.
TEST(FirstLook, NoiseIsNoEvidence) {
    const auto line = [](double x) { return (std::exp(x) - 1 - x) / std::pow(x, 2.9); };
    const FirstLook look = look_at(line, Domain::interval(0, 1));
    EXPECT_EQ(look.divergence, "");
    double nearest = 1;
    for (const Witness& w : look.witnesses) nearest = std::min(nearest, w.u[0]);
    EXPECT_GT(nearest, 0x1p-26);
    EXPECT_LT(nearest, 0x1p-16);
    ASSERT_EQ(look.noise.size(), 1u);
    EXPECT_EQ(look.noise[0].component, 0);
    EXPECT_EQ(look.noise[0].lower, std::vector<double>{0});
    EXPECT_NEAR(std::log2(look.noise[0].upper[0]), -26, 2);
    // The integral of 1 / (2 x^0.9) up to 2^-26 is 2^(-2.6) / 0.2.
    ASSERT_EQ(look.unresolved.size(), 1u);
    EXPECT_NEAR(look.unresolved[0], 0.82, 0.1);
    EXPECT_EQ(
        look_at([=](double x) { return line(x) / std::pow(x, 0.1); }, Domain::interval(0, 1)).divergence,
        "x -> 0");
    const auto far_out = [](double x) { return std::sqrt(x * x + 1) - x - 1 / (2 * x); };
    EXPECT_EQ(look_at(far_out, Domain::interval(1, infinity)).divergence, "");
    for (const auto& [power, place] : {std::pair(3.7, ""), std::pair(4.0, "x1 -> 0, x2 -> 0")}) {
        const auto corner = [power = power](std::span<const double> x) {
            const double sum = x[0] + x[1];
            return (std::exp(sum) - 1 - sum) / std::pow(sum, power);
        };
        EXPECT_EQ(look_at(corner, Domain::unit_cube(2)).divergence, place);
    }
}

// Numerators that are rounded to zero hide behind another term, on faces and edges, and in planes inside.
TEST(FirstLook, DigitsAreLostBesideOtherTermsAndOnFaces) {
    const Domain unit = Domain::interval(0, 1);
    const auto cosine = [](double r, double power) { return (1 - std::cos(r)) / std::pow(r, power); };
    for (double constant : {0.01, 1.0, 100.0})
        for (double slope : {0.0, 1000.0}) {
            const auto with = [=](auto f) { return [=](double x) { return f(x) + constant + slope * x; }; };
            const auto diverges = [&](auto f) { return look_at(with(f), unit).divergence == "x -> 0"; };
            EXPECT_TRUE(diverges([=](double x) { return cosine(x, 3); })) << constant << " " << slope;
            EXPECT_TRUE(diverges([](double x) { return std::log(1 + x) / (x * x); }))
                << constant << " " << slope;
            EXPECT_FALSE(diverges([=](double x) { return cosine(x, 2.8); })) << constant << " " << slope;
        }
    // The part below 2^-26.5 is 2^(-26.5 * 0.2) / 0.4.
    const FirstLook line = look_at([=](double x) { return cosine(x, 2.8) + 1; }, unit);
    ASSERT_EQ(line.unresolved.size(), 1u);
    EXPECT_NEAR(line.unresolved[0], 0.063, 0.01);
    const auto plane = [=](std::span<const double> x) {
        return cosine(std::abs(x[0] - 0.4), 2.8) * (1 + x[1]);
    };
    const FirstLook inside = look_at(plane, Domain::unit_cube(2), {{0.4, 0.5}});
    ASSERT_EQ(inside.unresolved.size(), 1u);
    EXPECT_NEAR(inside.unresolved[0], 2 * 0.063 * 1.5, 0.1);
    const auto edge = [=](std::span<const double> x) {
        return cosine(std::hypot(x[0], x[1]), 4) * (1 + x[2]);
    };
    EXPECT_NE(look_at(edge, Domain::unit_cube(3)).divergence, "");
    const auto converges = [=](std::span<const double> x) {
        return cosine(std::hypot(x[0], x[1]), 3.5) * (1 + x[2]);
    };
    EXPECT_EQ(look_at(converges, Domain::unit_cube(3)).divergence, "");
}

// Overflow of terms whose difference has long been rounded to zero, or to noise, is no divergence.
TEST(FirstLook, OverflowAfterTheDigitsAreLostIsNoDivergence) {
    const Domain half_line = Domain::interval(0, infinity);
    const auto diverges = [&](auto f) { return look_at(f, half_line).divergence == "x -> inf"; };
    EXPECT_FALSE(diverges([](double x) { return std::log(1 + std::exp(x)) - x; }));
    EXPECT_FALSE(diverges([](double x) { return std::log(std::cosh(x)) - x + std::log(2.0); }));
    EXPECT_TRUE(diverges([](double x) { return std::exp(x); }));
    EXPECT_TRUE(diverges([](double x) { return std::exp(x * x); }));
    EXPECT_TRUE(diverges([](double x) { return std::log(1 + std::exp(x)); }));
}

// Doubles are dense towards the centre of a ball.
TEST(FirstLook, PowersNearTheLimitConvergeAtTheCentreOfABall) {
    const Domain ball = Domain::ball({0, 0, 0});
    const auto power = [](double p) {
        return [p](std::span<const double> x) {
            return std::pow(x[0] * x[0] + x[1] * x[1] + x[2] * x[2], -p / 2);
        };
    };
    EXPECT_EQ(look_at(power(2.9), ball).divergence, "");
    EXPECT_NE(look_at(power(3), ball).divergence, "");
}

// Large scales are no divergence, and what lies beyond the cube's points is measured.
TEST(FirstLook, MeasuresWhatLiesFartherOutThanPoints) {
    for (double scale : {1e14, 1e20, 1e40}) {
        const FirstLook look = look_at([=](double x) { return std::exp(-x / scale); },
                                       Domain::interval(0, infinity), {{scale}, {1}});
        EXPECT_EQ(look.divergence, "") << scale;
        if (scale == 1e14) continue;
        ASSERT_EQ(look.unresolved.size(), 1u) << scale;
        EXPECT_NEAR(look.unresolved[0] / scale, 1, 0.3) << scale;
    }
}

// Ends that are close to zero beside the width of the range, and narrow peaks far from zero.
TEST(FirstLook, NoDivergenceWhereValuesEnd) {
    const auto inverse = [](double x) { return 1 / x; };
    for (const Domain& domain :
         {Domain::interval(1e-15, 1), Domain::interval(1e-30, 1), Domain::interval(1, 1e15)})
        EXPECT_TRUE(look_at(inverse, domain).divergence.empty());
    EXPECT_TRUE(look_at([](double x) { return 1 / (x + 1e-14); }, Domain::interval(0, 1), {{1e-14}})
                    .divergence.empty());
    EXPECT_TRUE(look_at([](double x) { return std::exp(-(x - 1e8) * (x - 1e8) / 2e6); },
                        Domain::interval(-infinity, infinity), {{1e8}})
                    .divergence.empty());
    EXPECT_EQ(look_at([](double x) { return std::abs(x) < 1000 ? 1.0 : 0.0; },
                      Domain::interval(-infinity, infinity), {{1000}})
                  .divergence,
              "");
}

// Masses of shells whose widths fall at different rates: x + y^2 has two scales.
TEST(FirstLook, TellsDivergenceAtCornersOfTwoScales) {
    for (int n : {2, 3})
        for (int steep = 0; steep < n; ++steep)
            for (double power : {1.5, 1.4}) {
                const Integrand f([=](std::span<const double> x) {
                    double sum = x[static_cast<std::size_t>(steep)];
                    for (int d = 0; d < n; ++d)
                        if (d != steep)
                            sum += x[static_cast<std::size_t>(d)] * x[static_cast<std::size_t>(d)];
                    return std::pow(sum, -power - 0.5 * (n - 2));
                });
                EXPECT_EQ(look_at(f, Domain::unit_cube(n)).divergence.empty(), power < 1.5)
                    << n << " " << steep << " " << power;
            }
}

TEST(FirstLook, SurvivesValuesThatAreNotFinite) {
    const FirstLook none =
        look_at([](double) { return std::numeric_limits<double>::quiet_NaN(); }, Domain::interval(0, 1));
    EXPECT_TRUE(none.witnesses.empty());
    EXPECT_TRUE(none.divergence.empty());
}

struct Wide {
    const char* name;
    double (*f)(double);
    double half_width, exact;
};

class WideRanges : public testing::TestWithParam<Wide> {};

// A peak at a face of cubature's regions lost a half, or all, of its integral.
TEST_P(WideRanges, KeepTheirPeaks) {
    const Wide wide = GetParam();
    for (const char* method : {"auto", "cubature", "adaptive", "vegas", "quasi"}) {
        const IntegrationResult r =
            integrate(Integrand(wide.f), Domain::interval(-wide.half_width, wide.half_width),
                      Method::named(method), {.relative_error = 1e-3, .evaluations = 2'000'000});
        if (r.converged()) {
            EXPECT_LE(std::abs(r.value[0] - wide.exact), 5 * r.standard_error[0] + 1e-9) << method;
        }
        if (method == std::string("auto")) {
            EXPECT_TRUE(r.converged()) << r;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(
    Typed, WideRanges,
    testing::Values(Wide{"exponential", [](double x) { return std::exp(-std::abs(x)); }, 3e4, 2},
                    Wide{"gaussian", [](double x) { return std::exp(-x * x); }, 1e4, 1.7724538509055159},
                    Wide{"gaussian_farther", [](double x) { return std::exp(-x * x); }, 1e5,
                         1.7724538509055159},
                    Wide{"sech", [](double x) { return 1 / std::cosh(x); }, 1e4, 3.141592653589793},
                    Wide{"spike", [](double x) { return 1 + 1e4 * std::exp(-1e4 * std::abs(x)); }, 1, 4}),
    [](const auto& wide) { return wide.param.name; });

TEST(FirstLook, LogarithmsOfWidePeaksAreFoundToo) {
    const LogIntegrationResult r = integrate_log([](double x) { return -x * x; }, Domain::interval(-1e6, 1e6),
                                                 Method(), {.relative_error = 1e-3});
    EXPECT_TRUE(r.relative.converged());
    EXPECT_NEAR(r.log_value, 0.5 * std::log(3.141592653589793), 4 * r.log_error + 1e-9);
}

// Values on the line x = y are rounding errors, in the directions of that line alone: neither noise nor divergence beside it.
TEST(FirstLook, LinesOfZerosAreNoNoise) {
    for (double shift : {50.0, 1e3, 1e8}) {
        const auto difference = [shift](std::span<const double> x) {
            return std::pow(x[0] + shift, 2) - std::pow(x[1] + shift, 2);
        };
        const Integrand guide(difference);
        const std::vector<Integrand::BatchFunction> guides{
            [&](const PointBatch& x, ValueBatch y) { guide(x, y); }};
        const Evaluator evaluator([&](std::span<const double> x) { return std::abs(difference(x)); },
                                  Domain::unit_cube(2));
        for (std::uint64_t seed = 0; seed < 150; ++seed) {
            const FirstLook look = first_look(evaluator, {.guides = guides, .seed = seed});
            EXPECT_TRUE(look.noise.empty()) << shift << " " << seed;
            EXPECT_EQ(look.divergence, "") << shift << " " << seed;
        }
    }
}

// A regular ring of height 1e5 and half width 1e-5 on a plain of height 1, whose guide is known: the ring holds 8.8, of
// which a box around one of its points has 1/10^5.
TEST(FirstLook, MeasuresRidgesOfGuides) {
    const auto ring = [](std::span<const double> x) {
        return std::abs(std::hypot(x[0], x[1]) - 0.7) < 1e-5 ? 1e5 : 1;
    };
    const Integrand guide([](std::span<const double> x) { return std::hypot(x[0], x[1]) - 0.7; });
    const std::vector<Integrand::BatchFunction> guides{
        [&](const PointBatch& x, ValueBatch y) { guide(x, y); }};
    const Evaluator evaluator(Integrand(ring), Domain({{-1, 1}, {-1, 1}}));
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        const FirstLook look = first_look(evaluator, {.guides = guides, .seed = seed});
        double sum = 0;
        for (const Witness& peak : look.peaks) sum += peak.value[0] * peak.volume;
        EXPECT_GT(sum, 1) << seed;
        EXPECT_LT(sum, 12) << seed;
    }
}

// An integrand that vanishes on a curve, with a ridge on each side of it: both are followed in both directions.
TEST(FirstLook, FollowsRidgesBesideTheZerosOfGuides) {
    const auto curve = [](std::span<const double> x) { return x[1] - x[0] * x[0]; };
    const Integrand guide(curve);
    const std::vector<Integrand::BatchFunction> guides{
        [&](const PointBatch& x, ValueBatch y) { guide(x, y); }};
    const auto two_ridges = [&](std::span<const double> x) {
        const double square = std::pow(curve(x), 2);
        return square * std::exp(-square) * std::pow(1 + x[0] * x[0], -1.5);
    };
    const Domain plane({{-infinity, infinity}, {-infinity, infinity}});
    const Evaluator evaluator(Integrand(two_ridges), plane);
    int complete = 0;
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
        const FirstLook look = first_look(evaluator, {.guides = guides, .seed = seed});
        EXPECT_EQ(look.divergence, "") << seed;
        std::array<int, 4> seen{}; // beyond |x| = 3: above and below of the curve, on both sides
        for (const Witness& w : look.witnesses) {
            PointBuffer u(1, 2), x(1, 2);
            for (int d = 0; d < 2; ++d) u(0, d) = w.u[static_cast<std::size_t>(d)];
            std::array<double, 1> volume{1};
            plane.map(u, x, volume);
            const std::array<double, 2> at{x.view()(0, 0), x.view()(0, 1)};
            if (std::abs(at[0]) > 3 && std::abs(std::abs(curve(at)) - 1) < 0.5)
                ++seen[(at[0] > 0 ? 2u : 0u) + (curve(at) > 0 ? 1u : 0u)];
        }
        if (std::ranges::min(seen) >= 3) ++complete; // the others come to the limit of evaluations
    }
    EXPECT_GE(complete, 7);
}

// Doubles resolve the ridge of x = exp(y) until y = 15 or so, beyond which it holds pi (pi / 2 - atan(15)) = 0.2. Climbs
// that keep x reach it from a point of the ridge with a large x, not from where exp(y) is flat.
TEST(FirstLook, FollowsExponentialRidgesAsFarAsDoublesResolveThem) {
    const auto curve = [](std::span<const double> x) { return x[0] - std::exp(x[1]); };
    const Integrand guide(curve);
    const std::vector<Integrand::BatchFunction> guides{
        [&](const PointBatch& x, ValueBatch y) { guide(x, y); }};
    const auto ridge = [&](std::span<const double> x) {
        return 1 / (1 + std::pow(curve(x), 2)) / (1 + x[1] * x[1]);
    };
    const Evaluator evaluator(Integrand(ridge), Domain({{-infinity, infinity}, {-infinity, infinity}}));
    int followed = 0;
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        const FirstLook look = first_look(evaluator, {.guides = guides, .seed = seed});
        EXPECT_EQ(look.divergence, "") << seed;
        if (look.unresolved.empty()) continue;
        ++followed;
        EXPECT_GT(look.unresolved[0], 0.03) << seed;
        EXPECT_LT(look.unresolved[0], 0.6) << seed;
    }
    EXPECT_GE(followed, 16);
}

// A region of cubature that begins beside the top holds a part of the peak.
TEST(FirstLook, SeesFlanksOfPeaks) {
    const auto peak = [](std::span<const double> x) {
        return 1 + 1e4 * std::exp(-1e6 * (std::pow(x[0] - 0.3, 2) + std::pow(x[1] - 0.7, 2)));
    };
    const FirstLook look = look_at(peak, Domain::unit_cube(2), {{0.3, 0.7}});
    ASSERT_EQ(look.peaks.size(), 1u);
    const Witness& top = look.peaks[0];
    for (std::size_t d : {0u, 1u})
        for (double side : {-1.0, 1.0}) {
            const auto is_flank = [&](const Witness& w) {
                return w.u[1 - d] == top.u[1 - d] &&
                       std::abs(side * (w.u[d] - top.u[d]) / top.extent[d] - 2) < 1e-6 && w.value[0] > 2;
            };
            EXPECT_EQ(std::ranges::count_if(look.witnesses, is_flank), 1) << d << " " << side;
        }
}

} // namespace
} // namespace montelux
