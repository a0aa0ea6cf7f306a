// Polygons become triangles that cover the same area, once.
#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <vector>

#include "montelux/formats/triangulate.h"
#include "montelux/mc/math/constants.h"

namespace montelux {
namespace {

double signed_area(std::span<const Point3f> corners, const Triangulator::Triangle& t) {
    const Vec3d a(corners[t[0]]), b(corners[t[1]]), c(corners[t[2]]);
    return 0.5 * cross(b - a, c - a).z;
}

TEST(Triangulate, StarsAreCoveredOnce) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> radius(0.2, 1);
    Triangulator triangulator;
    for (int n = 4; n <= 40; ++n) {
        std::vector<Point3f> star;
        double expected = 0;
        for (int i = 0; i < n; ++i) {
            const double r = radius(random), a = 2 * pi * i / n;
            star.push_back(Vec3f(Vec3d{r * std::cos(a), r * std::sin(a), 0}));
        }
        for (int i = 0; i < n; ++i)
            expected += 0.5 * cross(Vec3d(star[static_cast<std::size_t>(i)]),
                                    Vec3d(star[static_cast<std::size_t>((i + 1) % n)]))
                                  .z;
        for (const bool reversed : {false, true}) {
            if (reversed) std::reverse(star.begin(), star.end());
            const auto triangles = triangulator.split(star);
            ASSERT_EQ(triangles.size(), static_cast<std::size_t>(n - 2));
            double sum = 0;
            for (const Triangulator::Triangle& t : triangles) {
                const double area = (reversed ? -1 : 1) * signed_area(star, t);
                EXPECT_GE(area, -1e-6);
                sum += area;
            }
            EXPECT_NEAR(sum, expected, 1e-6) << n;
        }
    }
    EXPECT_EQ(triangulator.fans(), 0u);
}

TEST(Triangulate, ConvexPolygonsAreFans) {
    const std::vector<Point3f> square{{0, 0, 5}, {1, 0, 5}, {1, 1, 5}, {0, 1, 5}};
    Triangulator triangulator;
    const auto triangles = triangulator.split(square);
    EXPECT_EQ(triangles[0], (Triangulator::Triangle{0, 1, 2}));
    EXPECT_EQ(triangles[1], (Triangulator::Triangle{0, 2, 3}));
    // A dart: the diagonal that lies inside.
    const std::vector<Point3f> dart{{0, 0, 0}, {2, 1, 0}, {0, 2, 0}, {1, 1, 0}};
    for (const Triangulator::Triangle& t : triangulator.split(dart)) EXPECT_GE(signed_area(dart, t), 0);
}

TEST(Triangulate, HopelessPolygonsStayWithinTheirCorners) {
    Triangulator triangulator;
    const std::vector<Point3f> bow{{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}; // crosses itself
    EXPECT_EQ(triangulator.split(bow).size(), 2u);
    const std::vector<Point3f> point(6, Point3f{1, 1, 1});
    EXPECT_EQ(triangulator.split(point).size(), 4u);
    std::vector<Point3f> many;
    for (std::size_t i = 0; i <= Triangulator::most_clipped; ++i)
        many.push_back({static_cast<float>(i % 2), static_cast<float>(i), 0});
    const std::size_t before = triangulator.fans();
    EXPECT_EQ(triangulator.split(many).size(), many.size() - 2);
    EXPECT_EQ(triangulator.fans(), before + 1);
}

} // namespace
} // namespace montelux
