// Lights of every kind with their flux, for the tests of emission.
#pragma once

#include "test/scene/portal_testing.h"
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "montelux/mc/math/frame.h"
#include "montelux/mc/warp/disk.h"
#include "montelux/mc/warp/triangle.h"
#include "montelux/scene/light/light_sampling.h"
#include "montelux/scene/light/sky/sky_map.h"
#include "montelux/scene/shape/quadric.h"

namespace montelux::emission {

using portals::wavelengths;

// Light 0 of a scene.
struct Case {
    std::string name;
    Scene scene;
    std::vector<double> flux; // of each part, at the first wavelength
    // The position's coordinates in the unit square, uniform; empty for points.
    std::function<Vec2d(const EmissionSample&, Index part)> place;
    EnvironmentSettings settings{};
    double tolerance = 1e-4; // of the flux given
};

inline Shape add_shape(Scene& scene, Shape shape) {
    const auto index = static_cast<Index>(scene.shapes.size());
    scene.shapes.push_back(shape);
    scene.world_shapes.push_back(index);
    return shape;
}
inline void add_area_light(Scene& scene, Shape shape, bool two_sided, float primitive_flux = 0) {
    shape.light = static_cast<Index>(scene.lights.size());
    scene.lights.push_back(
        AreaLight{1.0f, 2, two_sided, static_cast<Index>(scene.shapes.size()), primitive_flux});
    add_shape(scene, shape);
}

inline const Point3f corners[] = {{-1, -1, 1.5f}, {0.3f, 1.5f, 2}, {1.5f, -0.7f, 1}, {2, 2, 2}};

inline TriangleMesh two_triangles() {
    TriangleMesh m;
    m.positions.assign(std::begin(corners), std::end(corners));
    m.indices = {0, 1, 2, 2, 1, 3};
    return m;
}
inline double area_of(int a, int b, int c) {
    return 0.5 * double(length(cross(corners[b] - corners[a], corners[c] - corners[a])));
}
inline Vec2d in_triangle(const EmissionSample& s, Index part) {
    const TriangleMesh m = two_triangles();
    const Index* v = &m.indices[3 * std::size_t{part}];
    const Vec3d p0(m.positions[v[0]]), e1 = Vec3d(m.positions[v[1]]) - p0, e2 = Vec3d(m.positions[v[2]]) - p0;
    const Vec3d q = Vec3d(s.ray.o) - p0, n = cross(e1, e2);
    const double b1 = dot(cross(q, e2), n) / dot(n, n), b2 = dot(cross(e1, q), n) / dot(n, n);
    return invert_uniform_triangle(Vec3d{1 - b1 - b2, b1, b2});
}

inline void add_meshes(std::vector<Case>& cases) {
    const double a0 = area_of(0, 1, 2), a1 = area_of(2, 1, 3);
    auto add = [&](const char* name, std::vector<double> flux, bool two_sided, float primitive_flux,
                   const auto& change) {
        Case c{.name = name, .scene = {}, .flux = std::move(flux), .place = in_triangle};
        c.scene.meshes.push_back(two_triangles());
        Shape shape;
        shape.geometry = MeshIndex{0};
        change(c.scene.meshes[0], shape);
        add_area_light(c.scene, shape, two_sided, primitive_flux);
        cases.push_back(std::move(c));
    };
    auto nothing = [](TriangleMesh&, Shape&) {};
    add("triangles", {2 * pi * a0, 2 * pi * a1}, false, 0, nothing);
    add("triangles of two sides", {4 * pi * a0, 4 * pi * a1}, true, 0, nothing);
    add("triangles of a given flux", {2 * 7, 2 * 7}, true, 7, nothing);
    add("triangles, flipped", {2 * pi * a0, 2 * pi * a1}, false, 0,
        [](TriangleMesh&, Shape& s) { s.flip_normal = true; });
    add("triangles with normals of both sides", {2 * pi * a0, 2 * pi * a1}, false, 0,
        [](TriangleMesh& m, Shape&) {
            m.normals = {{0, 0, 1}, {0, 0, -1}, {0, 0, 1}, {0, 0, 1}};
        });
    add("triangles of alpha 0.25", {0.5 * pi * a0, 0.5 * pi * a1}, false, 0,
        [](TriangleMesh&, Shape& s) { s.alpha = {0.25f}; });
    // As in pbrt-v4 they emit fully.
    add("triangles of alpha 0", {2 * pi * a0, 2 * pi * a1}, false, 0,
        [](TriangleMesh&, Shape& s) { s.alpha = {0.0f}; });
}

inline void add_quadrics(std::vector<Case>& cases) {
    const Transform t = Transform::translate({1, 2, 3}) * Transform::rotate(40, {1, 0.3, 0});
    auto add = [&](const char* name, const Quadric& quadric, double area, bool two_sided,
                   std::function<Vec2d(const EmissionSample&, Index)> place, bool flip = false) {
        Case c{.name = name,
               .scene = {},
               .flux = {2 * pi * area * (two_sided ? 2 : 1)},
               .place = std::move(place)};
        c.scene.quadrics.push_back(quadric);
        Shape shape;
        shape.geometry = QuadricIndex{0};
        shape.flip_normal = flip;
        add_area_light(c.scene, shape, two_sided);
        cases.push_back(std::move(c));
    };
    auto on_sphere = [t](const EmissionSample& s, Index) {
        const Vec3d p = normalize(t.inverse_point(Vec3d(s.ray.o)));
        return Vec2d{(p.z + 1) / 2, turn_fraction(p.x, p.y)};
    };
    const Sphere sphere{.radius = 2, .z_min = -2, .z_max = 2, .world_from_object = t};
    add("sphere", sphere, 16 * pi, false, on_sphere);
    add("sphere inside out", sphere, 16 * pi, false, on_sphere, true);
    add("sphere of two sides", sphere, 16 * pi, true, on_sphere);
    auto on_disk = [t](const EmissionSample& s, Index) {
        const Vec3d p = t.inverse_point(Vec3d(s.ray.o));
        return invert_uniform_disk_polar(Vec2d{p.x / 1.5, p.y / 1.5});
    };
    const Disk disk{.radius = 1.5f, .world_from_object = t};
    add("disk", disk, pi * 2.25, false, on_disk);
    add("disk of two sides", disk, pi * 2.25, true, on_disk);
    const Quadric part = Sphere{.z_min = -0.5f, .z_max = 0.9f, .phi_max = 4, .world_from_object = t};
    add("part of a sphere", part, 4 * 1.4, false, [t](const EmissionSample& s, Index) {
        const Vec3d p = t.inverse_point(Vec3d(s.ray.o));
        return Vec2d{(p.z + 0.5) / 1.4, turn_fraction(p.x, p.y) * 2 * pi / 4};
    });
    const Quadric tube =
        Cylinder{.radius = 0.5f, .z_min = -1, .z_max = 2, .phi_max = 4, .world_from_object = t};
    auto on_tube = [t](const EmissionSample& s, Index) {
        const Vec3d p = t.inverse_point(Vec3d(s.ray.o));
        return Vec2d{(p.z + 1) / 3, turn_fraction(p.x, p.y) * 2 * pi / 4};
    };
    add("part of a cylinder", tube, 6, false, on_tube);
    add("part of a cylinder, of two sides", tube, 6, true, on_tube);
    // Uniform in the sphere's own space.
    const Quadric ellipsoid = Sphere{.world_from_object = t * Transform::scale({1, 0.6, 0.8})};
    add("ellipsoid", ellipsoid, world_area(ellipsoid), false, [t](const EmissionSample& s, Index) {
        const Vec3d p = (t * Transform::scale({1, 0.6, 0.8})).inverse_point(Vec3d(s.ray.o));
        return Vec2d{(p.z + 1) / 2, turn_fraction(p.x, p.y)};
    });
    cases.back().tolerance = 1e-3;
}

inline void add_deltas(std::vector<Case>& cases) {
    Case point{.name = "point", .scene = {}, .flux = {4 * pi * 3}, .place = {}};
    point.scene.lights.push_back(PointLight{1.0f, 3, {1, 2, 3}});
    cases.push_back(point);
    for (const float start : {0.9f, 0.7f}) {
        Case spot{.name = "spot",
                  .scene = {},
                  .flux = {2 * pi * 3 * (1 - double(start) + 0.5 * double(start - 0.6f))},
                  .place = {}};
        spot.scene.lights.push_back(SpotLight{1.0f, 3, {1, 2, 3}, normalize(Vec3f{1, -2, 2}), start, 0.6f});
        cases.push_back(spot);
        // Linear in the angle, from one cone to the other.
        const double s = std::acos(double(start)), e = std::acos(double(0.6f));
        spot.name = "linear spot";
        spot.flux = {2 * pi * 3 * (1 - (std::sin(e) - std::sin(s)) / (e - s))};
        std::get<SpotLight>(spot.scene.lights[0]).profile = SpotFalloff::linear;
        cases.push_back(spot);
    }
}

// A sphere of radius 2 around it, in a box of the radius 2 sqrt(3).
inline const Vec3d centre{1, 0, 0};
inline constexpr double cross_section = pi * 12;

inline void add_scene(Scene& scene) {
    scene.quadrics.push_back(
        Sphere{.radius = 2, .z_min = -2, .z_max = 2, .world_from_object = Transform::translate(centre)});
    Shape shape;
    shape.geometry = QuadricIndex{0};
    add_shape(scene, shape);
}

inline Vec2d on_scene_disk(const EmissionSample& s, Index) {
    const Frame frame = Frame::from_normal(s.ray.d);
    const Vec3d q = Vec3d(s.ray.o) - centre;
    const double r = std::sqrt(cross_section / pi);
    return invert_uniform_disk_polar(Vec2d{dot(q, Vec3d(frame.s)) / r, dot(q, Vec3d(frame.t)) / r});
}

inline Image map_of_texels() {
    Image map(16, 16, {"R", "G", "B"});
    for (int i = 0; i < 256; ++i)
        for (int c = 0; c < 3; ++c)
            map.set(i % 16, i / 16, c, i % 5 == 0 ? 0 : 0.1f + static_cast<float>((i * 7) % 11));
    return map;
}

// Point lights with pictures, turned and moved.
inline void add_pictures(std::vector<Case>& cases) {
    const Transform turned = Transform::translate({1, 2, 3}) * Transform::rotate(40, {1, 0.3, 2});
    const auto add = [&](const char* name, const Image& map, const Light& light, double flux) {
        Case c{.name = name, .scene = {}, .flux = {flux}, .place = {}};
        c.scene.environments = {map};
        c.scene.lights.push_back(light);
        cases.push_back(std::move(c));
    };
    const Image map = map_of_texels();
    double mean = 0;
    for (int i = 0; i < 256; ++i) mean += double(map.value(i % 16, i / 16, 0)) / 256;
    const GoniometricLight goniometric{
        .spectrum = 1.0f, .scale = 3, .environment = 0, .world_from_map = turned};
    add("goniometric", map, goniometric, 4 * pi * 3 * mean);
    for (const EnvironmentSampling sampling :
         {EnvironmentSampling::tabulated, EnvironmentSampling::structured}) {
        cases.push_back(cases.back());
        cases.back().name += ", compensated";
        cases.back().settings = {.sampling = sampling, .compensated = true};
    }
    // A uniform picture, 3 wide and 2 high: the solid angle of a rectangle of half sides a, b at distance 1.
    const double b = std::tan(0.5 * 70 * pi / 180), a = 1.5 * b;
    const double solid_angle = 4 * std::asin(a * b / std::sqrt((1 + a * a) * (1 + b * b)));
    const Spectrum white(RgbIlluminantSpectrum(RgbColorSpace::srgb(), {1, 1, 1}));
    const double at_first = double(white.sample(wavelengths)[0]);
    Image picture(48, 32, {"R", "G", "B"});
    for (float& v : picture.f32()) v = 1;
    ProjectionLight projection{.environment = 0, .scale = 3, .fov = 70, .world_from_light = turned};
    add("projection of a uniform map", picture, projection, 3 * at_first * solid_angle);
    // The intensity over the solid angle, 1 / cos^3 by cos^3, is even over the rectangle.
    projection.profile = ProjectionProfile::irradiance;
    add("projection of a uniform map, even on a plane", picture, projection, 3 * at_first * 4 * a * b);
}

inline void add_infinite(std::vector<Case>& cases) {
    auto add = [&](const char* name, const Light& light, double flux) -> Case& {
        Case c{.name = name, .scene = {}, .flux = {flux}, .place = on_scene_disk};
        add_scene(c.scene);
        c.scene.lights.push_back(light);
        cases.push_back(std::move(c));
        return cases.back();
    };
    add("distant", DistantLight{1.0f, 3, normalize(Vec3f{1, 2, 2})}, 3 * cross_section);
    add("uniform sky", UniformInfiniteLight{1.0f, 3}, 4 * pi * 3 * cross_section);

    const std::array<Point3f, 4> rectangle =
        portals::corners_of(-1, -1, 2, 1.5f, 3, Transform::rotate(30, {1, 2, 0.4}));
    const Portal portal(rectangle);
    auto on_portal = [rectangle](const EmissionSample& s, Index) {
        const Vec3d c(rectangle[0]), x = Vec3d(rectangle[3]) - c, y = Vec3d(rectangle[1]) - c,
                                     n = cross(x, y);
        const double t = dot(c - Vec3d(s.ray.o), n) / dot(Vec3d(s.ray.d), n);
        const Vec3d q = Vec3d(s.ray.o) + t * Vec3d(s.ray.d) - c;
        return Vec2d{dot(q, x) / dot(x, x), dot(q, y) / dot(y, y)};
    };
    add("uniform sky through a portal", UniformInfiniteLight{1.0f, 3, portal}, pi * 3 * 7.5).place =
        on_portal;

    const double white =
        double(RgbIlluminantSpectrum(RgbColorSpace::srgb(), {1, 1, 1}).sample(wavelengths)[0]);
    const Image map = map_of_texels();
    double mean = 0;
    for (int i = 0; i < 256; ++i) mean += double(map.value(i % 16, i / 16, 0)) / 256;
    ImageInfiniteLight image{
        .environment = 0, .scale = 2, .world_from_light = Transform::rotate(77, {1, -2, 0.5})};
    for (const bool compensated : {false, true}) {
        Case& c =
            add(compensated ? "compensated map" : "map", image, 4 * pi * 2 * mean * white * cross_section);
        c.scene.environments.push_back(map);
        c.settings.compensated = compensated;
        c.tolerance = 1e-3; // of the uplift
    }
    // Flux through a portal: the map's light in its hemisphere, weighted by the cosine.
    double irradiance = 0;
    const EnvironmentGrid grid(EnvironmentLayout::equal_area, 16, 16);
    for (int i = 0; i < 256 * 256; ++i) {
        const int x = i % 256, y = i / 256;
        const Vec2d at{(x + 0.5) / 16, (y + 0.5) / 16};
        const Vec3d w = image.world_from_light.vector(Vec3d(grid.direction(at)));
        irradiance +=
            std::max(0.0, dot(w, portal.normal())) * double(map.value_at(3 * grid.texel(Vec2f(at))));
    }
    irradiance *= 4 * pi / (256 * 256);
    image.portal = portal;
    Case& through = add("map through a portal", image, 7.5 * 2 * irradiance * white);
    through.scene.environments.push_back(map);
    through.place = on_portal;
    through.tolerance = 2e-3;

    Scene sky;
    SkySettings settings;
    settings.elevation = 35;
    sky.skies.emplace_back(settings);
    double sky_mean = 0;
    for (int i = 0; i < 200; ++i)
        for (int j = 0; j < 400; ++j) {
            const double z = 2 * (i + 0.5) / 200 - 1, r = std::sqrt(1 - z * z),
                         phi = 2 * pi * (j + 0.5) / 400;
            const Vec3f w(Vec3d{r * std::cos(phi), r * std::sin(phi), z});
            sky_mean += double(sky.skies[0].radiance(w, wavelengths)[0]) / (200 * 400);
        }
    const Transform tilted = Transform::rotate(77, {1, -2, 0.5});
    Case& dome = add("sky", SkyLight{.sky = 0, .environment = 0, .scale = 3, .world_from_light = tilted},
                     4 * pi * 3 * sky_mean * cross_section);
    dome.scene.skies = sky.skies;
    dome.scene.environments.push_back(sky_density_map(sky.skies[0], 32));
    dome.tolerance = 5e-3;

    // Half below the horizon.
    const Vec3f up = normalize(Vec3f{1, 2, 2}), side = Frame::from_normal(up).s;
    Case& sun = add("sun", SunLight{1.0f, 3, SunDisc::of_radius(side, 0.3), up},
                    3 * pi * (1 - std::cos(0.3)) * cross_section);
    sun.tolerance = 1e-3;
}

inline std::vector<Case> all_cases() {
    std::vector<Case> cases;
    add_meshes(cases);
    add_quadrics(cases);
    add_deltas(cases);
    add_pictures(cases);
    add_infinite(cases);
    return cases;
}

} // namespace montelux::emission
