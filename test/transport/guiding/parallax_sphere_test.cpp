// Directions from any point of a region, as directions from its centre.
#include <cmath>
#include <gtest/gtest.h>
#include <vector>

#include "montelux/mc/stats/chi_squared.h"
#include "montelux/mc/stats/moments.h"
#include "montelux/mc/warp/sphere.h"
#include "montelux/transport/guiding/guiding_field.h"

namespace montelux {
namespace {

const ParallaxSphere sphere{{1, 2, -3}, 2};

// Within the sphere, and so far outside that another one takes its place.
Point3f point(TestUniforms& u, double reach) {
    return sphere.centre + static_cast<float>(reach) * sample_uniform_sphere(u.next_2f());
}

TEST(ParallaxSphere, ComesBackFromItsInverse) {
    TestUniforms u(1);
    for (int i = 0; i < 10000; ++i) {
        const Point3f p = point(u, i % 2 == 0 ? 2 * u.next() : 20 * u.next());
        const Vec3f wi = sample_uniform_sphere(u.next_2f());
        const ParallaxSphere::Mapped there = sphere.from_centre(p, wi);
        const ParallaxSphere::Mapped back = sphere.from_point(p, there.w);
        ASSERT_NEAR(double(length(there.w)), 1, 1e-5);
        ASSERT_LT(length(back.w - wi), 1e-4f);
        ASSERT_NEAR(double(back.density), double(there.density), 1e-3 * double(there.density));
    }
}

// A point of the sphere lies in the same place for all points from where it is seen.
TEST(ParallaxSphere, DirectionsMeetOnTheSphere) {
    TestUniforms u(2);
    for (int i = 0; i < 1000; ++i) {
        const Vec3f w = sample_uniform_sphere(u.next_2f());
        const Point3f p = point(u, 1.2 * u.next()), seen = sphere.centre + sphere.radius * w;
        ASSERT_LT(length(sphere.from_point(p, w).w - normalize(seen - p)), 1e-5f);
    }
    // Without a radius directions stay as they are.
    const Vec3f w = normalize(Vec3f{1, 2, 3});
    EXPECT_EQ(ParallaxSphere{}.from_centre({5, 5, 5}, w).w, w);
    EXPECT_EQ(ParallaxSphere{}.from_point({5, 5, 5}, w).density, 1);
}

// The solid angles of all directions add up to that of the sphere. 6 tests at 5 standard errors: 3e-6.
TEST(ParallaxSphere, DensitiesIntegrateToOne) {
    TestUniforms u(3);
    for (const double reach : {0.1, 0.5, 1.0, 1.3, 1.9, 40.0}) {
        const Point3f p = point(u, reach);
        RunningMoments density;
        for (int i = 0; i < 20000; ++i)
            density.add(double(sphere.from_centre(p, sample_uniform_sphere(u.next_2f())).density));
        EXPECT_LT(std::abs(density.mean() - 1), 5 * density.standard_error()) << reach;
        EXPECT_LT(density.standard_error(), 0.01);
    }
}

// What a region draws has the density that it reports: in all directions, and in cones. 63 tests at 5 standard errors: 4e-5.
TEST(ParallaxSphere, RegionsReportTheDensityOfWhatTheyDraw) {
    TestUniforms u(4);
    GuidingRegion region;
    region.sphere = sphere;
    std::vector<SquareSample> samples;
    for (int i = 0; i < 20000; ++i) {
        const Vec2f v = u.next_2f();
        samples.push_back({v, v.x > 0.7f && v.y < 0.4f ? 3 : 0.1f, 1});
    }
    region.directions = QuadtreeDensity(samples, {});
    for (const double reach : {0.3, 1.2, 5.0}) {
        const Point3f p = point(u, reach);
        RunningMoments pdf;
        int off = 0;
        for (int i = 0; i < 20000; ++i) {
            pdf.add(double(region.pdf(p, sample_uniform_sphere(u.next_2f()))) * 4 * pi);
            const GuidingRegion::Direction d = region.sample(p, u.next_2f());
            const double relative = double(region.pdf(p, d.wi)) / double(d.pdf);
            off += !(std::abs(relative - 1) < 2e-3); // or it has fallen into the next square
        }
        EXPECT_LT(std::abs(pdf.mean() - 1), 5 * pdf.standard_error()) << reach;
        EXPECT_LT(off, 20) << reach;
        for (int cone = 0; cone < 20; ++cone) {
            const Vec3f axis = sample_uniform_sphere(u.next_2f());
            RunningMoments drawn, expected;
            for (int i = 0; i < 5000; ++i) {
                drawn.add(dot(region.sample(p, u.next_2f()).wi, axis) > 0.8f ? 1 : 0);
                const Vec3f wi = sample_uniform_sphere(u.next_2f());
                expected.add(dot(wi, axis) > 0.8f ? double(region.pdf(p, wi)) * 4 * pi : 0);
            }
            EXPECT_LT(std::abs(drawn.mean() - expected.mean()),
                      5 * std::hypot(drawn.standard_error(), expected.standard_error()) + 1e-3)
                << reach << " " << cone;
        }
    }
}

} // namespace
} // namespace montelux
