// Pictures of normal maps, bumps and sheets that transmit light.
#include "test/render/scene_testing.h"
#include <gtest/gtest.h>

#include "montelux/mc/stats/chi_squared.h"

namespace montelux::testing {
namespace {

// Shading normals as a picture; one pixel is the same everywhere.
Index add_normal_map(Scene& scene, int size, const std::function<Vec3f(int, int)>& n) {
    Image image(size, size, {"R", "G", "B"});
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x)
            for (int c = 0; c < 3; ++c) image.set(x, y, c, 0.5f * (n(x, y)[c] + 1));
    scene.images.push_back(image);
    scene.normal_maps.push_back({.image = static_cast<Index>(scene.images.size() - 1), .mapping = {}});
    return static_cast<Index>(scene.normal_maps.size() - 1);
}
Index add_constant_map(Scene& scene, Vec3f n) {
    return add_normal_map(scene, 1, [n](int, int) { return n; });
}

template <typename M>
Material with_map(M m, Index map) {
    m.detail.normal_map.map = map;
    return m;
}

RoughnessParameter rough(float u, float v) { return {FloatParameter{u}, FloatParameter{v}, false}; }

std::vector<Material> materials() {
    return {
        DiffuseMaterial{gray(0.7f)},
        DiffuseTransmissionMaterial{gray(0.4f), gray(0.5f)},
        ConductorMaterial{.metal = {}, .roughness = rough(0.2f, 0.2f)},
        ConductorMaterial{.metal = {}, .roughness = rough(0.1f, 0.4f)},
        DielectricMaterial{1.5f, rough(0.1f, 0.1f)},
        CoatedDiffuseMaterial{gray(0.6f), CoatingParameters{.roughness = rough(0.2f, 0.2f)}},
        CoatedConductorMaterial{{}, rough(0.3f, 0.3f), CoatingParameters{.roughness = rough(0.1f, 0.1f)}}};
}

TEST(NormalMap, FlatOneChangesNoBit) {
    for (const Material& material : materials()) {
        SceneBuilder plain;
        plain.add_quadric(Sphere{}, plain.add(material));
        plain.add_mesh(square(Transform::translate({0, 0, -1}) * Transform::scale({4, 4, 1})),
                       plain.add(material));
        plain.add_uniform_light(1);
        plain.look({0, -4, 1}, {0, 0, 0}, 40);
        plain.description.sampler.spp = 8;
        SceneBuilder mapped(plain);
        const Index map = add_constant_map(mapped.scene, {0, 0, 1});
        mapped.scene.float_textures.push_back(ConstantTexture<FloatParameter>{{0.3f}});
        for (Material& m : mapped.scene.materials)
            std::visit(
                [&](auto& x) {
                    x.detail.normal_map.map = map;
                    x.detail.displacement.texture = 0;
                },
                m);
        const Film a = render(plain.description), b = render(mapped.description);
        for (int y = 0; y < 8; ++y)
            for (int x = 0; x < 8; ++x)
                EXPECT_TRUE(same_pixel(a.pixel(x, y), b.pixel(x, y))) << material.index();
    }
}

// A floor with uv along x and y, seen from above by the light of a lamp.
SceneBuilder floor_under_lamp(const Material& material, Vec3f vertex_normal) {
    SceneBuilder b;
    TriangleMesh floor = square(Transform::scale({2, 2, 1}));
    floor.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    if (length(vertex_normal) > 0) floor.normals.assign(4, normalize(vertex_normal));
    b.add_mesh(std::move(floor), b.add(material));
    b.scene.lights.push_back(PointLight{white_light(b.scene), 10 * white_scale(), {1, 0.5f, 3}});
    b.look({0.2, 0.1, 4}, {0, 0, 0}, 30);
    b.description.integrator.max_depth = 1;
    b.description.sampler.spp = 16;
    return b;
}

void expect_same_pictures(const Film& a, const Film& b, double tolerance) {
    double least = 1e9, most = 0;
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x) {
            const double v = a.pixel(x, y).replicates().mean(1);
            EXPECT_NEAR(v, b.pixel(x, y).replicates().mean(1), tolerance * v);
            least = std::min(least, v);
            most = std::max(most, v);
        }
    EXPECT_GT(least, 0);
    EXPECT_GT(most, 1.05 * least);
}

TEST(NormalMap, ConstantOneEqualsVertexNormals) {
    const Vec3f n = normalize(Vec3f{0.25f, -0.15f, 1});
    for (const Material& material :
         {Material(DiffuseMaterial{gray(0.7f)}),
          Material(ConductorMaterial{.metal = {}, .roughness = rough(0.4f, 0.4f)})}) {
        SceneBuilder mapped = floor_under_lamp(material, {});
        const Index map = add_constant_map(mapped.scene, n);
        std::visit([&](auto& m) { m.detail.normal_map.map = map; }, mapped.scene.materials[0]);
        const Film tilted = render(floor_under_lamp(material, n).description);
        expect_same_pictures(render(mapped.description), tilted, 1e-3);
        EXPECT_NEAR(render(mapped.description).pixel(4, 4).normal().x, n.x, 1e-4);
    }
}

TEST(Bumps, RampEqualsVertexNormals) {
    SceneBuilder bumpy = floor_under_lamp(DiffuseMaterial{gray(0.7f)}, {});
    constexpr int size = 128;
    Image ramp(size, size, {"Y"});
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x)
            ramp.set(x, y, 0, (0.5f * static_cast<float>(x) + 0.25f * static_cast<float>(size - y)) / size);
    bumpy.scene.images.push_back(ramp);
    ImageTexture texture;
    texture.image = 0;
    bumpy.scene.float_textures.push_back(texture);
    std::get<DiffuseMaterial>(bumpy.scene.materials[0]).detail.displacement.texture = 0;
    // The floor has sides of 4.
    const Vec3f n{-0.5f / 4, -0.25f / 4, 1};
    const Film tilted = render(floor_under_lamp(DiffuseMaterial{gray(0.7f)}, n).description);
    expect_same_pictures(render(bumpy.description), tilted, 2e-3);
}

Index add_rough_map(Scene& scene, float spread) {
    TestUniforms uniforms(5);
    return add_normal_map(scene, 16, [&](int, int) {
        return Vec3f{spread * (2 * uniforms.next_float() - 1), spread * (2 * uniforms.next_float() - 1), 1};
    });
}

// A map takes energy away, where it sends light below the surface, and adds none.
TEST(NormalMap, WhiteFurnaceGainsNothing) {
    MetalParameter mirror{.reflectance = gray(1), .from_reflectance = true};
    const Material cases[] = {DiffuseMaterial{gray(1)},
                              DiffuseTransmissionMaterial{gray(0.6f), gray(0.4f)},
                              ConductorMaterial{mirror, rough(0, 0)},
                              ConductorMaterial{mirror, rough(0.3f, 0.3f)},
                              DielectricMaterial{1.5f, rough(0, 0)},
                              DielectricMaterial{1.5f, rough(0.2f, 0.2f)}};
    for (const Material& material : cases)
        for (float spread : {0.3f, 1.5f}) {
            SceneBuilder b;
            const Index map = add_rough_map(b.scene, spread);
            Material mapped = material;
            std::visit([&](auto& m) { m.detail.normal_map.map = map; }, mapped);
            b.add_quadric(Sphere{}, b.add(mapped));
            b.add_uniform_light(1);
            b.look({0, -4, 1}, {0, 0, 0}, 25);
            b.description.integrator.max_depth = 100;
            const PictureMean m = picture_mean(render(b.description));
            EXPECT_LT(m.mean, 1 + 5 * m.standard_error + 1e-4) << material.index() << ' ' << spread;
            EXPECT_GT(m.mean, spread < 1 ? 0.8 : 0.5) << material.index() << ' ' << spread;
        }
}

TEST(NormalMap, StrategiesAgree) {
    const Material cases[] = {DiffuseMaterial{gray(0.7f)},
                              DiffuseTransmissionMaterial{gray(0.4f), gray(0.5f)},
                              ConductorMaterial{.metal = {}, .roughness = rough(0.5f, 0.5f)},
                              DielectricMaterial{1.5f, rough(0.5f, 0.5f)}};
    for (const Material& material : cases) {
        std::vector<PictureMean> means;
        for (Strategy s : {Strategy::mis, Strategy::light, Strategy::bsdf, Strategy::uniform}) {
            SceneBuilder b;
            const Index map = add_rough_map(b.scene, 0.8f);
            Material mapped = material;
            std::visit([&](auto& m) { m.detail.normal_map.map = map; }, mapped);
            b.add_mesh(square(Transform::scale({3, 3, 1})), b.add(mapped));
            const Index black = b.add(DiffuseMaterial{gray(0)});
            b.add_mesh(square(Transform::translate({0, 0, 2}) * Transform::rotate(180, {1, 0, 0})), black, 3);
            b.add_mesh(square(Transform::translate({0, 0, -2})), black, 3);
            b.look({0, -3, 1.5}, {0, 0, 0}, 40);
            b.description.integrator.strategy = s;
            b.description.integrator.max_depth = 2;
            b.description.sampler.spp = 1024;
            means.push_back(picture_mean(render(b.description)));
            EXPECT_GT(means.back().mean, 8 * means.back().standard_error);
            EXPECT_NEAR(means.back().mean, means[0].mean,
                        5 * std::hypot(means.back().standard_error, means[0].standard_error))
                << material.index() << " strategy " << int(s);
        }
    }
}

// Light behind an opaque sheet stays there, however its normals are tilted.
TEST(NormalMap, OpaqueSheetsDoNotLeak) {
    for (const Material& material : {materials()[0], materials()[2], materials()[3], materials()[5]}) {
        SceneBuilder b;
        const Index map = add_rough_map(b.scene, 2);
        Material mapped = material;
        std::visit([&](auto& m) { m.detail.normal_map.map = map; }, mapped);
        b.add_mesh(square(Transform::scale({20, 20, 1})), b.add(mapped));
        b.scene.lights.push_back(PointLight{white_light(b.scene), white_scale(), {0.5f, 0.5f, -1}});
        b.add_mesh(square(Transform::translate({0, 0, -2})), b.add(DiffuseMaterial{gray(0)}), 1);
        b.look({0, -3, 1.5}, {0, 0, 0}, 40);
        EXPECT_EQ(picture_mean(render(b.description)).mean, 0) << material.index();
    }
}

// A sheet under a lamp: reflectance or transmittance times irradiance over pi.
TEST(DiffuseTransmission, SheetsShineOnBothSides) {
    for (bool behind : {false, true})
        for (float scale : {1.0f, 0.5f}) {
            SceneBuilder b;
            b.add_mesh(square(Transform::scale({4, 4, 1})),
                       b.add(DiffuseTransmissionMaterial{gray(0.5f), gray(0.25f), scale}));
            b.scene.lights.push_back(
                PointLight{white_light(b.scene), white_scale(), {0, 0, behind ? -2.0f : 2.0f}});
            b.look({0, 0, 3}, {0, 0, 0}, 0.5);
            b.description.integrator.max_depth = 3;
            const double truth = (behind ? 0.25 : 0.5) * double(scale) / pi / 4;
            EXPECT_NEAR(picture_mean(render(b.description)).mean, truth, 1e-3 * truth) << behind;
        }
}

} // namespace
} // namespace montelux::testing
