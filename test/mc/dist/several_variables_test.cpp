#include "test/significance.h"
#include <cmath>
#include <gtest/gtest.h>

#include "montelux/mc/dist/families.h"
#include "montelux/mc/dist/marginal_conditional.h"
#include "montelux/mc/dist/product.h"
#include "montelux/mc/dist/truncated.h"
#include "montelux/mc/stats/chi_squared.h"
#include "montelux/mc/stats/moments.h"

namespace montelux {
namespace {

template <typename Joint>
void expect_follows(const Joint& joint, Vec2d lower, Vec2d upper) {
    auto r = rectangle_chi_squared_test(
        [&](Vec2d u) {
            auto p = joint.sample({u.x, u.y});
            return Vec2d(p[0], p[1]);
        },
        [&](Vec2d p) {
            return joint.pdf({p.x, p.y});
        },
        lower, upper, {.samples = 100000, .cells_x = 20, .cells_y = 20});
    EXPECT_TRUE(r.passes(significance)) << r.description;
}

TEST(ProductDistribution, DensityIsTheProductInOrder) {
    ProductDistribution d(CosineDistribution(), LinearDistribution(2, 4), UniformDistribution(0, 2));
    auto x = d.quantile({0.5, 0.25, 0.75});
    EXPECT_NEAR(x[0], std::asin(0.5), 1e-15);
    EXPECT_NEAR(x[1], 2 * std::sqrt(1.75), 1e-15);
    EXPECT_NEAR(x[2], 1.5, 1e-15);
    EXPECT_NEAR(d.pdf(x), std::cos(x[0]) * x[1] / 6 * 0.5, 1e-15);
    EXPECT_NEAR(d.cdf(x)[1], 0.25, 1e-15);
    expect_follows(ProductDistribution{CosineDistribution(), UniformDistribution()}, {0, 0}, {pi / 2, 1});
}

// A number of factors known at run time: the same numbers as the fixed product gives.
TEST(RuntimeProduct, AgreesWithTheFixedProduct) {
    ProductDistribution fixed(CosineDistribution(), NormalDistribution(1, 2), ExponentialDistribution(3));
    RuntimeProduct<> runtime({CosineDistribution(), NormalDistribution(1, 2), ExponentialDistribution(3)});
    ASSERT_EQ(runtime.dimensions(), 3u);
    TestUniforms uniforms(3);
    for (int i = 0; i < 100; ++i) {
        std::array<double, 3> xi{uniforms.next(), uniforms.next(), uniforms.next()}, x{}, back{};
        runtime.sample(xi, x);
        EXPECT_EQ(x, fixed.sample(xi));
        EXPECT_EQ(runtime.pdf(x), fixed.pdf(x));
        runtime.cdf(x, back);
        EXPECT_EQ(back, fixed.cdf(x));
        runtime.quantile(back, back); // in place
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(back[k], x[k], 1e-13 * (1 + std::abs(x[k])));
    }
    EXPECT_THROW(RuntimeProduct<>({}), Error);
}

// Fifty dimensions: the mean of a function that sees all of them. 5 standard errors: 6e-7.
TEST(RuntimeProduct, ManyDimensions) {
    RuntimeProduct product(std::vector<ExponentialDistribution>(50, ExponentialDistribution(2)));
    TestUniforms uniforms(4);
    RunningMoments sums;
    std::vector<double> x(50);
    for (int i = 0; i < 5000; ++i) {
        for (double& u : x) u = uniforms.next();
        product.sample(x, x);
        double sum = 0;
        for (double v : x) sum += v;
        sums.add(sum);
    }
    EXPECT_NEAR(sums.mean(), 25, 5 * sums.standard_error());
    EXPECT_NEAR(sums.variance(), 12.5, 1.5);
}

// p(x, y) = (x + y) on the unit square: marginal x + 1/2, conditional (x + y) / (x + 1/2).
TEST(MarginalConditional, SumOfCoordinatesOnTheSquare) {
    struct Rising { // density proportional to shift + x on [0, 1)
        double shift;
        double lower() const { return 0; }
        double upper() const { return 1; }
        double pdf(double x) const { return x >= 0 && x <= 1 ? (shift + x) / (shift + 0.5) : 0; }
        double cdf(double x) const {
            return std::clamp(x, 0.0, 1.0) * (shift + 0.5 * std::clamp(x, 0.0, 1.0)) / (shift + 0.5);
        }
        double quantile(double xi) const {
            return 2 * xi * (shift + 0.5) / (shift + std::sqrt(shift * shift + 2 * xi * (shift + 0.5)));
        }
    };
    MarginalConditional joint(Rising{0.5}, [](double x) { return Rising{x}; });
    expect_follows(joint, {0, 0}, {1, 1});
    for (double x : {0.1, 0.6})
        for (double y : {0.2, 0.9}) {
            EXPECT_NEAR(joint.pdf({x, y}), x + y, 1e-15);
            auto back = joint.quantile(joint.cdf({x, y}));
            EXPECT_NEAR(back[0], x, 1e-15);
            EXPECT_NEAR(back[1], y, 1e-15);
        }
    EXPECT_EQ(joint.pdf({1.1, 0.5}), 0);
}

// A domain that is no rectangle: uniform on the triangle 0 < y < x < 1, whose conditional does not exist at
// 0.
TEST(MarginalConditional, UniformOnATriangle) {
    MarginalConditional triangle(LinearDistribution(), [](double x) { return UniformDistribution(0, x); });
    EXPECT_EQ(triangle.pdf({0.5, 0.25}), 2);
    EXPECT_EQ(triangle.pdf({0.5, 0.75}), 0);
    EXPECT_EQ(triangle.pdf({0, 0}), 0);
    auto p = triangle.sample({0.25, 0.5});
    EXPECT_DOUBLE_EQ(p[0], 0.5);
    EXPECT_DOUBLE_EQ(p[1], 0.25);
    // In coordinates where it fills the square: y / x.
    auto r = rectangle_chi_squared_test(
        [&](Vec2d u) {
            auto q = triangle.sample({u.x, u.y});
            return Vec2d(q[0], q[1] / q[0]);
        },
        [](Vec2d q) { return 2 * q.x; }, {0, 0}, {1, 1});
    EXPECT_TRUE(r.passes(significance)) << r.description;
}

// A chain of three: a random walk of normal steps, whose last coordinate has variance 3 and whose density is
// the product of the steps'. 5 standard errors: 6e-7.
TEST(MarginalConditional, ChainsOfAnyLength) {
    MarginalConditional two(NormalDistribution(), [](double x) { return NormalDistribution(x); });
    MarginalConditional walk(two, [](const std::array<double, 2>& x) { return NormalDistribution(x[1]); });
    static_assert(walk.dimensions == 3);
    NormalDistribution step;
    std::array<double, 3> x{0.5, -1, 2};
    EXPECT_NEAR(walk.pdf(x), step.pdf(0.5) * step.pdf(1.5) * step.pdf(3), 1e-16);
    TestUniforms uniforms(5);
    RunningMoments last, product;
    for (int i = 0; i < 50000; ++i) {
        std::array<double, 3> xi{uniforms.next(), uniforms.next(), uniforms.next()};
        auto p = walk.sample(xi);
        last.add(p[2] * p[2]);
        product.add(p[0] * p[2]);
        if (i < 100) {
            auto back = walk.cdf(p);
            for (int k = 0; k < 3; ++k) ASSERT_NEAR(back[k], xi[k], 1e-14);
        }
    }
    EXPECT_NEAR(last.mean(), 3, 5 * last.standard_error());
    EXPECT_NEAR(product.mean(), 1, 5 * product.standard_error());
    MarginalConditional on_product(
        ProductDistribution{UniformDistribution(), UniformDistribution()},
        [](const std::array<double, 2>& p) { return UniformDistribution(0, 1 + p[0]); });
    EXPECT_DOUBLE_EQ(on_product.pdf({0.5, 0.5, 0.5}), 1 / 1.5);
    EXPECT_DOUBLE_EQ(on_product.sample({0.5, 0.25, 0.5})[2], 0.75);
}

} // namespace
} // namespace montelux
