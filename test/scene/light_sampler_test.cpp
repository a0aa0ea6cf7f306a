// Choice of lights: probabilities are those of the choices and add up to 1, and the number that is left over
// is uniform. Chi-squared tests at the level of significance.h: below 1e-5 for the file.
#include "test/significance.h"
#include <gtest/gtest.h>
#include <limits>
#include <numeric>

#include "montelux/mc/stats/chi_squared.h"
#include "montelux/scene/scene_tables.h"

namespace montelux {
namespace {

// A point, a mesh of four triangles, a black mesh of two, an empty mesh, a mesh only inside an object, and a
// point.
Scene scene_of_lights() {
    Scene scene;
    scene.lights.push_back(PointLight{1.0f, 0.1f, {0, 0, 0}});
    auto add_mesh = [&](std::vector<Index> indices, float radiance, bool in_world) {
        const auto shape = static_cast<Index>(scene.shapes.size());
        Shape s;
        s.geometry = MeshIndex{static_cast<Index>(scene.meshes.size())};
        s.light = static_cast<Index>(scene.lights.size());
        TriangleMesh mesh;
        mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 2, 0}};
        mesh.indices = std::move(indices);
        scene.meshes.push_back(std::move(mesh));
        scene.shapes.push_back(s);
        if (in_world) scene.world_shapes.push_back(shape);
        scene.lights.push_back(AreaLight{1.0f, radiance, false, shape});
    };
    add_mesh({0, 1, 2, 0, 1, 3, 0, 0, 1, 0, 2, 1}, 1, true); // the third has no area
    add_mesh({0, 1, 2, 0, 1, 3}, 0, true);
    add_mesh({}, 1, true);
    add_mesh({0, 1, 2}, 1, false);
    scene.lights.push_back(PointLight{1.0f, 0.2f, {0, 0, 0}});
    return scene;
}
constexpr std::pair<Index, Index> parts[] = {{0, 0}, {1, 0}, {1, 1}, {1, 2}, {1, 3}, {2, 0}, {2, 1}, {5, 0}};

void expect_probabilities(const LightSampler& sampler, std::span<const double> expected) {
    ASSERT_EQ(sampler.size(), std::size(parts));
    std::vector<double> observed(std::size(parts)), left(32), counts;
    for (std::size_t i = 0; i < std::size(parts); ++i)
        EXPECT_NEAR(sampler.probability({}, parts[i].first, parts[i].second), expected[i], 1e-6) << i;
    constexpr int n = 100000;
    TestUniforms uniforms(2);
    for (int i = 0; i < n; ++i) {
        const LightChoice c = sampler.sample({}, uniforms.next());
        const auto* at = std::find(std::begin(parts), std::end(parts), std::pair(c.light, c.part));
        ASSERT_NE(at, std::end(parts));
        observed[static_cast<std::size_t>(at - parts)] += 1;
        ASSERT_EQ(c.probability, sampler.probability({}, c.light, c.part));
        ASSERT_GE(c.remapped, 0);
        ASSERT_LT(c.remapped, 1);
        left[static_cast<std::size_t>(c.remapped * 32)] += 1;
    }
    for (const double p : expected) counts.push_back(p * n);
    EXPECT_TRUE(chi_squared_test(observed, counts).passes(significance));
    EXPECT_TRUE(chi_squared_test(left, std::vector<double>(32, n / 32.0)).passes(significance));
}

TEST(LightSamplers, UniformOverAllParts) {
    const Scene scene = scene_of_lights();
    const SceneTables tables(scene, {}, LightSampling::uniform);
    expect_probabilities(*tables.view().light_sampler, std::vector<double>(8, 1.0 / 8));
}

TEST(LightSamplers, ByPower) {
    const Scene scene = scene_of_lights();
    const SceneTables tables(scene, {}, LightSampling::power);
    std::vector<double> powers = {4 * pi * 0.1, 0.5 * pi, pi, 0, 0.5 * pi, 0, 0, 4 * pi * 0.2};
    const double sum = std::accumulate(powers.begin(), powers.end(), 0.0);
    for (double& p : powers) p /= sum;
    expect_probabilities(*tables.view().light_sampler, powers);
}

// An estimate of power that overflows: such lights are sampled all the same, by each.
TEST(LightSamplers, InfinitePowerIsMuch) {
    Scene scene;
    constexpr float infinite = std::numeric_limits<float>::infinity();
    for (float scale : {infinite, 1.0f, infinite}) scene.lights.push_back(PointLight{1.0f, scale, {0, 0, 0}});
    const SceneTables tables(scene, {}, LightSampling::power);
    const LightSampler& lights = *tables.view().light_sampler;
    EXPECT_EQ(lights.probability({}, 0, 0), 0.5f);
    EXPECT_EQ(lights.probability({}, 1, 0), 0);
    EXPECT_EQ(lights.probability({}, 2, 0), 0.5f);
}

// The sky sends a hundred times the spot's power through a wide scene, and the spot most of the light to where it shines.
TEST(LightSamplers, ATreeForASpotBelowTheSky) {
    Scene scene;
    TriangleMesh floor;
    floor.positions = {{-10, -10, 0}, {10, -10, 0}, {0, 10, 0}};
    floor.indices = {0, 1, 2};
    scene.meshes.push_back(floor);
    scene.shapes.push_back({.geometry = MeshIndex{0}});
    scene.world_shapes.push_back(0);
    scene.lights.push_back(UniformInfiniteLight{1.0f, 0.1f});
    scene.lights.push_back(SpotLight{.spectrum = 1.0f,
                                     .scale = 5,
                                     .position = {0, 0, 1},
                                     .axis = {0, 0, -1},
                                     .cos_falloff_start = 0.96f,
                                     .cos_total_width = 0.94f});
    const SceneTables by_tree(scene), by_power(scene, {}, LightSampling::power);
    const ReferencePoint lit{.p = {0, 0, 0}, .n = {0, 0, 1}}, beside{.p = {3, 0, 0}, .n = {0, 0, 1}};
    EXPECT_LT(by_power.view().light_sampler->probability(lit, 1, 0), 0.05f);
    EXPECT_GT(by_tree.view().light_sampler->probability(lit, 1, 0), 0.7f);
    EXPECT_GT(by_tree.view().light_sampler->probability(beside, 0, 0), 0.9f);
}

// Two lights of points are chosen by their power, more by a tree.
TEST(LightSamplers, ATreeFromThreePartsOn) {
    Scene scene;
    for (const float x : {0.0f, 10.0f}) scene.lights.push_back(PointLight{1.0f, 1, {x, 0, 0}});
    const ReferencePoint near_first{.p = {1, 0, 0}};
    EXPECT_EQ(SceneTables(scene).view().light_sampler->probability(near_first, 0, 0), 0.5f);
    scene.lights.push_back(PointLight{1.0f, 1, {20, 0, 0}});
    EXPECT_GT(SceneTables(scene).view().light_sampler->probability(near_first, 0, 0), 0.9f);
}

TEST(LightSamplers, WithoutLights) {
    for (const LightSampling sampling : {LightSampling::uniform, LightSampling::power, LightSampling::tree}) {
        Scene scene;
        EXPECT_TRUE(SceneTables(scene, {}, sampling).view().light_sampler->empty());
        scene.lights.push_back(PointLight{0.0f, 1, {0, 0, 0}});
        const SceneTables black(scene, {}, sampling);
        EXPECT_EQ(black.view().light_sampler->size(), 1u);
        EXPECT_EQ(black.view().light_sampler->probability({}, 0, 0), 1);
    }
}

} // namespace
} // namespace montelux
