// Sampling of lights that are shapes: directions follow the reported densities, and samples agree with what rays find.
// Chi-squared tests at 1e-8 each, sums at 5.5 standard errors (4e-8): below 2e-6 for the file.
#include "test/scene/shape_light_testing.h"
#include <cmath>
#include <gtest/gtest.h>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "montelux/mc/stats/chi_squared.h"
#include "montelux/scene/scene_tables.h"
#include "montelux/scene/shape/surface_point.h"

namespace montelux {
namespace {

using testing::add_light;
using testing::origin;
using testing::wavelengths;

// All points of a light's shape along a ray, found without an accelerator.
std::vector<SurfacePoint> points_along(const Scene& scene, const AreaLight& light, const Ray& ray) {
    std::vector<SurfacePoint> points;
    const Shape& shape = scene.shapes[light.shape];
    if (const Quadric* quadric = quadric_of(scene, shape)) {
        double t_min = 0;
        while (auto t = intersect(*quadric, ray, t_min)) {
            points.push_back(surface_point(SceneView(scene), ray,
                                           Hit{.t = static_cast<float>(*t), .shape = light.shape}, false));
            t_min = *t * (1 + 1e-9);
        }
        return points;
    }
    if (const BilinearMesh* mesh = bilinear_mesh_of(scene, shape)) {
        double t_min = 0;
        while (const auto hit = intersect(mesh->patch(0), Vec3d(ray.o), Vec3d(ray.d), t_min, 1e30)) {
            points.push_back(surface_point(SceneView(scene), ray,
                                           Hit{.t = static_cast<float>(hit->t),
                                               .b1 = static_cast<float>(hit->u),
                                               .b2 = static_cast<float>(hit->v),
                                               .shape = light.shape},
                                           false));
            t_min = hit->t * (1 + 1e-9);
        }
        return points;
    }
    const auto& p = scene.meshes[std::get<MeshIndex>(shape.geometry).index].positions;
    Vec3d e1 = Vec3d(p[1]) - Vec3d(p[0]), e2 = Vec3d(p[2]) - Vec3d(p[0]), n = cross(e1, e2), d(ray.d);
    double t = dot(n, Vec3d(p[0]) - Vec3d(ray.o)) / dot(n, d);
    Vec3d q = Vec3d(ray.o) + t * d - Vec3d(p[0]);
    double b1 = dot(cross(q, e2), n) / dot(n, n), b2 = dot(cross(e1, q), n) / dot(n, n);
    if (t > 0 && b1 >= 0 && b2 >= 0 && b1 + b2 <= 1)
        points.push_back(surface_point(SceneView(scene), ray,
                                       Hit{.t = static_cast<float>(t),
                                           .b1 = static_cast<float>(b1),
                                           .b2 = static_cast<float>(b2),
                                           .shape = light.shape},
                                       false));
    return points;
}

struct AreaCase {
    std::string name;
    Scene scene;
};

// Lights around (0, 0, 2), seen from the origin.
std::vector<AreaCase> area_cases() {
    std::vector<AreaCase> cases;
    auto add = [&](const char* name, auto... arguments) {
        AreaCase c{name, {}};
        add_light(c.scene, arguments...);
        cases.push_back(std::move(c));
    };
    Transform up = Transform::translate({0.2, -0.1, 2});
    Transform tilted = up * Transform::rotate(160, {1, 0.3, 0});
    Transform squashed = tilted * Transform::scale({1, 0.6, 0.8});
    const Vec3f a{-1, -1, 1.5f}, b{0.3f, 1.5f, 2}, c{1.5f, -0.7f, 1};
    add("triangle", a, b, c, false);
    add("triangle from behind, two-sided", a, c, b, true);
    add("sphere", Quadric(Sphere{.world_from_object = up}));
    add("sphere of another scale",
        Quadric(Sphere{.world_from_object = up * Transform::scale({1.5, 1.5, 1.5})}));
    add("sphere from within", Quadric(Sphere{.radius = 3, .z_min = -3, .z_max = 3, .world_from_object = up}),
        true, false);
    add("ellipsoid", Quadric(Sphere{.world_from_object = squashed}));
    add("ellipsoid from within",
        Quadric(Sphere{.world_from_object =
                           Transform::translate({0.1, 0.2, 0.3}) * Transform::scale({2, 1, 1.5})}),
        true, false);
    add("part of a sphere",
        Quadric(Sphere{.z_min = -0.5f, .z_max = 0.9f, .phi_max = 4, .world_from_object = tilted}));
    add("part of a sphere, two-sided",
        Quadric(Sphere{.z_min = -0.5f, .z_max = 0.9f, .phi_max = 4, .world_from_object = tilted}), false,
        true);
    add("part of a cylinder, open towards the point",
        Quadric(Cylinder{.radius = 0.7f, .z_max = 0.8f, .phi_max = 4, .world_from_object = tilted}), true);
    add("elliptic cylinder from within, two-sided",
        Quadric(Cylinder{.radius = 2, .z_min = -2, .world_from_object = Transform::scale({1, 0.6, 0.8})}),
        false, true);
    add("disk", Quadric(Disk{.radius = 1.2f, .world_from_object = tilted}));
    add("ellipse", Quadric(Disk{.height = 0.3f, .radius = 1.2f, .world_from_object = squashed}));
    add("part of a ring",
        Quadric(Disk{.radius = 1.2f, .inner_radius = 0.5f, .phi_max = 4, .world_from_object = tilted}));
    add("disk from behind, two-sided", Quadric(Disk{.radius = 1.2f, .world_from_object = up}), false, true);
    const auto patch = [](Point3f p00, Point3f p10, Point3f p01, Point3f p11) {
        BilinearMesh mesh;
        mesh.positions = {p00, p10, p01, p11};
        mesh.indices = {0, 1, 2, 3};
        return mesh;
    };
    const BilinearMesh bent = patch({-1, -1, 1.5f}, {1, -1.2f, 2.2f}, {-1.3f, 1, 2.4f}, {1.2f, 0.8f, 1.2f});
    add("bent patch", bent, true, false);
    add("bent patch of two sides", bent, false, true);
    add("trapezoid", patch({-1, -1, 2}, {-0.5f, 1, 2}, {1, -1, 2}, {0.6f, 1, 2}));
    BilinearMesh turned = bent;
    turned.normals = {{0, 0, -1}, {0, 0, -1}, {0, 0.2f, -1}, {0, 0, -1}};
    add("bent patch with vertex normals", turned);
    return cases;
}

TEST(AreaLights, DirectionsFollowTheirDensity) {
    for (const AreaCase& c : area_cases()) {
        SceneTables tables(c.scene);
        const auto& light = std::get<AreaLight>(c.scene.lights[0]);
        auto sample = [&](Vec2f u) -> std::optional<Vec3f> {
            auto s = sample_li({tables.view(), 0}, 0, origin, u, wavelengths);
            if (!s) return std::nullopt;
            return s->wi;
        };
        auto pdf = [&](Vec3f w) {
            float sum = 0;
            for (const SurfacePoint& s : points_along(c.scene, light, {origin.p, w}))
                if (light.two_sided || dot(s.ng, w) < 0)
                    sum += pdf_li({tables.view(), 0}, origin, {.wi = w, .p = s.p, .n = s.ng, .b = s.b});
            // The visible half of a whole sphere represents all of it.
            if (light.two_sided && tables.view().light_tables.sphere(0)) sum *= 0.5f;
            return sum;
        };
        ChiSquaredOptions options;
        options.samples = 50000;
        // Fine enough that the quadrature of the density misses no sliver of the light.
        options.cells_x = options.cells_y = 24;
        if (c.name.find("within") == std::string::npos) options.cos_theta_min = 0;
        TestResult r = spherical_chi_squared_test(sample, pdf, options);
        EXPECT_TRUE(r.passes(1e-8)) << c.name << ": " << r.description;
    }
}

TEST(AreaLights, SamplesAgreeWithHits) {
    for (const AreaCase& c : area_cases()) {
        SceneTables tables(c.scene);
        const auto& light = std::get<AreaLight>(c.scene.lights[0]);
        TestUniforms uniforms(5);
        int found = 0, samples = 0;
        for (int i = 0; i < 5000; ++i) {
            Vec2f u = uniforms.next_2f();
            auto s = sample_li({tables.view(), 0}, 0, origin, u, wavelengths);
            if (!s) continue;
            ++samples;
            ASSERT_NEAR(length(s->wi), 1, 1e-5) << c.name;
            ASSERT_FALSE(s->delta);
            ASSERT_GT(s->pdf, 0);
            // The shadow ray ends just before the light, where the light is.
            Vec3f end = s->shadow.o + s->shadow.t_max * s->shadow.d;
            const SurfacePoint* nearest = nullptr;
            auto points = points_along(c.scene, light, {origin.p, s->wi});
            for (const SurfacePoint& p : points)
                if (nearest == nullptr || length(p.p - end) < length(nearest->p - end)) nearest = &p;
            if (nearest == nullptr) continue; // rounding at a rim
            ++found;
            ASSERT_LT(length(nearest->p - end), 2e-3f) << c.name;
            const LightHit hit{.wi = s->wi, .p = nearest->p, .n = nearest->ng, .b = nearest->b};
            SampledSpectrum le = incident_radiance({tables.view(), 0}, origin, hit, wavelengths);
            ASSERT_EQ(le[0], s->radiance[0]) << c.name;
            float pdf = pdf_li({tables.view(), 0}, origin, hit);
            if (std::abs(dot(nearest->ng, s->wi)) > 0.05f) {
                ASSERT_NEAR(pdf / s->pdf, 1, 2e-3) << c.name;
            }
        }
        EXPECT_GT(samples, 500) << c.name;
        EXPECT_GT(found, samples * 0.99) << c.name;
    }
}

TEST(AreaLights, OneSidedLightsAreDarkBehind) {
    Scene scene;
    add_light(scene, Quadric(Disk{.world_from_object = Transform::translate({0, 0, 2})})); // shines up
    add_light(scene, Vec3f{0, 0, 1}, Vec3f{1, 0, 1}, Vec3f{0, 1, 1});                      // likewise
    add_light(scene, Quadric(Sphere{.world_from_object = Transform::translate({0, 0, 4})}), true);
    SceneTables tables(scene);
    TestUniforms uniforms(1);
    for (int i = 0; i < 100; ++i)
        for (Index light : {0u, 1u, 2u}) {
            Vec2f u = uniforms.next_2f();
            EXPECT_FALSE(sample_li({tables.view(), light}, 0, origin, u, wavelengths)) << light;
        }
    auto seen_from = [&](Vec3f w) {
        return incident_radiance({tables.view(), 0}, origin, {.wi = -w, .n = {0, 0, 1}}, wavelengths)[0];
    };
    EXPECT_EQ(seen_from({0, 0, -1}), 0);
    EXPECT_EQ(seen_from({0, 0, 1}), 2);
}

} // namespace
} // namespace montelux
