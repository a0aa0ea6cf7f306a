// Emissive meshes whose emitting side is not obvious: every strategy finds the same light. Each comparison is
// at 5 standard errors (a false alarm in 1.7 million) plus rounding.
#include "test/render/scene_testing.h"
#include <gtest/gtest.h>
#include <optional>

namespace montelux::testing {
namespace {

constexpr Strategy each_strategy[] = {Strategy::uniform, Strategy::bsdf, Strategy::light, Strategy::mis};

// A floor of albedo 0.6 seen at the origin by one bounce. `emit` adds emitters above it.
template <typename Emit>
SceneBuilder floor_under(const Emit& emit) {
    SceneBuilder b;
    b.add_mesh(square(Transform::scale({100, 100, 1})), b.add(DiffuseMaterial{gray(0.6f)}));
    emit(b);
    b.description.integrator.max_depth = 1;
    b.description.sampler.spp = 1024;
    b.look({0, -0.5, 1}, {0, 0, 0}, 0.05f);
    return b;
}

// The triangle (-2, -2, 2), (-2, 2, 2), (2, 0, 2): its geometric normal points down to the floor.
TriangleMesh facing_down() {
    TriangleMesh m;
    m.positions = {{-2, -2, 2}, {-2, 2, 2}, {2, 0, 2}};
    m.indices = {0, 1, 2};
    return m;
}

TriangleMesh with_normals(TriangleMesh m, std::vector<Normal3f> normals) {
    m.normals = std::move(normals);
    return m;
}

// Adds an emitter of radiance 4 on black.
Index emit(SceneBuilder& b, TriangleMesh mesh, bool flip = false, bool two_sided = false) {
    const Index shape = b.add_mesh(std::move(mesh), b.add(DiffuseMaterial{gray(0)}), 4);
    b.scene.shapes[shape].flip_normal = flip;
    if (two_sided)
        for (Light& light : b.scene.lights) std::get<AreaLight>(light).two_sided = true;
    return shape;
}

// All strategies find the radiance that is expected, or, without one, the same.
double expect_agreement(SceneBuilder& b, const char* what, std::optional<double> truth = {}) {
    std::vector<PictureMean> means;
    for (Strategy s : each_strategy) {
        b.description.integrator.strategy = s;
        means.push_back(picture_mean(render(b.description)));
    }
    const PictureMean& best = means.back();
    for (std::size_t i = 0; i < means.size(); ++i) {
        const double other = truth ? 0 : best.standard_error;
        EXPECT_NEAR(means[i].mean, truth.value_or(best.mean),
                    5 * std::hypot(means[i].standard_error, other) + 2e-4 * best.mean)
            << what << ", strategy " << static_cast<int>(each_strategy[i]);
    }
    return best.mean;
}

double agreed(TriangleMesh mesh, const char* what, bool flip = false, bool two_sided = false) {
    SceneBuilder b = floor_under([&](SceneBuilder& s) { emit(s, std::move(mesh), flip, two_sided); });
    return expect_agreement(b, what);
}

constexpr Normal3f up{0, 0, 1}, down{0, 0, -1};

// The interpolated normal decides at each point which side emits.
TEST(OddEmitters, VertexNormalsOfBothSides) {
    const double whole = agreed(facing_down(), "no vertex normals");
    EXPECT_GT(whole, 0.2);
    EXPECT_NEAR(agreed(with_normals(facing_down(), {down, down, down}), "down"), whole, 0.02 * whole);
    // The faces' orientation is decided by vertex normals where there are some.
    EXPECT_NEAR(agreed(with_normals(facing_down(), {down, down, down}), "down", true), whole, 0.02 * whole);
    EXPECT_EQ(agreed(with_normals(facing_down(), {up, up, up}), "up"), 0);
    const double part = agreed(with_normals(facing_down(), {down, down, up}), "one up");
    EXPECT_GT(part, 0.2 * whole);
    EXPECT_LT(part, 0.95 * whole);
    // The rest of the triangle emits where the normals are reversed.
    const double rest = agreed(with_normals(facing_down(), {up, up, down}), "two up");
    EXPECT_GT(rest, 0.05 * whole);
    EXPECT_NEAR(part + rest, whole, 0.03 * whole);
    EXPECT_NEAR(agreed(with_normals(facing_down(), {down, down, up}), "one up", true), part, 0.03 * whole);
    // Normals that cancel at a vertex and on an edge.
    agreed(with_normals(facing_down(), {down, {0, 0, 0}, up}), "none at a vertex");
    agreed(with_normals(facing_down(), {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}), "zero");
    EXPECT_NEAR(agreed(with_normals(facing_down(), {down, up, up}), "two-sided", false, true), whole,
                0.02 * whole);
}

TEST(OddEmitters, FlippedOrientation) {
    const double whole = agreed(facing_down(), "as it is");
    EXPECT_EQ(agreed(facing_down(), "flipped", true), 0);
    EXPECT_NEAR(agreed(facing_down(), "flipped, two-sided", true, true), whole, 0.02 * whole);
    TriangleMesh turned = facing_down();
    turned.indices = {0, 2, 1};
    EXPECT_EQ(agreed(turned, "turned"), 0);
    EXPECT_NEAR(agreed(turned, "turned, flipped", true), whole, 0.02 * whole);
}

// What a reader makes of a mesh under a transform that swaps handedness: mirrored positions, and the flag.
TEST(OddEmitters, MirroredMeshes) {
    const double part = agreed(with_normals(facing_down(), {down, up, down}), "as it is");
    const Transform mirror = Transform::scale({1, -1, 1});
    TriangleMesh mesh = with_normals(facing_down(), {down, up, down});
    for (Point3f& p : mesh.positions) p = mirror.point(p);
    for (Normal3f& n : mesh.normals) n = mirror.normal(n);
    EXPECT_NEAR(agreed(mesh, "mirrored", true), part, 0.03 * part);
    mesh.normals.clear();
    EXPECT_NEAR(agreed(mesh, "mirrored, no vertex normals", true), agreed(facing_down(), "as it is"),
                0.03 * part);
}

// Triangles without area emit nothing, and leave the others as they are.
TEST(OddEmitters, DegenerateTriangles) {
    const double whole = agreed(facing_down(), "alone");
    TriangleMesh mesh = facing_down();
    mesh.positions.insert(mesh.positions.end(), {{0, 0, 1}, {1, 1, 1.5f}, {2, 2, 2}, {0, 0, 2}});
    mesh.indices = {0, 0, 1, 3, 4, 5, 0, 1, 2, 6, 6, 6, 2, 1, 2};
    EXPECT_NEAR(agreed(mesh, "with degenerate ones"), whole, 0.02 * whole);
    mesh.normals.assign(mesh.positions.size(), down);
    EXPECT_NEAR(agreed(mesh, "with degenerate ones and normals"), whole, 0.02 * whole);
    mesh.indices = {0, 0, 1, 3, 4, 5, 6, 6, 6};
    EXPECT_EQ(agreed(mesh, "degenerate ones alone"), 0);
    EXPECT_EQ(agreed(mesh, "degenerate ones alone, two-sided", false, true), 0);
}

TEST(OddEmitters, WithAlpha) {
    const double part = agreed(with_normals(facing_down(), {down, down, up}), "whole");
    for (bool textured : {false, true}) {
        SceneBuilder b = floor_under([&](SceneBuilder& s) {
            TriangleMesh mesh = with_normals(facing_down(), {down, down, up});
            mesh.uvs = {{0, 0}, {0, 1}, {1, 0.5f}};
            const Index shape = emit(s, std::move(mesh));
            if (!textured) {
                s.scene.shapes[shape].alpha = {0.5f};
                return;
            }
            Image picture(2, 1, {"Y"});
            picture.set(0, 0, 0, 0.75f);
            s.scene.images.push_back(picture);
            ImageTexture t;
            t.image = 0;
            t.filter = TextureFilter::point;
            t.wrap = TextureWrap::clamp;
            s.scene.float_textures.push_back(t);
            s.scene.shapes[shape].alpha = {0, 0};
        });
        const double found = expect_agreement(b, textured ? "textured alpha" : "alpha 0.5");
        if (textured)
            EXPECT_NEAR(found, 0.75 * part, 0.05 * part); // u < 1/2 shines
        else
            EXPECT_NEAR(found, 0.5 * part, 0.03 * part);
    }
}

// Emission inside object definitions does not shine, as in pbrt-v4; nor does it where it is mirrored.
TEST(OddEmitters, Instances) {
    for (const Transform& t : {Transform(), Transform::scale({1, -1, 1}), Transform::scale({1, 1, -1})}) {
        SceneBuilder b = floor_under([&](SceneBuilder& s) {
            const Index shape = emit(s, facing_down());
            s.scene.world_shapes.pop_back();
            s.scene.objects.push_back({{shape}});
            s.scene.instances.push_back({0, Transform::translate({0.5, 0, 1}) * t});
        });
        EXPECT_EQ(expect_agreement(b, "instance"), 0);
    }
    // Beside an emitter in the world the instance of the same object is dark.
    const double whole = agreed(facing_down(), "alone");
    SceneBuilder b = floor_under([&](SceneBuilder& s) {
        emit(s, facing_down());
        const Index shape = emit(s, facing_down());
        s.scene.world_shapes.pop_back();
        s.scene.objects.push_back({{shape}});
        s.scene.instances.push_back({0, Transform::translate({0, 0, 9}) * Transform::scale({1, -1, 1})});
    });
    EXPECT_NEAR(expect_agreement(b, "beside"), whole, 0.02 * whole);
}

} // namespace
} // namespace montelux::testing
