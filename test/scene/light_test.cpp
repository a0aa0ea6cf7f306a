// Sampling of lights: directions follow the reported densities, and samples agree with what rays find.
// Chi-squared tests at 1e-8 each, sums at 5.5 standard errors (4e-8): below 2e-6 for the file.
#include <cmath>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "montelux/mc/stats/chi_squared.h"
#include "montelux/mc/stats/moments.h"
#include "montelux/scene/light/light_sampling.h"
#include "montelux/scene/scene_tables.h"
#include "montelux/scene/shape/quadric.h"
#include "montelux/scene/shape/surface_point.h"

namespace montelux {
namespace {

const SampledWavelengths wavelengths = SampledWavelengths::sample_visible(0.37f);

Index add_light(Scene& scene, Shape shape, bool two_sided, float radiance = 2) {
    shape.light = static_cast<Index>(scene.lights.size());
    auto index = static_cast<Index>(scene.shapes.size());
    scene.lights.push_back(AreaLight{1.0f, radiance, two_sided, index});
    scene.shapes.push_back(shape);
    scene.world_shapes.push_back(index);
    return shape.light;
}
Index add_light(Scene& scene, const Quadric& quadric, bool flip = false, bool two_sided = false) {
    Shape shape;
    shape.geometry = QuadricIndex{static_cast<Index>(scene.quadrics.size())};
    shape.flip_normal = flip;
    scene.quadrics.push_back(quadric);
    return add_light(scene, shape, two_sided);
}
Index add_light(Scene& scene, Vec3f a, Vec3f b, Vec3f c, bool two_sided = false) {
    Shape shape;
    shape.geometry = MeshIndex{static_cast<Index>(scene.meshes.size())};
    TriangleMesh mesh;
    mesh.positions = {a, b, c};
    mesh.indices = {0, 1, 2};
    scene.meshes.push_back(mesh);
    return add_light(scene, shape, two_sided);
}

Index add_light(Scene& scene, const BilinearMesh& mesh, bool flip = false, bool two_sided = false) {
    Shape shape;
    shape.geometry = BilinearMeshIndex{static_cast<Index>(scene.bilinear_meshes.size())};
    shape.flip_normal = flip;
    scene.bilinear_meshes.push_back(mesh);
    return add_light(scene, shape, two_sided);
}

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

const ReferencePoint origin{{0, 0, 0}, {0, 0, 1}, 1e-6f};

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
        options.samples = 100000;
        // Fine enough that the quadrature of the density misses no sliver of the light.
        options.cells_x = options.cells_y = 48;
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

TEST(InfiniteLights, DirectionsFollowTheirDensity) {
    for (int which : {0, 1, 2, 3}) {
        Scene scene;
        if (which == 0) {
            scene.lights.push_back(UniformInfiniteLight{1.0f, 3});
        } else {
            Image map(16, 16, {"R", "G", "B"});
            for (int i = 0; i < 256; ++i)
                for (int c = 0; c < 3; ++c)
                    map.set(i % 16, i / 16, c, i % 5 == 0 ? 0 : 0.1f + static_cast<float>((i * 7) % 11));
            scene.environments.push_back(map);
            scene.lights.push_back(ImageInfiniteLight{
                .environment = 0,
                .scale = 2,
                .world_from_light = which == 1 ? Transform()
                                    : which == 2
                                        ? Transform::rotate(77, {1, -2, 0.5})
                                        : Transform::rotate(20, {1, 2, 3}) * Transform::scale({1, -3, 0.7})});
        }
        SceneTables tables(scene);
        auto sample = [&](Vec2f u) -> std::optional<Vec3f> {
            auto s = sample_li({tables.view(), 0}, 0, origin, u, wavelengths);
            if (!s) return std::nullopt;
            return s->wi;
        };
        auto pdf = [&](Vec3f w) { return pdf_li({tables.view(), 0}, {.p = origin.p}, {.wi = w}); };
        ChiSquaredOptions options;
        options.samples = 200000;
        options.cells_x = options.cells_y = 16;
        TestResult r = spherical_chi_squared_test(sample, pdf, options);
        EXPECT_TRUE(r.passes(1e-8)) << which << ": " << r.description;

        TestUniforms uniforms(9);
        int differing = 0;
        for (int i = 0; i < 5000; ++i) {
            Vec2f u = uniforms.next_2f();
            auto s = sample_li({tables.view(), 0}, 0, origin, u, wavelengths);
            ASSERT_TRUE(s);
            ASSERT_FALSE(s->delta);
            ASSERT_TRUE(std::isinf(s->shadow.t_max));
            // Rounding may send the direction of a point on a texel's edge back into its neighbour.
            bool same =
                std::abs(pdf_li({tables.view(), 0}, {.p = origin.p}, {.wi = s->wi}) / s->pdf - 1) < 1e-3f &&
                std::abs(
                    incident_radiance({tables.view(), 0}, {.p = origin.p}, {.wi = s->wi}, wavelengths)[1] -
                    s->radiance[1]) < 1e-3f * s->radiance[1];
            differing += !same;
        }
        EXPECT_LE(differing, 5) << which;
    }
}

// E[radiance / pdf] is the radiance integrated over the sphere.
TEST(InfiniteLights, MapsIntegrateToTheirMean) {
    Scene scene;
    Image map(8, 8, {"R", "G", "B"});
    double mean = 0;
    for (int i = 0; i < 64; ++i) {
        float v = static_cast<float>((i * 5) % 7);
        mean += double(v) / 64;
        for (int c = 0; c < 3; ++c) map.set(i % 8, i / 8, c, v);
    }
    scene.environments.push_back(map);
    scene.lights.push_back(ImageInfiniteLight{
        .environment = 0, .scale = 2, .world_from_light = Transform::rotate(30, {1, 1, 0})});
    SceneTables tables(scene);
    SampledSpectrum white = RgbIlluminantSpectrum(RgbColorSpace::srgb(), {1, 1, 1}).sample(wavelengths);
    TestUniforms uniforms(3);
    RunningMoments m;
    for (int i = 0; i < 20000; ++i) {
        auto s = sample_li({tables.view(), 0}, 0, origin, uniforms.next_2f(), wavelengths);
        if (s) m.add(double(s->radiance[0] / white[0] / s->pdf));
    }
    // Grey texels: density and radiance rise together, and the estimate has hardly any noise.
    EXPECT_NEAR(m.mean(), 4 * pi * 2 * mean, 5.5 * m.standard_error() + 1e-2);
}

TEST(PointLights, InverseSquareAndFalloff) {
    Scene scene;
    scene.lights.push_back(PointLight{1.0f, 5, {0, 3, 4}});
    const float cos_start = std::cos(0.3f), cos_end = std::cos(0.6f);
    scene.lights.push_back(SpotLight{1.0f, 5, {0, 0, 2}, {0, 0, -1}, cos_start, cos_end});
    scene.lights.push_back(DistantLight{1.0f, 5, normalize(Vec3f{1, 2, 2})});
    SceneTables tables(scene);
    auto at = [&](Index light, Point3f p) {
        return sample_li({tables.view(), light}, 0, {p, {0, 0, 1}, 0}, {0.3f, 0.8f}, wavelengths);
    };
    auto point = at(0, {0, 0, 0});
    ASSERT_TRUE(point && point->delta);
    EXPECT_FLOAT_EQ(point->radiance[0], 5.0f / 25);
    EXPECT_FLOAT_EQ(point->wi.y, 0.6f);
    EXPECT_EQ(point->pdf, 1);
    EXPECT_FALSE(at(0, {0, 3, 4})) << "at the light itself";
    for (float angle : {0.0f, 0.29f, 0.31f, 0.45f, 0.59f, 0.61f}) {
        float x = 2 * std::tan(angle);
        auto s = at(1, {x, 0, 0});
        float c = std::cos(angle), t = std::clamp((c - cos_end) / (cos_start - cos_end), 0.0f, 1.0f);
        float expected = t * t * (3 - 2 * t) * 5 / (4 + x * x);
        ASSERT_EQ(s.has_value(), expected > 0) << angle;
        if (s) {
            EXPECT_NEAR(s->radiance[0], expected, 1e-5) << angle;
        }
    }
    auto distant = at(2, {3, 1, 4});
    ASSERT_TRUE(distant && distant->delta);
    EXPECT_FLOAT_EQ(distant->radiance[0], 5);
    EXPECT_FLOAT_EQ(distant->wi.x, 1.0f / 3);
    EXPECT_TRUE(std::isinf(distant->shadow.t_max));
}

// Lights are chosen in proportion to their power; all spectra are alike here.
TEST(LightTables, ProbabilitiesArePowers) {
    Scene scene;
    add_light(scene, Quadric(Sphere{.world_from_object = {}}));             // area 4 pi, radiance 2
    add_light(scene, Vec3f{0, 0, 0}, Vec3f{1, 0, 0}, Vec3f{0, 1, 0});       // area 1/2
    add_light(scene, Vec3f{0, 0, 0}, Vec3f{1, 0, 0}, Vec3f{0, 1, 0}, true); // both sides
    scene.lights.push_back(PointLight{1.0f, 3, {0, 0, 0}});
    scene.lights.push_back(SpotLight{1.0f, 3, {0, 0, 0}, {0, 0, 1}, 0.9f, 0.7f});
    scene.lights.push_back(DistantLight{1.0f, 0.5f, {0, 0, 1}});
    scene.lights.push_back(UniformInfiniteLight{1.0f, 0.25f});
    scene.lights.push_back(PointLight{0.0f, 3, {0, 0, 0}});
    SceneTables tables(scene, {}, LightSampling::power);
    const LightSampler& lights = *tables.view().light_sampler;
    double r = tables.view().light_tables.scene_bounds.radius(), cross_section = pi * r * r;
    EXPECT_GE(r, 1);
    // The smoothstep of a spot has mean 1/2 over the rim.
    const double powers[] = {pi * 4 * pi * 2,
                             pi * 0.5 * 2,
                             pi * 0.5 * 2 * 2,
                             4 * pi * 3,
                             2 * pi * 3 * (0.1 + 0.5 * 0.2),
                             cross_section * 0.5,
                             4 * pi * cross_section * 0.25,
                             0};
    double total = 0, sum = 0;
    for (double p : powers) total += p;
    for (Index i = 0; i < 8; ++i) {
        EXPECT_NEAR(double(lights.probability(origin, i, 0)), powers[i] / total, 1e-5) << i;
        sum += double(lights.probability(origin, i, 0));
    }
    EXPECT_NEAR(sum, 1, 1e-6);
    ASSERT_EQ(tables.view().light_tables.infinite_lights.size(), 1u);
    EXPECT_EQ(tables.view().light_tables.infinite_lights[0], 6u);
    TestUniforms uniforms(2);
    std::vector<double> counts(8), expected;
    for (double p : powers) expected.push_back(p / total * 100000);
    for (int i = 0; i < 100000; ++i) {
        auto chosen = lights.sample(origin, uniforms.next());
        counts[chosen.light] += 1;
        ASSERT_EQ(chosen.probability, lights.probability(origin, chosen.light, chosen.part));
    }
    TestResult result = chi_squared_test(counts, expected);
    EXPECT_TRUE(result.passes(1e-8)) << result.description;
}

// A constant map is a uniform sky.
TEST(LightTables, AMapHasThePowerOfItsMean) {
    Scene scene;
    add_light(scene, Quadric(Sphere{.world_from_object = {}}));
    Image map(4, 4, {"R", "G", "B"});
    std::fill(map.f32().begin(), map.f32().end(), 0.5f);
    scene.environments.push_back(map);
    scene.lights.push_back(ImageInfiniteLight{.environment = 0, .scale = 3, .world_from_light = {}});
    scene.lights.push_back(UniformInfiniteLight{
        add_spectrum(scene, RgbIlluminantSpectrum(RgbColorSpace::srgb(), {1, 1, 1})), 1.5f});
    SceneTables tables(scene);
    EXPECT_NEAR(double(tables.view().light_sampler->probability({}, 1, 0)),
                double(tables.view().light_sampler->probability({}, 2, 0)), 1e-4);
}

} // namespace
} // namespace montelux
