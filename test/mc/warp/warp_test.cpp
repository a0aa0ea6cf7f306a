// Every two-dimensional warp goes through the same four tests: samples follow the density (chi-squared),
// inverse and sample undo each other, 1/p is the area that a cell of the square is scaled to, and the
// edges of the square give finite points.
#include <functional>
#include <gtest/gtest.h>
#include <string>

#include "montelux/mc/stats/chi_squared.h"
#include "montelux/mc/warp/cone.h"
#include "montelux/mc/warp/cosine.h"
#include "montelux/mc/warp/equal_area_square.h"
#include "montelux/mc/warp/hemisphere.h"
#include "montelux/mc/warp/linear.h"
#include "montelux/mc/warp/sphere.h"
#include "montelux/mc/warp/spherical_rectangle.h"
#include "montelux/mc/warp/spherical_triangle.h"
#include "montelux/mc/warp/triangle.h"

namespace montelux {
namespace {

// Plane warps are embedded in z = 0.
struct Warp {
    std::string name;
    bool on_sphere;
    std::function<Vec3d(Vec2d)> sample;
    std::function<Vec2d(Vec3d)> inverse;
    std::function<Vec3f(Vec2f)> sample_f;
    std::function<Vec2f(Vec3f)> inverse_f;
    std::function<double(Vec3d)> pdf; // per unit area or steradian; 0 outside the support
    Vec2d lower{-1, -1}, upper{1, 1}; // bounds of plane warps
    double cos_theta_min = -1;
};

template <typename Sample, typename Inverse>
Warp plane(std::string name, Sample s, Inverse inv, std::function<double(Vec3d)> pdf, Vec2d lower,
           Vec2d upper) {
    auto sample = [s](auto u) {
        auto p = s(u);
        return Vec3<decltype(p.x)>(p.x, p.y, 0);
    };
    auto inverse = [inv](auto p) { return inv(Vec2<decltype(p.x)>(p.x, p.y)); };
    return {std::move(name), false, sample, inverse, sample, inverse, std::move(pdf), lower, upper};
}
template <typename Sample, typename Inverse>
Warp sphere(std::string name, Sample s, Inverse inv, std::function<double(Vec3d)> pdf,
            double cos_theta_min = -1) {
    Warp w{std::move(name), true, s, inv, s, inv, std::move(pdf)};
    w.cos_theta_min = cos_theta_min;
    return w;
}

// Barycentrics (b0, b1) of a triangle of area 1/2.
template <typename Sample, typename Inverse>
Warp triangle(std::string name, Sample s, Inverse inv) {
    return plane(
        std::move(name),
        [s](auto u) {
            auto b = s(u);
            return Vec2<decltype(b.x)>(b.x, b.y);
        },
        [inv](auto p) { return inv(Vec3<decltype(p.x)>(p.x, p.y, 1 - p.x - p.y)); },
        [](Vec3d p) { return p.x >= 0 && p.y >= 0 && p.x + p.y <= 1 ? uniform_triangle_pdf(0.5) : 0.0; },
        {0, 0}, {1, 1});
}

Warp spherical_triangle(std::string name, Vec3d a, Vec3d b, Vec3d c) {
    SphericalTriangle t = SphericalTriangle::from_directions(a, b, c).value();
    double sign = dot(a, cross(b, c)) < 0 ? -1 : 1;
    auto pdf = [=](Vec3d w) {
        bool in = dot(w, cross(a, b)) * sign >= 0 && dot(w, cross(b, c)) * sign >= 0 &&
                  dot(w, cross(c, a)) * sign >= 0;
        return in ? t.pdf<double>() : 0.0;
    };
    return sphere(
        std::move(name), [t](auto u) { return t.sample(u); }, [t](auto w) { return t.inverse(w); }, pdf);
}
Warp spherical_rectangle(std::string name, Vec3d from, Vec3d corner, Vec3d ex, Vec3d ey) {
    SphericalRectangle r = SphericalRectangle::from_corner(from, corner, ex, ey).value();
    auto pdf = [=](Vec3d w) {
        Vec3d n = cross(ex, ey), d = corner - from;
        double t = dot(d, n) / dot(w, n);
        if (!(t > 0)) return 0.0;
        Vec3d p = w * t - d;
        double s = dot(p, ex) / dot(ex, ex), q = dot(p, ey) / dot(ey, ey);
        return s >= 0 && s <= 1 && q >= 0 && q <= 1 ? r.pdf<double>() : 0.0;
    };
    return sphere(
        std::move(name), [r](auto u) { return r.sample(u); }, [r](auto w) { return r.inverse(w); }, pdf);
}

constexpr double cone_cos = 0.4;

std::vector<Warp> all_warps() {
    auto in_disk = [](Vec3d p) { return p.x * p.x + p.y * p.y <= 1 ? uniform_disk_pdf<double>() : 0.0; };
    std::vector<Warp> w;
    w.push_back(plane(
        "DiskPolar", [](auto u) { return sample_uniform_disk_polar(u); },
        [](auto p) { return invert_uniform_disk_polar(p); }, in_disk, {-1, -1}, {1, 1}));
    w.push_back(plane(
        "DiskConcentric", [](auto u) { return sample_uniform_disk_concentric(u); },
        [](auto p) { return invert_uniform_disk_concentric(p); }, in_disk, {-1, -1}, {1, 1}));
    w.push_back(triangle(
        "Triangle", [](auto u) { return sample_uniform_triangle(u); },
        [](auto b) { return invert_uniform_triangle(b); }));
    w.push_back(triangle(
        "TriangleLowDistortion", [](auto u) { return sample_uniform_triangle_low_distortion(u); },
        [](auto b) { return invert_uniform_triangle_low_distortion(b); }));
    w.push_back(plane(
        "Bilinear",
        [](auto u) {
            using T = decltype(u.x);
            return sample_bilinear(u, std::array<T, 4>{1, 2, T(0.5), 6});
        },
        [](auto p) {
            using T = decltype(p.x);
            return invert_bilinear(p, std::array<T, 4>{1, 2, T(0.5), 6});
        },
        [](Vec3d p) {
            return bilinear_pdf(Vec2d(p.x, p.y), std::array<double, 4>{1, 2, 0.5, 6});
        },
        {0, 0}, {1, 1}));
    w.push_back(plane(
        "CosineTimesUniform", // B3: p(x, y) = cos x on [0, pi/2) x [0, 1)
        [](auto u) {
            u.x = sample_cosine(u.x);
            return u;
        },
        [](auto p) {
            p.x = invert_cosine(p.x);
            return p;
        },
        [](Vec3d p) { return cosine_pdf(p.x); }, {0, 0}, {pi / 2, 1}));
    w.push_back(sphere(
        "Sphere", [](auto u) { return sample_uniform_sphere(u); },
        [](auto d) { return invert_uniform_sphere(d); }, [](Vec3d) { return uniform_sphere_pdf<double>(); }));
    w.push_back(sphere(
        "Hemisphere", [](auto u) { return sample_uniform_hemisphere(u); },
        [](auto d) { return invert_uniform_hemisphere(d); },
        [](Vec3d d) { return d.z >= 0 ? uniform_hemisphere_pdf<double>() : 0.0; }));
    w.push_back(sphere(
        "CosineHemisphere", [](auto u) { return sample_cosine_hemisphere(u); },
        [](auto d) { return invert_cosine_hemisphere(d); },
        [](Vec3d d) { return cosine_hemisphere_pdf(d.z); }));
    auto cone = [](std::string name, double c) {
        return sphere(
            std::move(name), [c](auto u) { return sample_uniform_cone(u, static_cast<decltype(u.x)>(c)); },
            [c](auto d) { return invert_uniform_cone(d, static_cast<decltype(d.x)>(c)); },
            [c](Vec3d d) { return d.z >= c ? uniform_cone_pdf(c) : 0.0; });
    };
    w.push_back(cone("ConeHalf", cone_cos));
    w.push_back(cone("ConeWiderThanHemisphere", -0.6));
    double versine = 1e-5;
    w.push_back(sphere(
        "ConeNarrow",
        [=](auto u) { return sample_uniform_cone_from_versine(u, static_cast<decltype(u.x)>(versine)); },
        [=](auto d) { return invert_uniform_cone_from_versine(d, static_cast<decltype(d.x)>(versine)); },
        [=](Vec3d d) {
            // The versine by way of the sine: a float cosine has no digits left here.
            return d.z > 0 && (d.x * d.x + d.y * d.y) / (1 + d.z) <= versine
                       ? uniform_cone_pdf_from_versine(versine)
                       : 0.0;
        },
        1 - 1e-4));
    w.push_back(sphere(
        "EqualAreaSquare", [](auto u) { return equal_area_square_to_sphere(u); },
        [](auto d) { return equal_area_sphere_to_square(d); },
        [](Vec3d) { return uniform_sphere_pdf<double>(); }));
    w.push_back(spherical_triangle("SphericalTriangleOctant", {1, 0, 0}, {0, 1, 0}, {0, 0, 1}));
    w.push_back(spherical_triangle("SphericalTriangleTurned", {1, 0.2, 0.1}, {-0.3, 0.4, 2}, {0.2, 1, -0.5}));
    w.push_back(
        spherical_triangle("SphericalTriangleHuge", {1, 0, -0.1}, {-0.5, 0.9, -0.1}, {-0.6, -0.8, 0.05}));
    w.push_back(spherical_rectangle("SphericalRectangleAhead", {0, 0, 0}, {-1, -1, 1}, {2, 0, 0}, {0, 2, 0}));
    w.push_back(spherical_rectangle("SphericalRectangleAside", {0.1, 0.2, 0.3}, {1, 1, 1}, {1, -1, 0},
                                    {0.5, 0.5, 2}));
    return w;
}

class WarpTest : public testing::TestWithParam<Warp> {};

TEST_P(WarpTest, SamplesFollowTheDensity) {
    const Warp& w = GetParam();
    ChiSquaredOptions options;
    options.cos_theta_min = w.cos_theta_min;
    if (w.cos_theta_min > 0.99) options.cells_x = 10;
    TestResult r;
    if (w.on_sphere) {
        // Near +z the tests's own float directions are too coarse, so densities take doubles here.
        TestUniforms uniforms(2);
        CellCounts counts({w.cos_theta_min, 0}, {1, 2 * pi}, options.cells_x, options.cells_y);
        for (int i = 0; i < options.samples; ++i) {
            Vec3d d(w.sample_f(uniforms.next_2f()));
            double phi = std::atan2(d.y, d.x), s2 = d.x * d.x + d.y * d.y;
            double z = d.z > 0.9 ? std::sqrt(1 - s2) : std::clamp(d.z, -1.0, 1.0);
            counts.add({z, phi < 0 ? phi + 2 * pi : phi});
        }
        r = counts.test(
            [&](Vec2d p) {
                double s = std::sqrt((1 - p.x) * (1 + p.x));
                return w.pdf({s * std::cos(p.y), s * std::sin(p.y), p.x});
            },
            5);
    } else {
        r = rectangle_chi_squared_test(
            [&](Vec2f u) {
                Vec3f p = w.sample_f(u);
                return Vec2f(p.x, p.y);
            },
            [&](Vec2d p) {
                return w.pdf({p.x, p.y, 0});
            },
            w.lower, w.upper, options);
    }
    EXPECT_TRUE(r.passes(sidak_threshold(1e-5, 20))) << r.description;
}

TEST_P(WarpTest, InverseUndoesSample) {
    const Warp& w = GetParam();
    TestUniforms uniforms(3);
    for (int i = 0; i < 20000; ++i) {
        Vec2d u = uniforms.next_2d();
        Vec2d back = w.inverse(w.sample(u));
        ASSERT_NEAR(back.x, u.x, 1e-6) << i << " " << u.y;
        ASSERT_NEAR(back.y, u.y, 1e-6) << i << " " << u.x;
        // In float the point itself is rounded: compare where the inverse's image lands.
        Vec3f p = w.sample_f(Vec2f(u)), again = w.sample_f(w.inverse_f(p));
        ASSERT_NEAR(length(again - p), 0, 2e-5f) << u.x << " " << u.y;
    }
}

// B9: the density as change of area, |ds/du x ds/dv| = 1 / p.
TEST_P(WarpTest, InverseDensityIsTheAreaOfAWarpedCell) {
    const Warp& w = GetParam();
    TestUniforms uniforms(4);
    constexpr double h = 1e-6;
    int near_a_crease = 0;
    for (int i = 0; i < 2000; ++i) {
        Vec2d u = uniforms.next_2d() * 0.98 + Vec2d{0.01, 0.01};
        auto derivative = [&](Vec2d step) { return (w.sample(u + step) - w.sample(u - step)) / (2 * h); };
        double area = length(cross(derivative({h, 0}), derivative({0, h})));
        double p = w.pdf(w.sample(u));
        if (std::abs(area * p - 1) > 2e-4) ++near_a_crease; // concentric maps have creases: a null set
    }
    EXPECT_LE(near_a_crease, 1) << "of 2000 points";
}

TEST_P(WarpTest, EdgesOfTheSquareGiveFinitePoints) {
    const Warp& w = GetParam();
    for (float x : {0.0f, 1e-20f, 0.25f, 0.5f, one_minus_epsilon})
        for (float y : {0.0f, 1e-20f, 0.25f, 0.5f, one_minus_epsilon}) {
            Vec3f p = w.sample_f({x, y});
            ASSERT_TRUE(is_finite(p)) << x << " " << y;
            if (w.on_sphere) {
                ASSERT_NEAR(length(p), 1, 1e-6f) << x << " " << y;
            }
            Vec2f u = w.inverse_f(p);
            ASSERT_TRUE(u.x >= -1e-6f && u.x <= 1 + 1e-6f && u.y >= -1e-6f && u.y <= 1 + 1e-6f)
                << x << " " << y << " -> " << u.x << " " << u.y;
        }
}

INSTANTIATE_TEST_SUITE_P(All, WarpTest, testing::ValuesIn(all_warps()),
                         [](const auto& warp) { return warp.param.name; });

TEST(EqualAreaSquare, LayoutOfTheSquare) {
    auto expect_direction = [](Vec2f p, Vec3f d) {
        EXPECT_NEAR(length(equal_area_square_to_sphere(p) - d), 0, 1e-6f) << p.x << " " << p.y;
    };
    expect_direction({0.5f, 0.5f}, {0, 0, 1});
    for (float x : {0.0f, 1.0f})
        for (float y : {0.0f, 1.0f}) expect_direction({x, y}, {0, 0, -1});
    expect_direction({1, 0.5f}, {1, 0, 0});
    expect_direction({0, 0.5f}, {-1, 0, 0});
    expect_direction({0.5f, 1}, {0, 1, 0});
    expect_direction({0.5f, 0}, {0, -1, 0});
    expect_direction({0.75f, 0.75f}, {std::sqrt(0.5f), std::sqrt(0.5f), 0});
}

TEST(EqualAreaSquare, WrappingContinuesTheMapAcrossItsEdges) {
    TestUniforms uniforms(8);
    for (int i = 0; i < 1000; ++i) {
        double t = uniforms.next(), e = 1e-5;
        for (auto [in, out] :
             {std::pair(Vec2d{e, t}, Vec2d{-e, t}), std::pair(Vec2d{1 - e, t}, Vec2d{1 + e, t}),
              std::pair(Vec2d{t, e}, Vec2d{t, -e}), std::pair(Vec2d{t, 1 - e}, Vec2d{t, 1 + e})}) {
            Vec2d wrapped = wrap_equal_area_square(out);
            ASSERT_GE(std::min(wrapped.x, wrapped.y), 0);
            ASSERT_LE(std::max(wrapped.x, wrapped.y), 1);
            Vec3d a = equal_area_square_to_sphere(in), b = equal_area_square_to_sphere(wrapped);
            ASSERT_LT(length(a - b), 3e-4);
        }
    }
    Vec2f corner = wrap_equal_area_square(Vec2f{-0.25f, -0.125f});
    EXPECT_EQ(corner, (Vec2f{0.75f, 0.875f}));
}

TEST(SphericalTriangle, SolidAngleOfKnownTriangles) {
    auto octant = SphericalTriangle::from_directions({1, 0, 0}, {0, 3, 0}, {0, 0, 5});
    ASSERT_TRUE(octant);
    EXPECT_NEAR(octant->solid_angle(), pi / 2, 1e-15);
    // Small and facing: area / distance^2.
    double e = 1e-5;
    auto small = SphericalTriangle::from_directions({0, 0, 2}, {e, 0, 2}, {0, e, 2});
    ASSERT_TRUE(small);
    EXPECT_NEAR(small->solid_angle() / (e * e / 8), 1, 1e-9);
    EXPECT_FALSE(SphericalTriangle::from_directions({1, 0, 0}, {0, 1, 0}, {1, 1, 0}));
    EXPECT_FALSE(SphericalTriangle::from_directions({0, 0, 0}, {0, 1, 0}, {1, 1, 0}));
}

TEST(SphericalRectangle, SolidAngleOfKnownRectangles) {
    // One face of a cube seen from its centre.
    auto face = SphericalRectangle::from_corner({0, 0, 0}, {-1, -1, -1}, {2, 0, 0}, {0, 2, 0});
    ASSERT_TRUE(face);
    EXPECT_NEAR(face->solid_angle(), 4 * pi / 6, 1e-14);
    EXPECT_FALSE(SphericalRectangle::from_corner({0, 0, 0}, {1, 1, 0}, {2, 0, 0}, {0, 2, 0}));
    EXPECT_FALSE(SphericalRectangle::from_corner({0, 0, 0}, {1, 1, 1}, {0, 0, 0}, {0, 2, 0}));
    // The point lies on the rectangle.
    Vec3d p = face->sample_point(Vec2d{0.2, 0.9});
    EXPECT_DOUBLE_EQ(p.z, -1);
    EXPECT_LT(std::max(std::abs(p.x), std::abs(p.y)), 1);
}

TEST(Cone, VersineOfASmallAngleKeepsItsDigits) {
    float sine = 1e-5f;
    EXPECT_NEAR(versine_from_sin_squared(sine * sine) / 5e-11f, 1, 1e-6f);
}

} // namespace
} // namespace montelux
