// Points raised from a coarse mesh to the surface that its normals describe.
#include <gtest/gtest.h>

#include "montelux/scene/shape/shading_terminator.h"

namespace montelux {
namespace {

// A triangle in the plane z = 0.
Scene triangle_with(const std::vector<Vec3f>& normals) {
    Scene s;
    s.meshes.push_back({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, normals, {}, {0, 1, 2}, {}});
    s.materials = {DiffuseMaterial{}};
    s.shapes = {{.geometry = MeshIndex{0}, .material = 0}};
    s.world_shapes = {0};
    s.objects = {{{0}}};
    s.instances = {{.object = 0,
                    .world_from_object = Transform::translate({5, 0, 1}) * Transform::rotate(90, {1, 0, 0}) *
                                         Transform::scale({2, 1, 3})}};
    return s;
}
Hit hit_at(float b1, float b2, Index instance = no_index) {
    Hit h;
    h.b1 = b1;
    h.b2 = b2;
    h.shape = 0;
    h.instance = instance;
    return h;
}
// Of the triangle above, seen from `from`.
std::optional<Point3f> raise(const Scene& scene, const Hit& hit, Vec3f d = {0, 0, -1}) {
    const SceneView view(scene);
    const Ray ray{Vec3f{0.2f, 0.2f, 0} - d, d};
    return raised_position(view, ray, hit, surface_point(view, ray, hit, false));
}

const Vec3f outwards[] = {normalize(Vec3f{-1, -1, 2}), normalize(Vec3f{1, 0, 2}), normalize(Vec3f{0, 1, 2})};
const std::vector<Vec3f> bulging(outwards, outwards + 3);
std::vector<Vec3f> hollow() {
    std::vector<Vec3f> n = bulging;
    for (Vec3f& v : n) v = {-v.x, -v.y, v.z};
    return n;
}

TEST(RaisedPosition, IsTheMeanOfProjectionsOntoTangentPlanes) {
    const float b1 = 0.3f, b2 = 0.25f, b0 = 1 - b1 - b2;
    const Vec3f p{b1, b2, 0}, corners[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const float b[] = {b0, b1, b2};
    Vec3f expected;
    for (int i = 0; i < 3; ++i) {
        const float below = dot(p - corners[i], outwards[i]);
        EXPECT_LT(below, 0);
        expected += b[i] * (p - below * outwards[i]);
    }
    const auto raised = raise(triangle_with(bulging), hit_at(b1, b2));
    ASSERT_TRUE(raised);
    EXPECT_LT(length(*raised - expected), 1e-6f);
    EXPECT_GT(raised->z, 0.1f);
}

TEST(RaisedPosition, StaysAtVerticesAndInHollows) {
    const auto corner = raise(triangle_with(bulging), hit_at(1, 0));
    ASSERT_TRUE(corner);
    EXPECT_LT(length(*corner - Vec3f{1, 0, 0}), 1e-6f);
    const auto dent = raise(triangle_with(hollow()), hit_at(0.3f, 0.25f));
    ASSERT_TRUE(dent);
    EXPECT_EQ(*dent, (Vec3f{0.3f, 0.25f, 0}));
}

// As the mesh is at the ray's time.
TEST(RaisedPosition, FollowsMeshesThatDeform) {
    Scene scene = triangle_with(hollow());
    TriangleMesh& mesh = scene.meshes[0];
    mesh.end_positions = {{0, 0, 1}, {1, 0, 2}, {0, 2, 1}};
    mesh.end_normals = bulging;
    Scene still = triangle_with(hollow());
    constexpr float time = 0.75f;
    for (Index v = 0; v < 3; ++v) {
        still.meshes[0].positions[v] = mesh.position(v, time);
        still.meshes[0].normals[v] = mesh.normal(v, time);
    }
    for (const Index instance : {no_index, Index{0}}) {
        const Hit hit = hit_at(0.3f, 0.25f, instance);
        const Ray ray{{0.2f, 0.2f, 5}, {0, 0, -1}, 1e30f, time};
        const auto raise_in = [&](const Scene& s) {
            const SceneView view(s);
            return raised_position(view, ray, hit, surface_point(view, ray, hit, false));
        };
        const auto a = raise_in(scene), b = raise_in(still);
        EXPECT_EQ(a.has_value(), b.has_value());
        if (!a || !b) continue;
        EXPECT_LT(length(*a - *b), 1e-6f);
    }
    EXPECT_TRUE(raise(still, hit_at(0.3f, 0.25f)));
}

// From behind, bulges are hollows and hollows bulges; normals that point inwards serve as well.
TEST(RaisedPosition, RisesTowardsTheRay) {
    const auto above = raise(triangle_with(bulging), hit_at(0.3f, 0.25f)),
               behind = raise(triangle_with(bulging), hit_at(0.3f, 0.25f), {0, 0, 1});
    ASSERT_TRUE(above && behind);
    EXPECT_EQ(*behind, (Vec3f{0.3f, 0.25f, 0}));
    std::vector<Vec3f> inwards = bulging;
    for (Vec3f& n : inwards) n = -n;
    const auto turned = raise(triangle_with(inwards), hit_at(0.3f, 0.25f));
    ASSERT_TRUE(turned);
    EXPECT_EQ(*turned, *above);
}

TEST(RaisedPosition, NeedsNormalsThatDifferAndARayFromOneSideOfBoth) {
    EXPECT_FALSE(raise(triangle_with({}), hit_at(0.3f, 0.25f)));
    const Vec3f up{0, 0, 1};
    EXPECT_FALSE(raise(triangle_with({up, up, up}), hit_at(0.3f, 0.25f)));
    // Above the facet, but below the plane of the shading normal near the second vertex.
    EXPECT_FALSE(raise(triangle_with(bulging), hit_at(0.9f, 0.05f), normalize(Vec3f{1, 0, -0.1f})));
}

// In the world: an instance equals a mesh whose vertices and normals are transformed.
TEST(RaisedPosition, FollowsInstances) {
    const Scene scene = triangle_with(bulging);
    const Transform& t = scene.instances[0].world_from_object;
    Scene world = scene;
    for (Vec3f& p : world.meshes[0].positions) p = t.point(p);
    for (Vec3f& n : world.meshes[0].normals) n = normalize(t.normal(n));
    const Vec3f inwards = -normalize(t.normal(Vec3f{0, 0, 1}));
    const auto a = raise(scene, hit_at(0.3f, 0.25f, 0), inwards),
               b = raise(world, hit_at(0.3f, 0.25f), inwards);
    ASSERT_TRUE(a && b);
    EXPECT_LT(length(*a - *b), 1e-5f);
    EXPECT_GT(length(*a - t.point(Vec3f{0.3f, 0.25f, 0})), 0.01f);
}

// Where they are at the ray's time.
TEST(RaisedPosition, FollowsInstancesThatMove) {
    Scene moving = triangle_with(bulging);
    moving.instances[0].motion = 0;
    moving.motions.emplace_back(moving.instances[0].world_from_object,
                                Transform::translate({1, 3, 0}) * moving.instances[0].world_from_object *
                                    Transform::rotate(40, {1, 2, 0}));
    Scene still = triangle_with(bulging);
    constexpr float time = 0.625f;
    still.instances[0].world_from_object = moving.motions[0].at(time);
    const Hit hit = hit_at(0.3f, 0.25f, 0);
    const auto raised_in = [&](const Scene& s) {
        const SceneView view(s);
        const Vec3f n = still.instances[0].world_from_object.normal(Normal3f{0, 0, 1});
        const Ray ray{Vec3f{}, -normalize(n), 1e30f, time};
        return raised_position(view, ray, hit, surface_point(view, ray, hit, false));
    };
    const auto a = raised_in(moving), b = raised_in(still);
    ASSERT_TRUE(a && b);
    EXPECT_LT(length(*a - *b), 1e-6f);
}

} // namespace
} // namespace montelux
