#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <vector>

#include "montelux/mc/math/error.h"
#include "montelux/mc/random/discrepancy.h"
#include "montelux/mc/random/point_set.h"

namespace montelux {
namespace {

std::vector<Vec2d> planar(PointSetKind kind, std::uint32_t n) {
    const PointSet set({kind, 2, n, Randomisation::none, 3});
    std::vector<Vec2d> p;
    for (std::uint32_t i = 0; i < n; ++i) p.emplace_back(set(i, 0), set(i, 1));
    return p;
}

// From the definition: open and closed boxes whose corner takes its coordinates from the points or 1.
double brute_force(const std::vector<Vec2d>& points) {
    std::vector<double> xs = {1}, ys = {1};
    for (Vec2d p : points) {
        xs.push_back(p.x);
        ys.push_back(p.y);
    }
    const double n = static_cast<double>(points.size());
    double largest = 0;
    for (double x : xs)
        for (double y : ys) {
            double open = 0, closed = 0;
            for (Vec2d p : points) {
                open += p.x < x && p.y < y;
                closed += p.x <= x && p.y <= y;
            }
            largest = std::max({largest, x * y - open / n, closed / n - x * y});
        }
    return largest;
}

TEST(Discrepancy, StarOnTheLine) {
    for (int n : {1, 4, 9}) {
        std::vector<double> centred;
        for (int i = n; i-- > 0;) centred.push_back((i + 0.5) / n);
        EXPECT_NEAR(star_discrepancy(centred), 0.5 / n, 1e-15); // the least that n points can have
        EXPECT_NEAR(l2_star_discrepancy(centred, 1), 1 / (std::sqrt(12.0) * n), 1e-13);
    }
    EXPECT_DOUBLE_EQ(star_discrepancy(std::vector<double>{0.0}), 1);
}

TEST(Discrepancy, StarInThePlane) {
    EXPECT_DOUBLE_EQ(star_discrepancy(std::vector<Vec2d>{{0.5, 0.5}}), 0.75);
    EXPECT_DOUBLE_EQ(star_discrepancy(std::vector<Vec2d>{{0.0, 0.0}}), 1);
    EXPECT_DOUBLE_EQ(star_discrepancy(std::vector<Vec2d>{{0.9, 0.8}}), 0.9); // the empty box up to (0.9, 1)
    EXPECT_DOUBLE_EQ(star_discrepancy(std::vector<Vec2d>{}), 1);
    EXPECT_DOUBLE_EQ(star_discrepancy(std::vector<Vec2d>{{0.2, 0.3}, {0.2, 0.3}, {0.2, 0.9}}),
                     brute_force({{0.2, 0.3}, {0.2, 0.3}, {0.2, 0.9}})); // ties
    for (auto kind : {PointSetKind::independent, PointSetKind::halton, PointSetKind::sobol,
                      PointSetKind::weyl, PointSetKind::golden_ratio})
        for (bool mirrored : {false, true}) {
            auto p = planar(kind, 60);
            if (mirrored)
                for (Vec2d& v : p) v = Vec2d(1, 1) - v;
            EXPECT_NEAR(star_discrepancy(p), brute_force(p), 1e-14) << to_string(kind) << mirrored;
        }
}

// n D* = m/3 + 13/9 - (-1)^m 4 / (9 n) for n = 2^m, m > 1: De Clerck 1986, "A method for exact calculation of
// the star-discrepancy of plane sets applied to the sequences of Hammersley".
TEST(Discrepancy, HammersleyKnownValues) {
    for (int m = 2; m <= 10; ++m) {
        const std::uint32_t n = 1u << m;
        const double expected = m / 3.0 + 13 / 9.0 - (m % 2 ? -1 : 1) * 4 / (9.0 * n);
        EXPECT_NEAR(n * star_discrepancy(planar(PointSetKind::hammersley, n)), expected, 1e-9) << m;
    }
}

TEST(Discrepancy, L2KnownValueAndOrder) {
    const std::vector<double> centre = {0.5, 0.5};
    EXPECT_NEAR(l2_star_discrepancy(centre, 2), std::sqrt(1 / 9.0 - 0.28125 + 0.25), 1e-14);
    const auto of = [](PointSetKind kind) {
        std::vector<double> flat;
        for (Vec2d p : planar(kind, 512)) flat.insert(flat.end(), {p.x, p.y});
        return l2_star_discrepancy(flat, 2);
    };
    for (auto kind : {PointSetKind::halton, PointSetKind::hammersley, PointSetKind::sobol, PointSetKind::weyl,
                      PointSetKind::golden_ratio})
        EXPECT_LT(of(kind), 0.5 * of(PointSetKind::independent)) << to_string(kind);
    EXPECT_THROW(l2_star_discrepancy(centre, 3), Error);
}

} // namespace
} // namespace montelux
