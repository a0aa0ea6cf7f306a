// Pictures with multiple scattering between microfacets, and with soft shading terminators. Comparisons are at 5 to 6
// standard errors.
#include "test/render/scene_testing.h"
#include <gtest/gtest.h>

#include "montelux/render/sample_record.h"
#include "montelux/scene/material/make_bsdf.h"

namespace montelux::testing {
namespace {

// Six standard errors.
void expect_same_of_strategies(SceneDescription description) {
    std::vector<PictureMean> means;
    for (Strategy s : {Strategy::mis, Strategy::light, Strategy::bsdf, Strategy::uniform}) {
        description.integrator.strategy = s;
        means.push_back(picture_mean(render(description)));
    }
    EXPECT_GT(means[0].mean, 0.01);
    for (std::size_t i = 1; i < means.size(); ++i)
        EXPECT_NEAR(means[i].mean, means[0].mean,
                    6 * std::hypot(means[i].standard_error, means[0].standard_error) + 1e-4 * means[0].mean)
            << i;
}

using Outcome = DirectLight::Outcome;

RoughnessParameter roughness_of(float u, float v) { return {FloatParameter{u}, FloatParameter{v}, false}; }

// A sphere of few triangles around the origin with the normals of a true one.
TriangleMesh coarse_sphere(float radius, Index columns, Index rows, Vec3f center = {}) {
    TriangleMesh m;
    for (Index j = 0; j <= rows; ++j)
        for (Index i = 0; i < columns; ++i) {
            const double theta = pi * j / rows, phi = 2 * pi * i / columns;
            const Vec3f n(
                Vec3d{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)});
            m.positions.push_back(center + n * radius);
            m.normals.push_back(n);
        }
    for (Index j = 0; j < rows; ++j)
        for (Index i = 0; i < columns; ++i) {
            const Index next = (i + 1) % columns, a = j * columns + i, b = j * columns + next;
            if (j > 0) m.indices.insert(m.indices.end(), {a, a + columns, b});
            if (j + 1 < rows) m.indices.insert(m.indices.end(), {b, a + columns, b + columns});
        }
    return m;
}

// The materials that lose light between their facets, all without absorption.
std::vector<std::pair<const char*, Material>> white_materials(float u, float v) {
    const RoughnessParameter rough = roughness_of(u, v);
    const CoatingParameters clear{
        .roughness = rough, .eta = 1.5f, .thickness = {0}, .albedo = gray(0), .g = {0}, .max_depth = 2000};
    // Nearest to reflectance 1: Fresnel's formula for an index of i.
    MetalParameter white;
    white.eta.value = 0;
    white.k.value = 1;
    MetalParameter under_coat; // relative to the coat
    under_coat.eta.value = 0;
    under_coat.k.value = 1.5f;
    return {{"conductor", ConductorMaterial{.metal = white, .roughness = rough}},
            {"dielectric", DielectricMaterial{1.5f, rough}},
            {"coated diffuse", CoatedDiffuseMaterial{gray(1), clear}},
            {"coated conductor", CoatedConductorMaterial{under_coat, rough, clear}}};
}

SceneBuilder furnace_around(const Material& material) {
    SceneBuilder b;
    b.add_quadric(Sphere{}, b.add(material));
    b.add_uniform_light(1);
    b.look({0, -4, 1}, {0, 0, 0}, 40);
    b.description.integrator.max_depth = 1000;
    b.description.sampler.spp = 128;
    return b;
}

// What neither absorbs nor emits cannot be seen against uniform light, also where it is rough.
TEST(MicrofacetScattering, MultipleMakesWhiteFurnacesOfRoughMaterials) {
    for (const auto& alpha : {Vec2f{0.3f, 0.3f}, Vec2f{1, 1}, Vec2f{0.2f, 0.8f}})
        for (const auto& [name, material] : white_materials(alpha.x, alpha.y)) {
            SceneBuilder b = furnace_around(material);
            b.description.integrator.microfacet_scattering = MicrofacetScattering::multiple;
            const PictureMean m = picture_mean(render(b.description));
            EXPECT_NEAR(m.mean, 1, 5 * m.standard_error + 1.5e-3) << name << ", alpha " << alpha.x;
            EXPECT_LT(m.standard_error, 0.015) << name;
        }
}

// Without the option they are darker: the furnace above tells the two apart.
TEST(MicrofacetScattering, SingleLosesLight) {
    for (const auto& [name, material] : white_materials(0.8f, 0.8f)) {
        const PictureMean m = picture_mean(render(furnace_around(material).description));
        EXPECT_LT(m.mean, 0.97) << name;
    }
}

// Stochastic values and reported densities serve every way to find light.
TEST(MicrofacetScattering, StrategiesAgree) {
    for (const Material& material :
         {Material(ConductorMaterial{.metal = {.reflectance = gray(0.8f), .from_reflectance = true},
         .roughness = roughness_of(0.4f, 0.9f)}),
          Material(DielectricMaterial{1.5f, roughness_of(0.6f, 0.6f)}),
          Material(
              CoatedDiffuseMaterial{gray(0.8f), CoatingParameters{.roughness = roughness_of(0.5f, 0.5f)}})}) {
        SceneBuilder b;
        b.add_quadric(Sphere{}, b.add(material));
        const Index black = b.add(DiffuseMaterial{gray(0)});
        b.add_mesh(square(Transform::translate({0, -1, 3}) * Transform::rotate(180, {1, 0, 0})), black, 5);
        b.add_mesh(square(Transform::translate({0, 2, -3})), black, 3);
        b.look({0, -4, 1}, {0, 0, 0}, 40);
        b.description.integrator.max_depth = 4;
        b.description.integrator.microfacet_scattering = MicrofacetScattering::multiple;
        b.description.sampler.spp = 256;
        expect_same_of_strategies(b.description);
    }
}

SceneBuilder coarse_scene(ShadingTerminator terminator) {
    SceneBuilder b;
    b.add_mesh(coarse_sphere(1, 10, 6), b.add(DiffuseMaterial{gray(0.5f)}));
    // From the right: the camera looks at facets that turn away before the smooth sphere does.
    b.scene.lights.push_back(
        DistantLight{white_light(b.scene), white_scale(), normalize(Vec3f{1, 0.09f, 0.1f})});
    b.look({0, -4, 0.5}, {0, 0, 0}, 40);
    b.description.integrator.max_depth = 1;
    b.description.integrator.shading_terminator = terminator;
    b.description.film.width = b.description.film.height = 24;
    b.description.film.crop = {0, 0, 24, 24};
    return b;
}

struct LitCount {
    int lit = 0, shadowed = 0, dark = 0;
};
// Samples at which the smooth surface faces the light.
LitCount count_lit(const SceneBuilder& b) {
    const Renderer renderer(b.description);
    LitCount count;
    for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 24; ++x)
            for (std::uint64_t i = 0; i < 8; ++i) {
                const PathRecord path = renderer.replay(x, y, i).path;
                const PathVertex& first = path.vertices.front();
                if (!first.bsdf || !first.direct || !first.surface) continue;
                // On silhouettes the camera may see a facet whose normals turn away.
                if (!(dot(first.ray.d, first.surface->ns) < 0)) continue;
                switch (first.direct->outcome) {
                case Outcome::counted:
                    ++count.lit;
                    break;
                case Outcome::occluded:
                    ++count.shadowed;
                    break;
                default:
                    ++count.dark;
                }
            }
    return count;
}

TEST(ShadingTerminator, SoftDoesNotLetFacetsShadowASmoothSphere) {
    const LitCount hard = count_lit(coarse_scene(ShadingTerminator::hard)),
                   soft = count_lit(coarse_scene(ShadingTerminator::soft));
    EXPECT_GT(hard.shadowed, 50);
    EXPECT_EQ(soft.shadowed, 0);
    EXPECT_EQ(soft.lit, hard.lit + hard.shadowed);
    EXPECT_EQ(soft.dark, hard.dark);
    EXPECT_GT(soft.dark, 50);
}

// A medium in no shape: the picture is made by the integrator of volumes.
TEST(ShadingTerminator, SoftServesPathsThroughMedia) {
    SceneBuilder b = coarse_scene(ShadingTerminator::soft);
    b.description.sampler.spp = 1024;
    const PictureMean surfaces = picture_mean(render(b.description));
    b.scene.media.push_back(HomogeneousMedium{});
    const PictureMean volumes = picture_mean(render(b.description));
    b.description.integrator.shading_terminator = ShadingTerminator::hard;
    const PictureMean hard = picture_mean(render(b.description));
    const double error = std::hypot(surfaces.standard_error, volumes.standard_error);
    EXPECT_NEAR(volumes.mean, surfaces.mean, 5 * error);
    EXPECT_GT(volumes.mean - hard.mean, 20 * error);
}

// Normal maps are bounded by the smooth surface, not by the facet.
TEST(ShadingTerminator, SoftServesTiltedNormals) {
    SceneBuilder b = coarse_scene(ShadingTerminator::soft);
    Image image(1, 1, {"R", "G", "B"});
    const Vec3f tilted = normalize(Vec3f{0.3f, 0.1f, 1});
    for (int c = 0; c < 3; ++c) image.set(0, 0, c, 0.5f * (tilted[c] + 1));
    b.scene.images.push_back(image);
    b.scene.normal_maps.push_back({.image = 0, .mapping = {}});
    std::get<DiffuseMaterial>(b.scene.materials[0]).detail.normal_map.map = 0;
    const Renderer renderer(b.description);
    int beyond = 0; // samples where the facet faces away
    for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 24; ++x)
            for (std::uint64_t i = 0; i < 8; ++i) {
                const PathRecord path = renderer.replay(x, y, i).path;
                const PathVertex& first = path.vertices.front();
                if (!first.bsdf || !first.direct || !first.surface) continue;
                const Vec3f to_light = normalize(Vec3f{1, 0.09f, 0.1f});
                if (!(dot(first.ray.d, first.surface->ns) < 0) ||
                    !(dot(to_light, first.surface->ns) > 0.01f) ||
                    !(dot(to_light, first.bsdf->frame.n) > 0.01f))
                    continue;
                EXPECT_EQ(first.direct->outcome, Outcome::counted) << x << ',' << y << ',' << i;
                beyond += dot(to_light, first.surface->ng) < 0 ? 1 : 0;
            }
    EXPECT_GT(beyond, 20);
}

// In hollows rays start where they did: above the facet, by more than the rounding error.
TEST(ShadingTerminator, SoftHollowsDoNotShadowThemselves) {
    SceneBuilder b;
    const Vec3f center{70, -30, 110};
    b.add_mesh(coarse_sphere(1, 10, 6, center), b.add(DiffuseMaterial{gray(0.5f)}));
    b.scene.lights.push_back(PointLight{white_light(b.scene), white_scale(), center});
    b.look(Vec3d(center) + Vec3d{0.3, 0.2, 0.1}, Vec3d(center) + Vec3d{1, 0, 0}, 90);
    b.description.integrator.max_depth = 1;
    b.description.integrator.shading_terminator = ShadingTerminator::soft;
    const Renderer renderer(b.description);
    int lit = 0;
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x)
            for (std::uint64_t i = 0; i < 64; ++i) {
                const PathRecord path = renderer.replay(x, y, i).path;
                ASSERT_TRUE(path.vertices.front().direct);
                lit += path.vertices.front().direct->outcome == Outcome::counted ? 1 : 0;
            }
    EXPECT_EQ(lit, 8 * 8 * 64);
}

// Light from all sides reaches a convex body as it reaches a true sphere, and nothing is gained.
TEST(ShadingTerminator, SoftSphereIsWhiteInAFurnace) {
    SceneBuilder b;
    b.add_mesh(coarse_sphere(1, 8, 5), b.add(DiffuseMaterial{gray(1)}));
    b.add_uniform_light(1);
    b.look({0, -4, 1}, {0, 0, 0}, 20);
    b.description.integrator.shading_terminator = ShadingTerminator::soft;
    b.description.integrator.max_depth = 2;
    const PictureMean soft = picture_mean(render(b.description));
    EXPECT_NEAR(soft.mean, 1, 5 * soft.standard_error + 2e-4);
    b.description.integrator.shading_terminator = ShadingTerminator::hard;
    EXPECT_LT(picture_mean(render(b.description)).mean, 0.995);
}

// Light sampling and paths start at the same point.
TEST(ShadingTerminator, StrategiesAgree) {
    SceneBuilder b;
    b.add_mesh(coarse_sphere(1, 7, 5), b.add(DiffuseMaterial{gray(0.7f)}));
    b.add_mesh(coarse_sphere(0.4f, 6, 4, {0.9f, -0.9f, 0.3f}),
               b.add(ConductorMaterial{.metal = {.reflectance = gray(0.8f), .from_reflectance = true},
                                       .roughness = roughness_of(0.3f, 0.3f)}));
    const Index black = b.add(DiffuseMaterial{gray(0)});
    b.add_mesh(square(Transform::translate({1.8, -0.5, 0.5}) * Transform::rotate(-90, {0, 1, 0}) *
                      Transform::scale({0.7, 0.7, 1})),
               black, 5);
    b.look({0, -4, 1}, {0, 0, 0}, 40);
    b.description.integrator.max_depth = 3;
    b.description.integrator.shading_terminator = ShadingTerminator::soft;
    b.description.sampler.spp = 400;
    expect_same_of_strategies(b.description);
}

// Flat meshes, and bodies that light passes, are what they were.
TEST(ShadingTerminator, SoftLeavesOthersAlone) {
    TriangleMesh flat = coarse_sphere(1, 8, 5);
    flat.normals.clear();
    const std::pair<TriangleMesh, Material> cases[] = {
        {flat, DiffuseMaterial{gray(0.7f)}},
        {coarse_sphere(1, 8, 5), DielectricMaterial{1.5f, roughness_of(0.3f, 0.3f)}},
        {coarse_sphere(1, 8, 5), DiffuseTransmissionMaterial{gray(0.4f), gray(0.5f)}}};
    for (const auto& [mesh, material] : cases) {
        SceneBuilder b;
        b.add_mesh(mesh, b.add(material));
        b.add_uniform_light(1);
        b.look({0, -4, 1}, {0, 0, 0}, 40);
        b.description.sampler.spp = 4;
        const Film hard = render(b.description);
        b.description.integrator.shading_terminator = ShadingTerminator::soft;
        const Film soft = render(b.description);
        for (int y = 0; y < 8; ++y)
            for (int x = 0; x < 8; ++x) EXPECT_TRUE(same_pixel(hard.pixel(x, y), soft.pixel(x, y)));
    }
}

// Batches of paths equal paths followed alone.
TEST(SurfaceOptions, ReplaysEqualThePicture) {
    SceneBuilder b = coarse_scene(ShadingTerminator::soft);
    b.add_quadric(Sphere{.radius = 0.4f, .world_from_object = Transform::translate({1.2, -0.6, 0})},
                  b.add(ConductorMaterial{.metal = {.reflectance = gray(0.8f), .from_reflectance = true},
                                          .roughness = roughness_of(0.5f, 0.5f)}));
    b.add_uniform_light(0.3f);
    b.description.integrator.microfacet_scattering = MicrofacetScattering::multiple;
    b.description.integrator.max_depth = 4;
    b.description.sampler.spp = 4;
    const Renderer renderer(b.description);
    Film film(b.description.film);
    renderer.render(film);
    for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 24; ++x) {
            Vec3d sum;
            for (std::uint64_t i = 0; i < 4; ++i) sum += Vec3d(renderer.replay(x, y, i).rgb) / 4.0;
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(film.pixel(x, y).replicates().mean(c), sum[c], 1e-6 * sum[c] + 1e-9)
                    << x << ',' << y;
        }
}

} // namespace
} // namespace montelux::testing
