// Tangents of a mesh's vertices turn the shading frame, and with it anisotropic lobes and normal maps.
#include <algorithm>
#include <gtest/gtest.h>
#include <iterator>

#include "montelux/scene/build/geometry.h"
#include "montelux/scene/material/make_bsdf.h"
#include "montelux/scene/scene_tables.h"
#include "montelux/scene/shape/surface_point.h"

namespace montelux {
namespace {

// A triangle in the plane z = 0 with u along x, its instance turned by 90 degrees about z.
Scene scene_of_triangle(const std::vector<Vec3f>& tangents) {
    Scene s;
    s.meshes.push_back(
        {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}, {{0, 0}, {1, 0}, {0, 1}}, {0, 1, 2}, tangents});
    ConductorMaterial m;
    m.roughness.u.value = 0.2f;
    m.roughness.v.value = 0.5f;
    s.materials = {m, DiffuseMaterial{.detail = {.normal_map = {0}}}};
    Image normal(1, 1, {"R", "G", "B"}, PixelFormat::f32, ColorEncoding::linear());
    const float leaning[] = {0.8f, 0.5f, 0.9f}; // along the first axis
    std::copy(std::begin(leaning), std::end(leaning), normal.f32().begin());
    s.images = {normal};
    s.normal_maps = {ImageTexture{.image = 0, .mapping = {}}};
    s.shapes = {{.geometry = MeshIndex{0}, .material = 0}, {.geometry = MeshIndex{0}, .material = 1}};
    s.world_shapes = {0, 1};
    s.objects = {{{0}}};
    s.instances = {{.object = 0, .world_from_object = Transform::rotate(90, {0, 0, 1})}};
    return s;
}

SurfaceBsdf bsdf_at(const Scene& scene, const Hit& hit) {
    const SceneTables tables(scene);
    const Ray ray{{0.3f, 0.3f, 1}, {0, 0, -1}};
    const SurfacePoint s = surface_point(tables.view(), ray, hit, true);
    TextureContext context;
    context.uv = s.uv;
    SampledWavelengths lambda = SampledWavelengths::sample_visible(0.5f);
    return make_bsdf(tables.view(), s, {0, 0, 1}, context, lambda);
}
Hit hit_of(Index shape, Index instance = no_index) {
    Hit h;
    h.t = 1;
    h.b1 = h.b2 = 0.25f;
    h.shape = shape;
    h.instance = instance;
    return h;
}
void expect_same_direction(Vec3f a, Vec3f b) {
    EXPECT_LT(length(a - b), 1e-5f) << a.x << ' ' << a.y << ' ' << a.z;
}

TEST(VertexTangents, TurnTheShadingFrame) {
    expect_same_direction(bsdf_at(scene_of_triangle({}), hit_of(0)).frame.s, {1, 0, 0});
    // Interpolated at (1/2, 1/4, 1/4), and only what is across the normal counts.
    const Scene turned = scene_of_triangle({{0, 1, 5}, {1, 0, 5}, {-1, 0, 5}});
    expect_same_direction(bsdf_at(turned, hit_of(0)).frame.s, {0, 1, 0});
    expect_same_direction(bsdf_at(turned, hit_of(0, 0)).frame.s, {-1, 0, 0});
    // Without a sum there is none.
    expect_same_direction(bsdf_at(scene_of_triangle({{0, 1, 0}, {0, -1, 0}, {0, -1, 0}}), hit_of(0)).frame.s,
                          {1, 0, 0});
}

TEST(VertexTangents, AreTheAxisOfNormalMaps) {
    expect_same_direction(bsdf_at(scene_of_triangle({}), hit_of(1)).frame.n, normalize(Vec3f(0.6f, 0, 0.8f)));
    expect_same_direction(bsdf_at(scene_of_triangle({{0, 2, 0}, {0, 2, 0}, {0, 2, 0}}), hit_of(1)).frame.n,
                          normalize(Vec3f(0, 0.6f, 0.8f)));
}

} // namespace
} // namespace montelux
