// Pixel filters: values, and weights of their samples. Sums of random samples are compared at 5.5 standard
// errors (one false alarm in 26 million) and those of single cells at 6.5 (one in 12 billion): below 3e-6 for
// the whole file.
#include <algorithm>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "montelux/film/film.h"
#include "montelux/film/pixel_filter.h"
#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/stats/chi_squared.h"
#include "montelux/mc/stats/moments.h"

namespace montelux {
namespace {

struct FilterCase {
    std::string name;
    PixelFilter filter;
};

std::vector<FilterCase> filters() {
    return {{"box", BoxFilter{}},           {"oblong box", BoxFilter{{0.75f, 2}}},
            {"triangle", TriangleFilter{}}, {"oblong triangle", TriangleFilter{{1, 1.5f}}},
            {"gaussian", GaussianFilter{}}, {"wide gaussian", GaussianFilter{{2, 3}, 1.2f}},
            {"mitchell", MitchellFilter{}}, {"catmull-rom", MitchellFilter{{2, 1.5f}, 0, 0.5f}},
            {"lanczos", LanczosFilter{}},   {"short lanczos", LanczosFilter{{2, 3}, 2}}};
}

// The integral of `f` over [a, b] by the midpoint rule, which meets no kink or edge on a node.
double integrate(const std::function<double(double)>& f, double a, double b, int n = 4000) {
    double sum = 0;
    for (int i = 0; i < n; ++i) sum += f(a + (b - a) * (i + 0.5) / n);
    return sum * (b - a) / n;
}

// One axis of a filter: every filter is a product of its axes.
double along(const PixelFilter& filter, int axis, double x) {
    Vec2f p{0, 0};
    p[axis] = static_cast<float>(x);
    return filter_value(filter, p);
}

// Splats weigh by the filter where samples are drawn by it: both mean the same filter.
TEST(PixelFilter, NormalizedIsTheFilterOverItsIntegral) {
    for (const FilterCase& c : filters()) {
        const PixelFilterSampler sampler(c.filter);
        const Vec2f r = filter_radius(c.filter);
        EXPECT_EQ(sampler.radius(), r);
        const auto at = [&](float x, float y) { return sampler.normalized({x, y}); };
        for (const int axis : {0, 1}) {
            const auto value = [&](double x) { return along(c.filter, axis, x); };
            const double radius = double(r[axis]), integral = integrate(value, -radius, radius);
            const double other =
                double(axis == 0 ? at(0, 0) : at(0, 0)) / along(c.filter, axis, 0) * integral;
            for (const double x : {-0.93, -0.4, 0.0, 0.31, 0.77}) {
                const auto p = static_cast<float>(x * radius);
                const double got = double(axis == 0 ? at(p, 0) : at(0, p));
                EXPECT_NEAR(got, value(double(p)) / integral * other, 2e-4 * other) << c.name << " at " << p;
            }
        }
        double mass = 0;
        constexpr int n = 400;
        for (int i = 0; i < n * n; ++i) {
            const double x = (i % n + 0.5) / n * 2 - 1, y = (i / n + 0.5) / n * 2 - 1;
            mass += double(at(static_cast<float>(x) * r.x, static_cast<float>(y) * r.y));
        }
        EXPECT_NEAR(mass * 4 * double(r.x) * double(r.y) / (n * n), 1, 1e-3) << c.name;
        EXPECT_EQ(at(r.x, 0), 0) << c.name;
        EXPECT_EQ(at(0, -1.001f * r.y), 0) << c.name;
    }
    // Neighbouring boxes tile the film.
    const PixelFilterSampler box(BoxFilter{});
    EXPECT_EQ(box.normalized({-0.5f, 0}), 1);
    EXPECT_EQ(box.normalized({0.5f, 0}), 0);
}

TEST(PixelFilter, ValuesInClosedForm) {
    for (float x : {0.0f, 0.3f, -0.45f}) {
        EXPECT_EQ(filter_value(BoxFilter{}, {x, -x}), 1);
        EXPECT_FLOAT_EQ(filter_value(TriangleFilter{{1, 3}}, {x, 1}), (1 - std::abs(x)) * 2);
        float gauss = std::exp(-x * x / 0.5f) - std::exp(-2.25f / 0.5f);
        EXPECT_NEAR(filter_value(GaussianFilter{}, {x, 0}), gauss * (1 - std::exp(-4.5f)), 1e-6);
    }
    // Mitchell and Netravali 1988, equation 8: k(0) = 1 - B/3 and k(1) = B/6 for every C; with B = C = 0 the
    // Hermite cubic 1 - 3x^2 + 2x^3.
    for (float b : {0.0f, 1.0f / 3, 1.0f})
        for (float c : {0.0f, 1.0f / 3, 0.5f}) {
            MitchellFilter m{{2, 2}, b, c};
            EXPECT_NEAR(filter_value(m, {0, 0}), (1 - b / 3) * (1 - b / 3), 1e-6);
            EXPECT_NEAR(filter_value(m, {1, 0}), b / 6 * (1 - b / 3), 1e-6);
        }
    EXPECT_NEAR(filter_value(MitchellFilter{{2, 2}, 0, 0}, {0.25f, 0}), 1 - 3 * 0.0625 + 2 * 0.015625, 1e-6);
    // A radius of 4 stretches a filter of radius 2 twofold.
    EXPECT_NEAR(filter_value(MitchellFilter{{4, 4}}, {1.4f, -2.2f}),
                filter_value(MitchellFilter{}, {0.7f, -1.1f}), 1e-6);
    auto sinc = [](double x) { return std::sin(pi * x) / (pi * x); };
    EXPECT_EQ(filter_value(LanczosFilter{}, {0, 0}), 1);
    EXPECT_NEAR(filter_value(LanczosFilter{}, {0.5f, 1.5f}),
                sinc(0.5) * sinc(0.5 / 3) * sinc(1.5) * sinc(0.5), 1e-6);
    for (int i = 1; i < 4; ++i)
        EXPECT_NEAR(filter_value(LanczosFilter{}, {static_cast<float>(i), 0}), 0, 1e-6);
}

TEST(PixelFilter, NothingOutsideTheRadiusAndSymmetricInside) {
    for (const FilterCase& c : filters()) {
        Vec2f r = filter_radius(c.filter);
        EXPECT_EQ(filter_value(c.filter, {r.x * 1.001f, 0}), 0) << c.name;
        EXPECT_EQ(filter_value(c.filter, {0, -r.y * 1.001f}), 0) << c.name;
        for (float t : {0.1f, 0.4f, 0.9f}) {
            float v = filter_value(c.filter, {t * r.x, 0.3f * r.y});
            EXPECT_EQ(filter_value(c.filter, {-t * r.x, 0.3f * r.y}), v) << c.name;
            EXPECT_EQ(filter_value(c.filter, {t * r.x, -0.3f * r.y}), v) << c.name;
        }
    }
}

// Mitchell's cubics and the box and triangle of their natural radii reproduce a constant picture.
TEST(PixelFilter, PartitionOfUnity) {
    const PixelFilter cases[] = {BoxFilter{}, TriangleFilter{{1, 1}}, MitchellFilter{},
                                 MitchellFilter{{2, 2}, 0, 0.5f}};
    for (const PixelFilter& f : cases)
        for (double x : {0.013, 0.26, 0.43}) {
            double sum = 0;
            for (int i = -3; i <= 3; ++i) sum += along(f, 0, x + i);
            // Squares: the other axis stands at its value at 0.
            EXPECT_NEAR(sum / std::sqrt(filter_value(f, {0, 0})), 1, 1e-5);
        }
}

// Moments of the weighted samples, and the weight that falls in each of 32 cells of each axis.
TEST(PixelFilterSampler, WeightedSamplesFollowTheFilter) {
    using Function = std::function<double(double)>;
    const Function functions[] = {[](double) { return 1.0; }, [](double x) { return x; },
                                  [](double x) { return x * x; },
                                  [](double x) { return std::cos(3 * x + 1); }};
    constexpr int samples = 200000, cells = 32;
    int negative = 0;
    for (const FilterCase& c : filters()) {
        PixelFilterSampler sampler(c.filter);
        Vec2f r = filter_radius(c.filter);
        TestUniforms uniforms(7);
        RunningMoments moments[4][4];
        double weights[2][cells] = {}, squares[2][cells] = {}; // their sums over the samples in each cell
        for (int i = 0; i < samples; ++i) {
            FilterSample s = sampler.sample(uniforms.next_2f());
            ASSERT_LE(std::abs(s.offset.x), r.x);
            ASSERT_LE(std::abs(s.offset.y), r.y);
            double w = s.weight;
            negative += w < 0;
            for (int a = 0; a < 4; ++a)
                for (int b = 0; b < 4; ++b)
                    moments[a][b].add(w * functions[a](s.offset.x) * functions[b](s.offset.y));
            for (int axis = 0; axis < 2; ++axis) {
                double t = (double(s.offset[axis]) / r[axis] + 1) * 0.5 * cells;
                int cell = std::min(static_cast<int>(t), cells - 1);
                weights[axis][cell] += w;
                squares[axis][cell] += w * w;
            }
        }
        double total[2], expected[2][4];
        for (int axis = 0; axis < 2; ++axis) {
            double e = r[axis];
            auto f = [&](double x) { return along(c.filter, axis, x); };
            total[axis] = integrate(f, -e, e);
            for (int a = 0; a < 4; ++a)
                expected[axis][a] =
                    integrate([&](double x) { return f(x) * functions[a](x); }, -e, e) / total[axis];
            for (int k = 0; k < cells; ++k) {
                double x0 = e * (2.0 * k / cells - 1), x1 = e * (2.0 * (k + 1) / cells - 1);
                const double mean = weights[axis][k] / samples,
                             variance = (squares[axis][k] / samples - mean * mean) / samples;
                EXPECT_NEAR(mean, integrate(f, x0, x1, 400) / total[axis],
                            6.5 * std::sqrt(std::max(0.0, variance)) + 2e-6)
                    << c.name << " axis " << axis << " cell " << k;
            }
        }
        for (int a = 0; a < 4; ++a)
            for (int b = 0; b < 4; ++b)
                EXPECT_NEAR(moments[a][b].mean(), expected[0][a] * expected[1][b],
                            5.5 * moments[a][b].standard_error() + 2e-5)
                    << c.name << ' ' << a << ' ' << b;
    }
    EXPECT_GT(negative, 1000) << "Mitchell and Lanczos filters have negative lobes";
}

// Importance sampling in proportion to the filter: where it has one sign, nearly all weights are nearly 1, so
// that they add less than 1 % to the variance.
TEST(PixelFilterSampler, WeightsAreEven) {
    for (const FilterCase& c : filters()) {
        PixelFilterSampler sampler(c.filter);
        TestUniforms uniforms(3);
        RunningMoments m;
        double largest = 0;
        for (int i = 0; i < 20000; ++i) {
            double w = sampler.sample(uniforms.next_2f()).weight;
            m.add(w);
            largest = std::max(largest, std::abs(w));
        }
        bool one_sign = std::holds_alternative<BoxFilter>(c.filter) ||
                        std::holds_alternative<TriangleFilter>(c.filter) ||
                        std::holds_alternative<GaussianFilter>(c.filter);
        EXPECT_LT(largest, one_sign ? 3 : 6) << c.name;
        EXPECT_LT(m.standard_deviation(), one_sign ? 0.1 : 2) << c.name;
    }
}

TEST(PixelFilterSampler, EdgesOfTheUnitSquare) {
    const float last = 1 - 0x1p-24f;
    for (const FilterCase& c : filters()) {
        PixelFilterSampler sampler(c.filter);
        Vec2f r = filter_radius(c.filter);
        for (Vec2f u : {Vec2f{0, 0}, Vec2f{last, last}, Vec2f{0, last}, Vec2f{0.5f, 0.5f}}) {
            FilterSample s = sampler.sample(u);
            EXPECT_LE(std::abs(s.offset.x), r.x) << c.name;
            EXPECT_LE(std::abs(s.offset.y), r.y) << c.name;
            EXPECT_TRUE(std::isfinite(s.weight)) << c.name;
        }
    }
}

TEST(PixelFilterSampler, RefusesRadii) {
    for (float r :
         {0.0f, -1.0f, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        EXPECT_THROW(PixelFilterSampler(BoxFilter{{r, 1}}), Error);
        EXPECT_THROW(PixelFilterSampler(GaussianFilter{{1, r}}), Error);
    }
}

// A pixel of a picture of stripes converges to the convolution of stripes and filter.
TEST(PixelFilterSampler, PixelConvergesToTheConvolution) {
    auto stripes = [](double x, double y) { return 2 + std::cos(1.7 * x) + std::sin(0.9 * y); };
    constexpr int x = 3, y = 2;
    for (const FilterCase& c : filters()) {
        Vec2f r = filter_radius(c.filter);
        auto f = [&](int axis, const std::function<double(double)>& g) {
            auto signed_factor = [&](double v) { return along(c.filter, axis, v); };
            return integrate([&](double v) { return signed_factor(v) * g(v); }, -r[axis], r[axis]) /
                   integrate(signed_factor, -r[axis], r[axis]);
        };
        double truth = 2 + f(0, [&](double v) { return std::cos(1.7 * (x + 0.5 + v)); }) +
                       f(1, [&](double v) { return std::sin(0.9 * (y + 0.5 + v)); });
        PixelFilterSampler sampler(c.filter);
        TestUniforms uniforms(11);
        Film film(FilmSettings{.width = 8, .height = 8, .crop = {0, 0, 8, 8}, .filter = c.filter});
        Pixel& pixel = film.pixel(x, y);
        for (int i = 0; i < 200000; ++i) {
            FilterSample s = sampler.sample(uniforms.next_2f());
            double value = stripes(x + 0.5 + double(s.offset.x), y + 0.5 + double(s.offset.y));
            float v = static_cast<float>(value) * s.weight;
            pixel.add_sample({.radiance = {v, v, v}, .albedo = {}, .normal = {}});
            pixel.end_replicate();
        }
        EXPECT_NEAR(pixel.replicates().mean(0), truth, 5.5 * pixel.replicates().standard_error(0) + 2e-5)
            << c.name;
    }
}

} // namespace
} // namespace montelux
