// Densities restricted to windows. Seven chi-squared tests at 1e-8 each: below 1e-7 for the file.
#include "test/mc/dist/message_of.h"
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <vector>

#include "montelux/mc/dist/windowed_2d.h"
#include "montelux/mc/stats/chi_squared.h"

namespace montelux {
namespace {

constexpr std::uint32_t table_columns = 9, table_rows = 7;
const Window2D domain{{-1, 2}, {3.5, 5.5}}; // cells of side 1/2

std::vector<double> table_values() {
    std::vector<double> values(table_columns * table_rows);
    TestUniforms uniforms(4);
    for (double& v : values) v = uniforms.next() < 0.3 ? 0 : std::pow(uniforms.next(), 4);
    for (std::uint32_t i = 0; i < table_columns; ++i) values[2 * table_columns + i] = 0; // an empty row
    for (std::uint32_t j = 0; j < table_rows; ++j) values[j * table_columns + 3] = 0;    // an empty column
    return values;
}

// Of the pieces into which lines 1/4 apart cut the domain: what the window has of each times its value.
std::vector<double> pieces_of(const std::vector<double>& values, const Window2D& w) {
    std::vector<double> pieces;
    for (std::uint32_t j = 0; j < 2 * table_rows; ++j)
        for (std::uint32_t i = 0; i < 2 * table_columns; ++i) {
            const double x = domain.lower.x + 0.25 * i, y = domain.lower.y + 0.25 * j;
            const double width = std::min(x + 0.25, w.upper.x) - std::max(x, w.lower.x);
            const double height = std::min(y + 0.25, w.upper.y) - std::max(y, w.lower.y);
            pieces.push_back(std::max(0.0, width) * std::max(0.0, height) *
                             values[j / 2 * table_columns + i / 2]);
        }
    return pieces;
}

TEST(WindowedPiecewise2D, SamplesFollowTheTableWithinTheWindow) {
    const std::vector<double> values = table_values();
    const WindowedPiecewise2D d(values, table_columns, table_rows, domain);
    const Window2D windows[] = {
        domain,
        {{-0.3, 2.2}, {2.9, 5.3}},  // ends within cells
        {{-5, -5}, {9, 9}},         // reaches over the domain
        {{-1, 2.7}, {2.25, 4.1}},   // ends on and between cells
        {{1.1, 2.1}, {1.3, 5.2}},   // within a column
        {{-0.9, 3.6}, {3.3, 3.9}},  // within a row
        {{2.05, 4.55}, {2.3, 4.9}}, // within a cell
    };
    TestUniforms uniforms(8);
    for (const Window2D& w : windows) {
        std::vector<double> expected = pieces_of(values, w), counts(expected.size());
        double sum = 0;
        for (double e : expected) sum += e;
        ASSERT_GT(sum, 0);
        const int n = 100000;
        for (int i = 0; i < n; ++i) {
            const Vec2d u = uniforms.next_2d();
            const auto s = d.sample(u, w);
            ASSERT_TRUE(s);
            const auto x = static_cast<std::size_t>((s->p.x - domain.lower.x) / 0.25),
                       y = static_cast<std::size_t>((s->p.y - domain.lower.y) / 0.25);
            counts.at(y * 2 * table_columns + x) += 1;
            ASSERT_NEAR(s->pdf * sum, values[y / 2 * table_columns + x / 2], 1e-12);
            ASSERT_NEAR(d.pdf(s->p, w), s->pdf, 1e-12 * s->pdf);
            ASSERT_TRUE(w.contains(s->p));
        }
        for (double& e : expected) e *= n / sum;
        const TestResult r = chi_squared_test(counts, expected);
        EXPECT_TRUE(r.passes(1e-8)) << w.lower.x << " " << w.lower.y << ": " << r.description;
    }
    EXPECT_EQ(d.pdf({-0.4, 3}, windows[1]), 0);
    EXPECT_EQ(d.pdf({-1.1, 3}, windows[2]), 0);
}

TEST(WindowedPiecewise2D, NothingInTheWindowGivesNoSample) {
    const WindowedPiecewise2D d(table_values(), table_columns, table_rows, domain);
    const Window2D empty[] = {
        {{-1, 3}, {3.5, 3.5}}, // the empty row
        {{0.6, 2}, {0.9, 5}},  // within the empty column
        {{1, 3}, {1, 4}},      // no width
        {{2, 3}, {1, 4}},      // turned around
        {{4, 2}, {5, 5}},      // beyond the domain
        {{NAN, 2}, {NAN, 5}},
    };
    for (const Window2D& w : empty) {
        EXPECT_FALSE(d.sample({0.5, 0.5}, w));
        EXPECT_EQ(d.pdf({0.7, 3.2}, w), 0);
    }
}

// The sum over a dark window is a difference of sums over what is brighter by many orders.
TEST(WindowedPiecewise2D, DarkWindowsBesideGlareAreExact) {
    const std::uint32_t n = 512;
    std::vector<double> values(n * n);
    TestUniforms uniforms(3);
    for (double& v : values) v = 1 + uniforms.next();
    for (std::uint32_t i = 0; i < n; ++i) values[100 * n + i] = values[i * n + 100] = 1e9;
    values[300 * n + 300] = 0;
    const WindowedPiecewise2D d(values, n, n);
    const double side = 1.0 / n;
    const Window2D w{{300.5 * side, 299.25 * side}, {302.5 * side, 301.5 * side}};
    double sum = 0;
    auto value = [&](std::uint32_t x, std::uint32_t y) { return values[y * n + x]; };
    const double height[] = {0.75, 1, 0.5}, width[] = {0.5, 1, 0.5};
    for (std::uint32_t y = 0; y < 3; ++y)
        for (std::uint32_t x = 0; x < 3; ++x) sum += width[x] * height[y] * value(300 + x, 299 + y);
    for (int i = 0; i < 1000; ++i) {
        const auto s = d.sample(uniforms.next_2d(), w);
        ASSERT_TRUE(s);
        const auto x = static_cast<std::uint32_t>(s->p.x * n), y = static_cast<std::uint32_t>(s->p.y * n);
        ASSERT_FALSE(x == 300 && y == 300);
        ASSERT_NEAR(s->pdf * sum * side * side / value(x, y), 1, 1e-5);
    }
}

// Cells of any positive value are drawn in their window; zero cells are not.
TEST(WindowedPiecewise2D, TheFaintestCellsBesideGlareAreDrawn) {
    const std::vector<double> values{0, 1e-300, 1e-30, 1};
    const WindowedPiecewise2D d(values, 4, 1);
    EXPECT_FALSE(d.sample({0.5, 0.5}, {{0, 0}, {0.25, 1}}));
    for (const double left : {0.25, 0.5}) {
        const Window2D w{{left - 0.25, 0}, {left + 0.25, 1}};
        for (const double u : {0.0, 0.5, 0.875}) {
            const auto s = d.sample({u, 0.5}, w);
            ASSERT_TRUE(s) << left;
            EXPECT_GE(s->p.x, 0.25);
            EXPECT_GT(s->pdf, 0);
            EXPECT_EQ(d.pdf(s->p, w), s->pdf);
        }
    }
    for (const double x : {0.3, 0.6}) EXPECT_GT(d.pdf({x, 0.5}, {{0, 0}, {1, 1}}), 0) << x;
}

TEST(WindowedPiecewise2D, EdgesOfTheSquareStayInDrawableCells) {
    const std::vector<double> values{0, 0, 0, 0, /**/ 0, 3, 1, 0, /**/ 0, 0, 0, 0};
    const WindowedPiecewise2D d(values, 4, 3);
    for (const Window2D& w : {Window2D{{0, 0}, {1, 1}}, Window2D{{0.3, 0.1}, {0.9, 0.9}}})
        for (double x : {0.0, 0.75, 1 - 0x1p-53, 1.0})
            for (double y : {0.0, 0.5, 1 - 0x1p-53, 1.0}) {
                const auto s = d.sample({x, y}, w);
                ASSERT_TRUE(s);
                EXPECT_GT(s->pdf, 0);
                EXPECT_TRUE(s->p.x >= 0.25 && s->p.x <= 0.75 && s->p.y * 3 >= 1 && s->p.y * 3 <= 2 + 1e-15);
            }
}

TEST(WindowedPiecewise2D, AllZeroIsUniformAndBadInputGetsASentence) {
    const std::vector<double> zeros(6);
    const WindowedPiecewise2D d(zeros, 3, 2);
    EXPECT_NEAR(d.pdf({0.3, 0.4}, {{0.25, 0.25}, {0.5, 0.75}}), 8, 1e-12);
    EXPECT_EQ(message_of([&] { WindowedPiecewise2D(zeros, 4, 2); }),
              "WindowedPiecewise2D: found 6 values; expected columns * rows = 4 * 2, at most 2^31");
    EXPECT_EQ(message_of([&] {
                  WindowedPiecewise2D(zeros, 3, 2, {{0, 0}, {0, 1}});
              }),
              "WindowedPiecewise2D: the domain is empty or not finite");
    EXPECT_NE(message_of([] { WindowedPiecewise2D(std::vector<double>{1, NAN}, 2, 1); }), "no error");
}

} // namespace
} // namespace montelux
