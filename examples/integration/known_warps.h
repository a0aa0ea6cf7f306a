// The warps of the unit square in the library, with known properties of each.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <montelux/mc/integrate/domain.h>
#include <montelux/mc/math/constants.h>
#include <montelux/mc/warp/cone.h>
#include <montelux/mc/warp/cosine.h>
#include <montelux/mc/warp/disk.h>
#include <montelux/mc/warp/equal_area_square.h>
#include <montelux/mc/warp/hemisphere.h>
#include <montelux/mc/warp/linear.h>
#include <montelux/mc/warp/sphere.h>
#include <montelux/mc/warp/spherical_rectangle.h>
#include <montelux/mc/warp/spherical_triangle.h>
#include <montelux/mc/warp/triangle.h>
#include <string>
#include <utility>
#include <vector>

using namespace montelux;

// Points of the plane have z = 0. The density is per unit area or steradian, zero outside.
struct Warp {
    std::string name;
    Domain around; // what holds the image: a box of the plane, or the sphere
    std::function<Vec3d(Vec2d)> sample;
    std::function<Vec2d(Vec3d)> inverse;
    std::function<double(Vec3d)> pdf;
    std::string quantity;
    std::function<double(Vec3d)> value;
    double mean;
};

inline Vec3d in_space(Vec2d p) { return {p.x, p.y, 0}; }
inline Vec2d in_plane(Vec3d p) { return {p.x, p.y}; }

inline std::vector<Warp> plane_warps() {
    const Domain disc{{-1, 1}, {-1, 1}}, square = Domain::unit_cube(2);
    const auto on_disc = [](Vec3d p) { return p.x * p.x + p.y * p.y < 1 ? uniform_disk_pdf<double>() : 0; };
    const auto x_squared = [](Vec3d p) { return p.x * p.x; };
    // The coordinates are two of the barycentric ones, and the triangle is half of the square.
    const auto on_triangle = [](Vec3d p) { return p.x + p.y < 1 ? uniform_triangle_pdf(0.5) : 0; };
    const auto third = [](Vec3d p) { return Vec3d(p.x, p.y, 1 - p.x - p.y); };
    const auto product = [](Vec3d p) { return p.x * p.y; };
    constexpr std::array<double, 4> corners{1, 2, 0.5, 6};
    return {{"disc, r = sqrt(xi)", disc, [](Vec2d u) { return in_space(sample_uniform_disk_polar(u)); },
             [](Vec3d p) { return invert_uniform_disk_polar(in_plane(p)); }, on_disc, "E x^2", x_squared,
             0.25},
            {"disc, concentric", disc, [](Vec2d u) { return in_space(sample_uniform_disk_concentric(u)); },
             [](Vec3d p) { return invert_uniform_disk_concentric(in_plane(p)); }, on_disc, "E x^2", x_squared,
             0.25},
            {"triangle", square, [](Vec2d u) { return sample_uniform_triangle(u); },
             [=](Vec3d p) { return invert_uniform_triangle(third(p)); }, on_triangle, "E b0 b1", product,
             1.0 / 12},
            {"triangle, low distortion", square,
             [](Vec2d u) { return sample_uniform_triangle_low_distortion(u); },
             [=](Vec3d p) { return invert_uniform_triangle_low_distortion(third(p)); }, on_triangle,
             "E b0 b1", product, 1.0 / 12},
            {"cosine times uniform", Domain{{0, pi / 2}, {0, 1}},
             [](Vec2d u) { return Vec3d(sample_cosine(u.x), u.y, 0); },
             [](Vec3d p) { return Vec2d(invert_cosine(p.x), p.y); }, [](Vec3d p) { return cosine_pdf(p.x); },
             "E xy", product, (pi / 2 - 1) / 2},
            // The corners' values times the moments of their bilinear weights.
            {"bilinear", square, [=](Vec2d u) { return in_space(sample_bilinear(u, corners)); },
             [=](Vec3d p) { return invert_bilinear(in_plane(p), corners); },
             [=](Vec3d p) { return bilinear_pdf(in_plane(p), corners); }, "E xy", product,
             (corners[0] + 2 * corners[1] + 2 * corners[2] + 4 * corners[3]) / 36 /
                 ((corners[0] + corners[1] + corners[2] + corners[3]) / 4)}};
}

inline std::vector<Warp> sphere_warps() {
    const Domain sphere = Domain::sphere({0, 0, 0});
    const auto z = [](Vec3d w) { return w.z; };
    const auto z_squared = [](Vec3d w) { return w.z * w.z; };
    const auto on_sphere = [](Vec3d) { return uniform_sphere_pdf<double>(); };
    constexpr double cosine = 0.4; // of the cone's half-angle
    const auto octant = SphericalTriangle::from_directions({1, 0, 0}, {0, 1, 0}, {0, 0, 1}).value();
    const auto face = SphericalRectangle::from_corner({0, 0, 0}, {-1, -1, 1}, {2, 0, 0}, {0, 2, 0}).value();
    return {{"sphere", sphere, [](Vec2d u) { return sample_uniform_sphere(u); },
             [](Vec3d w) { return invert_uniform_sphere(w); }, on_sphere, "E z^2", z_squared, 1.0 / 3},
            {"sphere, octahedral", sphere, [](Vec2d u) { return equal_area_square_to_sphere(u); },
             [](Vec3d w) { return equal_area_sphere_to_square(w); }, on_sphere, "E z^2", z_squared, 1.0 / 3},
            {"hemisphere", sphere, [](Vec2d u) { return sample_uniform_hemisphere(u); },
             [](Vec3d w) { return invert_uniform_hemisphere(w); },
             [](Vec3d w) { return w.z > 0 ? uniform_hemisphere_pdf<double>() : 0; }, "E z", z, 0.5},
            {"hemisphere, cosine-weighted", sphere, [](Vec2d u) { return sample_cosine_hemisphere(u); },
             [](Vec3d w) { return invert_cosine_hemisphere(w); },
             [](Vec3d w) { return cosine_hemisphere_pdf(w.z); }, "E z", z, 2.0 / 3},
            {"cone", sphere, [](Vec2d u) { return sample_uniform_cone(u, cosine); },
             [](Vec3d w) { return invert_uniform_cone(w, cosine); },
             [](Vec3d w) { return w.z > cosine ? uniform_cone_pdf(cosine) : 0; }, "E z", z, (1 + cosine) / 2},
            {"spherical triangle, an octant", sphere, [=](Vec2d u) { return octant.sample(u); },
             [=](Vec3d w) { return octant.inverse(w); },
             [=](Vec3d w) { return w.x > 0 && w.y > 0 && w.z > 0 ? octant.pdf<double>() : 0; }, "E z", z,
             0.5},
            // Its form factor over its solid angle, a sixth of the sphere.
            {"spherical rectangle, a cube's face", sphere, [=](Vec2d u) { return face.sample(u); },
             [=](Vec3d w) { return face.inverse(w); },
             [=](Vec3d w) { return w.z > std::max(std::abs(w.x), std::abs(w.y)) ? face.pdf<double>() : 0; },
             "E z", z, 3 * std::sqrt(2.0) * std::atan(std::sqrt(0.5)) / pi}};
}

inline std::vector<Warp> all_warps() {
    std::vector<Warp> warps = plane_warps();
    for (Warp& warp : sphere_warps()) warps.push_back(std::move(warp));
    return warps;
}
