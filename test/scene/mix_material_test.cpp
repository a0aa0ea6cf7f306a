// Mixes of materials: the share of each, the same choice at the same point, mixes of mixes.
#include <cmath>
#include <gtest/gtest.h>

#include "montelux/mc/stats/chi_squared.h"
#include "montelux/scene/material/make_bsdf.h"
#include "montelux/scene/scene_tables.h"

namespace montelux {
namespace {

// Black, white and red-hot numbers: the reflectance tells which material was chosen.
struct MixedSheet {
    Scene scene;

    MixedSheet() {
        TriangleMesh mesh;
        mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
        mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
        mesh.indices = {0, 1, 2, 0, 2, 3};
        scene.meshes.push_back(mesh);
        scene.shapes.push_back(Shape{.geometry = MeshIndex{0}, .material = 0});
        scene.world_shapes = {0};
    }
    // The reflectance at point (x, y) seen from `wo`.
    float reflectance(const SceneView& view, float x, float y, Vec3f wo = {0, 0, 1}) const {
        const Ray ray{{x, y, 1}, {0, 0, -1}};
        // x = -1 + 2 b1 + 2 b2, y = -1 + 2 b2 of the first triangle, where x > y.
        const Hit hit{.t = 1, .b1 = (x - y) / 2, .b2 = (y + 1) / 2, .shape = 0, .instance = no_index};
        const SurfacePoint s = surface_point(view, ray, hit, true);
        TextureContext context{
            .p = s.p, .n = s.ns, .uv = s.uv, .dpdx = {}, .dpdy = {}, .duvdx = {}, .duvdy = {}};
        SampledWavelengths lambda = SampledWavelengths::sample_visible(0.5f);
        return std::get<DiffuseBsdf>(make_bsdf(view, s, wo, context, lambda).bsdf).reflectance[0];
    }
    double mean(int count, std::uint64_t seed) const {
        const SceneTables tables(scene);
        TestUniforms u(seed);
        double sum = 0;
        for (int i = 0; i < count; ++i) {
            float x = 2 * u.next_float() - 1, y = 2 * u.next_float() - 1;
            if (x < y) std::swap(x, y);
            sum += double(reflectance(tables.view(), x, y));
        }
        return sum / count;
    }
};

DiffuseMaterial grey(float reflectance) { return {.reflectance = {reflectance}}; }

// Six standard errors of a mean of values between 0 and 1.
constexpr int points = 40000;
constexpr double tolerance = 6 * 0.5 / 200;

TEST(MixMaterial, HasItsSharesOnAverage) {
    for (float amount : {0.0f, 0.2f, 0.5f, 0.9f, 1.0f}) {
        MixedSheet sheet;
        sheet.scene.materials = {MixMaterial{.materials = {{1}, {2}}, .amount = {amount}}, grey(0), grey(1)};
        const double mean = sheet.mean(points, 1);
        if (amount == 0 || amount == 1) {
            EXPECT_EQ(mean, double(amount));
        } else {
            EXPECT_NEAR(mean, double(amount), tolerance);
        }
    }
}

// The parts of a mix of mixes are chosen independently: with one hash for both, nothing would be 0.6.
TEST(MixMaterial, NestedOnesChooseIndependently) {
    MixedSheet sheet;
    sheet.scene.materials = {MixMaterial{.materials = {{1}, {2}}, .amount = {0.5f}}, grey(0),
                             MixMaterial{.materials = {{3}, {4}}, .amount = {0.5f}}, grey(0.6f), grey(1)};
    EXPECT_NEAR(sheet.mean(points, 2), 0.25 * 0.6 + 0.25, tolerance);
}

TEST(MixMaterial, ChoosesTheSameAtTheSamePoint) {
    MixedSheet sheet;
    sheet.scene.materials = {MixMaterial{.materials = {{1}, {2}}, .amount = {0.5f}}, grey(0), grey(1)};
    const SceneTables first(sheet.scene), second(sheet.scene);
    int turned = 0;
    for (int i = 0; i < 1000; ++i) {
        const float x = static_cast<float>(i) / 1000, y = -0.3f;
        const float r = sheet.reflectance(first.view(), x, y);
        EXPECT_EQ(sheet.reflectance(second.view(), x, y), r);
        turned += sheet.reflectance(first.view(), x, y, {0.6f, 0, 0.8f}) == r ? 0 : 1;
    }
    // From another direction another choice: half of them differ.
    EXPECT_NEAR(turned, 500, 6 * std::sqrt(250.0));
}

TEST(MixMaterial, FollowsATextureOfTheAmount) {
    MixedSheet sheet;
    sheet.scene.float_textures = {
        CheckerboardTexture<FloatParameter>{.dimension = 2, .mapping = {}, .values = {{{1}, {0}}}}};
    auto& mapping = std::get<CheckerboardTexture<FloatParameter>>(sheet.scene.float_textures[0]).mapping;
    mapping.su = mapping.sv = 2; // cells of a unit, where uv is half a unit
    sheet.scene.materials = {MixMaterial{.materials = {{1}, {2}}, .amount = {0, 0}}, grey(0), grey(1)};
    const SceneTables tables(sheet.scene);
    EXPECT_NE(sheet.reflectance(tables.view(), 0.5f, 0.3f), sheet.reflectance(tables.view(), 0.5f, -0.3f));
}

} // namespace
} // namespace montelux
