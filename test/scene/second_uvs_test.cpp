// The second set of texture coordinates of a mesh: its coordinates, tangents, and who reads them.
#include <algorithm>
#include <gtest/gtest.h>
#include <iterator>

#include "montelux/mc/math/error.h"
#include "montelux/scene/build/geometry.h"
#include "montelux/scene/material/make_bsdf.h"
#include "montelux/scene/memory_use.h"
#include "montelux/scene/scene_tables.h"
#include "montelux/scene/shape/alpha.h"
#include "montelux/scene/shape/surface_point.h"

namespace montelux {
namespace {

// A triangle in the plane z = 0. Its first set is (x, y), its second one (4 y, -2 x); an instance turned by 90 degrees
// about z.
TriangleMesh two_sets() {
    TriangleMesh m{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}, {{0, 0}, {1, 0}, {0, 1}}, {0, 1, 2}};
    m.second_uvs = {{0, 0}, {0, -2}, {4, 0}};
    return m;
}
Scene scene_of(const TextureMapping& mapping) {
    Scene s;
    s.meshes = {two_sets()};
    s.materials = {DiffuseMaterial{.detail = {.normal_map = {0}}}};
    Image normal(1, 1, {"R", "G", "B"}, PixelFormat::f32, ColorEncoding::linear());
    const float leaning[] = {0.8f, 0.5f, 0.9f}; // along the first axis
    std::copy(std::begin(leaning), std::end(leaning), normal.f32().begin());
    s.images = {normal};
    s.normal_maps = {ImageTexture{.image = 0, .mapping = mapping}};
    s.shapes = {{.geometry = MeshIndex{0}, .material = 0}};
    s.world_shapes = {0};
    s.objects = {{{0}}};
    s.instances = {{.object = 0, .world_from_object = Transform::rotate(90, {0, 0, 1})}};
    return s;
}
TextureMapping second_set() {
    TextureMapping m;
    m.second_uv = true;
    return m;
}

const Ray down{{0.25f, 0.5f, 1}, {0, 0, -1}};
Hit hit_of(Index instance = no_index) {
    Hit h;
    h.t = 1;
    h.b1 = 0.25f;
    h.b2 = 0.5f;
    h.shape = 0;
    h.instance = instance;
    return h;
}
void expect_close(Vec3f a, Vec3f b) { EXPECT_LT(length(a - b), 1e-5f) << a.x << ' ' << a.y << ' ' << a.z; }

TEST(SecondUvs, HaveTangentsOfTheirOwn) {
    const Scene scene = scene_of({});
    const SurfacePoint s = surface_point(SceneView(scene), down, hit_of(), true);
    EXPECT_EQ(s.uv, Point2f(0.25f, 0.5f));
    EXPECT_EQ(s.second_uv, Point2f(2, -0.5f));
    expect_close(s.second_dpdu, {0, 0.25f, 0});
    expect_close(s.second_dpdv, {-0.5f, 0, 0});
    const SurfacePoint turned = surface_point(SceneView(scene), down, hit_of(0), true);
    EXPECT_EQ(turned.second_uv, Point2f(2, -0.5f));
    expect_close(turned.second_dpdu, {-0.25f, 0, 0});
    expect_close(turned.second_dpdv, {0, -0.5f, 0});
}

TEST(SecondUvs, MappingsChooseTheirSet) {
    const TextureContext at{.p = {},
                            .n = {},
                            .uv = {0.25f, 0.5f},
                            .dpdx = {},
                            .dpdy = {},
                            .duvdx = {1, 2},
                            .duvdy = {3, 4},
                            .second_uv = {10, 20},
                            .second_duvdx = {5, 6},
                            .second_duvdy = {7, 8}};
    TextureMapping m = second_set();
    m.su = 2;
    m.dv = 1;
    TextureCoordinates c = m(at);
    EXPECT_EQ(c.st, Point2f(20, 21));
    EXPECT_EQ(c.dstdx, Vec2f(10, 6));
    EXPECT_EQ(c.dstdy, Vec2f(14, 8));
    m.kind = TextureMapping::Kind::affine;
    m.vs = {0, 1, 0};
    m.vt = {1, 0, 0};
    m.du = m.dv = 0;
    c = m(at);
    EXPECT_EQ(c.st, Point2f(20, 10));
    EXPECT_EQ(c.dstdx, Vec2f(6, 5));
    m.second_uv = false;
    EXPECT_EQ(m(at).st, Point2f(0.5f, 0.25f));
}

TEST(SecondUvs, NormalMapsLeanAlongTheirSet) {
    const auto normal = [](const TextureMapping& mapping) {
        const Scene scene = scene_of(mapping);
        const SceneTables tables(scene);
        const SurfacePoint s = surface_point(tables.view(), down, hit_of(), true);
        SampledWavelengths lambda = SampledWavelengths::sample_visible(0.5f);
        return make_bsdf(tables.view(), s, {0, 0, 1}, TextureContext(), lambda).frame.n;
    };
    expect_close(normal({}), normalize(Vec3f(0.6f, 0, 0.8f)));
    expect_close(normal(second_set()), normalize(Vec3f(0, 0.6f, 0.8f)));
}

TEST(SecondUvs, CutOut) {
    Scene scene = scene_of({});
    Image image(2, 1, {"Y"});
    image.set(1, 0, 0, 1);
    scene.images.push_back(image);
    scene.shapes[0].alpha = {0, 0};
    const auto alpha = [&](TextureMapping mapping) {
        mapping.su = 0.4f; // 0.1 of the first set, 0.8 of the second
        scene.float_textures = {ImageTexture{.image = 1, .mapping = mapping, .filter = TextureFilter::point}};
        const SceneTables tables(scene);
        return alpha_at(tables.view(), down, hit_of());
    };
    EXPECT_EQ(alpha({}), 0);
    EXPECT_EQ(alpha(second_set()), 1);
}

TEST(SecondUvs, AreCheckedAndCounted) {
    TriangleMesh m = two_sets();
    EXPECT_NO_THROW(check_geometry(m));
    m.second_uvs.pop_back();
    try {
        check_geometry(m);
        ADD_FAILURE();
    } catch (const Error& e) {
        EXPECT_STREQ(e.what(),
                     "the mesh has 2 second texture coordinates for 3 vertices; expected one per vertex");
    }
    Scene scene;
    scene.meshes = {two_sets()};
    const std::size_t with = memory_use(scene).at(0).bytes;
    scene.meshes[0].second_uvs = std::vector<Point2f>(); // {} would keep its memory
    EXPECT_EQ(with - memory_use(scene).at(0).bytes, 3 * sizeof(Point2f));
}

} // namespace
} // namespace montelux
