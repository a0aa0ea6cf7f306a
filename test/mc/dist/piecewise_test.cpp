#include "test/significance.h"
#include <cmath>
#include <gtest/gtest.h>

#include "montelux/mc/dist/piecewise_1d.h"
#include "montelux/mc/dist/piecewise_2d.h"
#include "montelux/mc/dist/piecewise_bilinear_2d.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/stats/chi_squared.h"

namespace montelux {
namespace {

TEST(PiecewiseConstant1D, SamplesPdfAndInverseAgree) {
    std::vector<double> values{0, 1, 0, 3, 0.25, 0, 0};
    PiecewiseConstant1D d(values, -1, 2.5);
    EXPECT_NEAR(d.integral(), 4.25 * 0.5, 1e-15);
    auto r = interval_chi_squared_test([&](double u) { return d.sample(u).x; },
                                       [&](double x) { return d.pdf(x); }, -1, 2.5, {.cells_x = 70});
    EXPECT_TRUE(r.passes(significance)) << r.description;
    TestUniforms uniforms(1);
    for (int i = 0; i < 2000; ++i) {
        double u = uniforms.next();
        auto s = d.sample(u);
        ASSERT_NEAR(*d.inverse(s.x), u, 1e-14);
        ASSERT_DOUBLE_EQ(s.pdf, values[s.piece] / d.integral());
        auto f = d.sample(static_cast<float>(u));
        ASSERT_GT(d.pdf(f.x), 0) << f.x;
    }
    EXPECT_EQ(d.pdf(3.0), 0);
    EXPECT_FALSE(d.inverse(-1.01));
    // The ends: never outside the half-open interval, never in an empty piece.
    EXPECT_EQ(d.sample(0.0).piece, 1u);
    EXPECT_EQ(d.sample(one_minus_epsilon_d).piece, 4u);
    EXPECT_LT(PiecewiseConstant1D(std::vector<double>{1}, 0, 1e-3).sample(one_minus_epsilon_d).x, 1e-3);
}

TEST(PiecewiseLinear1D, SamplesPdfAndInverseAgree) {
    std::vector<double> x{0, 0.5, 0.6, 2, 3, 3.5}, f{0, 2, 2, 0, 0, 1};
    PiecewiseLinear1D d(x, f);
    EXPECT_NEAR(d.integral(), 0.5 + 0.2 + 1.4 + 0 + 0.25, 1e-15);
    auto r = interval_chi_squared_test([&](double u) { return d.sample(u).x; },
                                       [&](double v) { return d.pdf(v); }, 0, 3.5, {.cells_x = 70});
    EXPECT_TRUE(r.passes(significance)) << r.description;
    TestUniforms uniforms(1);
    for (int i = 0; i < 2000; ++i) {
        double u = uniforms.next();
        auto s = d.sample(u);
        ASSERT_NEAR(*d.inverse(s.x), u, 1e-13);
        ASSERT_NEAR(s.pdf, d.pdf(s.x), 1e-12);
        ASSERT_NE(s.piece, 3u);
    }
    EXPECT_NEAR(d.pdf(0.25), 1 / d.integral(), 1e-15);
}

TEST(PiecewiseLinear1D, EqualDistancesAndTwoX) {
    PiecewiseLinear1D d(std::vector<double>{0, 1});
    for (double u : {0.0, 0.1, 0.5, 0.99}) EXPECT_NEAR(d.sample(u).x, std::sqrt(u), 1e-15);
}

TEST(PiecewiseConstant2D, SamplesPdfAndInverseAgree) {
    std::uint32_t nx = 7, ny = 5;
    std::vector<float> values(nx * ny);
    TestUniforms uniforms(4);
    for (float& v : values) v = uniforms.next() < 0.3 ? 0 : static_cast<float>(std::pow(uniforms.next(), 4));
    for (std::uint32_t i = 0; i < nx; ++i) values[2 * nx + i] = 0; // an empty row
    PiecewiseConstant2D d(values, nx, ny, {-1, 2}, {1, 5});
    auto r =
        rectangle_chi_squared_test([&](Vec2f u) { return d.sample(u).p; }, [&](Vec2d p) { return d.pdf(p); },
                                   {-1, 2}, {1, 5}, {.cells_x = 21, .cells_y = 25});
    EXPECT_TRUE(r.passes(significance)) << r.description;
    double sum = 0, cell = 6.0 / (nx * ny);
    for (float v : values) sum += static_cast<double>(v);
    EXPECT_NEAR(d.integral(), sum * cell, 1e-12);
    for (std::uint32_t j = 0; j < ny; ++j)
        for (std::uint32_t i = 0; i < nx; ++i)
            EXPECT_NEAR(d.cell_pdf(i, j), static_cast<double>(values[j * nx + i]) / d.integral(), 1e-8);
    for (int i = 0; i < 5000; ++i) {
        Vec2d u = uniforms.next_2d();
        auto s = d.sample(u);
        ASSERT_GT(values[s.row * nx + s.column], 0);
        ASSERT_EQ(s.pdf, d.cell_pdf(s.column, s.row));
        ASSERT_DOUBLE_EQ(s.pdf, d.pdf(s.p));
        auto back = d.inverse(s.p);
        ASSERT_TRUE(back);
        ASSERT_NEAR(back->x, u.x, 1e-12);
        ASSERT_NEAR(back->y, u.y, 1e-12);
    }
    EXPECT_EQ(d.pdf(Vec2f{-1.5f, 3}), 0);
    EXPECT_FALSE(d.inverse(Vec2d{0, 3.5}));
}

TEST(PiecewiseConstant2D, EdgesOfTheSquareStayInDrawableCells) {
    std::vector<float> values{0, 0, 0, 0, /**/ 0, 3, 1, 0, /**/ 0, 0, 0, 0};
    PiecewiseConstant2D d(values, 4, 3);
    for (float x : {0.0f, 0.5f, one_minus_epsilon, 1.0f})
        for (float y : {0.0f, 0.5f, one_minus_epsilon, 1.0f}) {
            auto s = d.sample(Vec2f{x, y});
            EXPECT_GT(values[s.row * 4 + s.column], 0);
            EXPECT_TRUE(s.p.x < 1 && s.p.y < 1);
        }
}

TEST(PiecewiseConstant2D, CellsOfTallAndWideTablesHaveTheirDensity) {
    struct Size {
        std::uint32_t columns, rows;
    };
    for (const Size size : {Size{2, 5}, Size{5, 2}, Size{1, 4}, Size{4, 1}}) {
        const auto [nx, ny] = size;
        std::vector<double> values(nx * ny);
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<double>(1 + i * i);
        const PiecewiseConstant2D d(values, nx, ny);
        for (std::uint32_t j = 0; j < ny; ++j)
            for (std::uint32_t i = 0; i < nx; ++i) {
                const Vec2d middle{(i + 0.5) / nx, (j + 0.5) / ny};
                EXPECT_EQ(d.pdf(middle), d.cell_pdf(i, j)) << nx << ": " << i << ", " << j;
                const auto u = d.inverse(middle);
                ASSERT_TRUE(u);
                const auto s = d.sample(*u);
                EXPECT_TRUE(s.column == i && s.row == j) << nx << ": " << i << ", " << j;
            }
        // The far edges belong to the last cells.
        EXPECT_EQ(d.pdf(Vec2d{1, 1}), d.cell_pdf(nx - 1, ny - 1)) << nx;
        EXPECT_TRUE(d.inverse(Vec2d{1, 1})) << nx;
    }
}

// One bright cell among a million: the faint ones keep their share, and the density integrates to one.
TEST(PiecewiseConstant2D, HugeRangeLosesNothing) {
    std::uint32_t n = 1024;
    std::vector<float> values(n * n, 1e-12f);
    values[300 * n + 700] = 1e12f;
    values[5 * n + 5] = 0;
    PiecewiseConstant2D d(values, n, n);
    double sum = 0, smallest = INFINITY;
    for (std::uint32_t j = 0; j < n; ++j)
        for (std::uint32_t i = 0; i < n; ++i) {
            sum += d.cell_pdf(i, j) / (n * n);
            if (i != 5 || j != 5) smallest = std::min(smallest, d.cell_pdf(i, j));
        }
    EXPECT_NEAR(sum, 1, 1e-9);
    EXPECT_GT(smallest, 0);
    EXPECT_EQ(d.cell_pdf(5, 5), 0);
    EXPECT_GT(d.cell_pdf(700, 300) / (n * n), 0.999);
}

// A table large enough for its guide to matter: every draw lands where the inverse says.
TEST(PiecewiseConstant2D, LargeTableWithGapsAndPeaks) {
    std::uint32_t nx = 301, ny = 129;
    std::vector<double> values(nx * ny);
    TestUniforms uniforms(6);
    for (double& v : values) v = uniforms.next() < 0.5 ? 0 : std::pow(uniforms.next(), 30);
    PiecewiseConstant2D d(values, nx, ny);
    double worst = 0;
    for (int i = 0; i < 100000; ++i) {
        Vec2d u = uniforms.next_2d();
        auto s = d.sample(u);
        ASSERT_GT(values[s.row * nx + s.column], 0);
        auto back = d.inverse(s.p);
        ASSERT_TRUE(back);
        worst = std::max({worst, std::abs(back->x - u.x), std::abs(back->y - u.y)});
    }
    EXPECT_LT(worst, 1e-12);
    auto r =
        rectangle_chi_squared_test([&](Vec2d u) { return d.sample(u).p; }, [&](Vec2d p) { return d.pdf(p); },
                                   {0, 0}, {1, 1}, {.cells_x = 43, .cells_y = 43});
    EXPECT_TRUE(r.passes(significance)) << r.description;
}

TEST(PiecewiseConstant2D, AllZeroIsUniformAndBadInputGetsASentence) {
    std::vector<float> zeros(6);
    PiecewiseConstant2D d(zeros, 3, 2);
    EXPECT_EQ(d.integral(), 0);
    EXPECT_NEAR(d.pdf(Vec2f{0.9f, 0.1f}), 1, 1e-6f);
    EXPECT_THROW(PiecewiseConstant2D(zeros, 4, 2), Error);
    EXPECT_THROW(PiecewiseConstant2D(zeros, 3, 2, {0, 0}, {0, 1}), Error);
    std::vector<float> bad{1, 1, 1, 1, 1, NAN};
    EXPECT_THROW(PiecewiseConstant2D(bad, 3, 2), Error);
    EXPECT_EQ(PiecewiseConstant1D(std::vector<double>{0, 0}, 0, 4).pdf(1.0), 0.25);
    EXPECT_EQ(PiecewiseLinear1D(std::vector<double>{0, 0}, 0, 4).pdf(1.0), 0.25);
    EXPECT_THROW(PiecewiseConstant1D(std::vector<double>{1}, 2, 2), Error);
    EXPECT_THROW(PiecewiseLinear1D(std::vector<double>{1}), Error);
    EXPECT_THROW((PiecewiseLinear1D{std::vector<double>{0, 0}, std::vector<double>{1, 1}}), Error);
}

TEST(PiecewiseBilinear2D, SamplesFollowTheFunction) {
    const std::vector<float> x{-1, -0.5f, 1, 2, 2.25f}, y{0, 0.5f, 1, 2};
    const std::vector<float> values{0,      3, 1, 0, 0, /**/ 2, 0, 4, 0, 0,
                                    /**/ 1, 1, 1, 0, 0, /**/ 7, 0, 0, 2, 0};
    const std::vector<double> scale{1, 0.5, 2};
    const PiecewiseBilinear2D d(x, y, values, scale);
    auto f = [&](Vec2d p) {
        std::size_t i = 0, j = 0;
        while (i + 2 < x.size() && p.x >= static_cast<double>(x[i + 1])) ++i;
        while (j + 2 < y.size() && p.y >= static_cast<double>(y[j + 1])) ++j;
        auto at = [&](std::size_t a, std::size_t b) { return static_cast<double>(values[b * x.size() + a]); };
        const double s = (p.x - static_cast<double>(x[i])) / static_cast<double>(x[i + 1] - x[i]);
        const double t = (p.y - static_cast<double>(y[j])) / static_cast<double>(y[j + 1] - y[j]);
        return scale[j] * ((1 - t) * ((1 - s) * at(i, j) + s * at(i + 1, j)) +
                           t * ((1 - s) * at(i, j + 1) + s * at(i + 1, j + 1)));
    };
    auto r = rectangle_chi_squared_test([&](Vec2f u) { return d.sample(u).p; },
                                        [&](Vec2d p) { return f(p) / d.integral(); }, {-1, 0}, {2.25, 2},
                                        {.cells_x = 26, .cells_y = 16});
    EXPECT_TRUE(r.passes(significance)) << r.description;
    TestUniforms uniforms(4);
    for (int i = 0; i < 5000; ++i) {
        const auto s = d.sample(uniforms.next_2f());
        ASSERT_NEAR(static_cast<double>(s.pdf), f(Vec2d(s.p)) / d.integral(), 1e-5);
        ASSERT_GT(s.pdf, 0);
        const Vec2f p{static_cast<float>(3.25 * uniforms.next() - 1),
                      static_cast<float>(2 * uniforms.next())};
        ASSERT_NEAR(static_cast<double>(d.pdf(p)), f(Vec2d(p)) / d.integral(), 1e-5);
    }
    EXPECT_EQ(d.pdf({2.3f, 1}), 0);
    EXPECT_EQ(d.pdf({2.1f, 0.7f}), 0); // a cell without light
}

TEST(PiecewiseBilinear2D, AllZeroIsUniformAndBadInputGetsASentence) {
    const PiecewiseBilinear2D d({0, 1, 2}, {0, 1}, std::vector<float>(6));
    EXPECT_EQ(d.integral(), 0);
    EXPECT_NEAR(d.pdf({0.3f, 0.4f}), 0.5f, 1e-6f);
    EXPECT_THROW(PiecewiseBilinear2D({0, 1}, {0, 1}, std::vector<float>(5)), Error);
    EXPECT_THROW(PiecewiseBilinear2D({0, 0}, {0, 1}, std::vector<float>(4)), Error);
    EXPECT_THROW(PiecewiseBilinear2D({0, 1}, {0}, std::vector<float>(2)), Error);
    EXPECT_THROW(PiecewiseBilinear2D({0, 1}, {0, 1}, std::vector<float>{1, 1, 1, -1}), Error);
    EXPECT_THROW(PiecewiseBilinear2D({0, 1}, {0, 1}, std::vector<float>(4), std::vector<double>{1, 1}),
                 Error);
}

} // namespace
} // namespace montelux
