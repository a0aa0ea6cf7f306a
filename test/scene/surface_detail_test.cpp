// Normal maps and bumps: the shading normal that they give at a point.
#include "test/scene/bsdf_testing.h"
#include <cmath>
#include <gtest/gtest.h>

#include "montelux/mc/stats/chi_squared.h"
#include "montelux/scene/material/make_bsdf.h"
#include "montelux/scene/scene_tables.h"

namespace montelux {
namespace {

Image one_texel(Vec3f n) {
    Image image(1, 1, {"R", "G", "B"});
    for (int c = 0; c < 3; ++c) image.set(0, 0, c, 0.5f * (n[c] + 1));
    return image;
}

// A rectangle with sides 2 along x and 4 along y in the plane z = 0, uv in [0, 1]^2, front +z; its material
// is the one that the test changes.
struct Sheet {
    Scene scene;
    DiffuseMaterial material;
    std::optional<PrincipledMaterial> coated; // in its place, with its detail
    Ray ray{{0.3f, -0.7f, 2}, {0, 0, -1}};
    bool instance = false;
    Vec3f wo{0, 0, 1};

    Sheet() {
        TriangleMesh mesh;
        mesh.positions = {{-1, -2, 0}, {1, -2, 0}, {1, 2, 0}, {-1, 2, 0}};
        mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
        mesh.indices = {0, 1, 2, 0, 2, 3};
        scene.meshes.push_back(mesh);
        scene.shapes.push_back(Shape{.geometry = MeshIndex{0}, .material = 0});
        scene.world_shapes = {0};
    }
    void place(const Transform& t) {
        instance = true;
        scene.world_shapes.clear();
        scene.objects = {ObjectDefinition{{0}}};
        scene.instances = {Instance{0, t}};
    }
    // Height su u + sv v + s0 above the sheet, as a plane of pixels; `mapping` gives (s, t) = (u, v).
    void add_ramp(float slope_u, float slope_v, TextureMapping mapping = {}) {
        constexpr int size = 64;
        Image ramp(size, size, {"Y"});
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x)
                ramp.set(x, y, 0,
                         (slope_u * (static_cast<float>(x) + 0.5f) +
                          slope_v * (static_cast<float>(size - 1 - y) + 0.5f)) /
                             size);
        scene.images.push_back(ramp);
        ImageTexture t;
        t.image = static_cast<Index>(scene.images.size() - 1);
        t.mapping = mapping;
        t.wrap = TextureWrap::clamp;
        scene.float_textures = {t};
        material.detail.displacement.texture = 0;
    }
    void add_map(Vec3f n) {
        scene.images.push_back(one_texel(n));
        scene.normal_maps = {
            ImageTexture{.image = static_cast<Index>(scene.images.size() - 1), .mapping = {}}};
        material.detail.normal_map.map = 0;
    }

    SurfaceBsdf shade(Vec2f footprint = {0, 0}) {
        scene.materials = {material};
        if (coated) {
            coated->detail = material.detail;
            scene.materials = {*coated};
        }
        const SceneTables tables(scene);
        // Barycentric weights on the first triangle, (0.25, -0.4) in the sheet's plane.
        const Hit hit{.t = 2, .b1 = 0.225f, .b2 = 0.4f, .shape = 0, .instance = instance ? 0 : no_index};
        const SurfacePoint s = surface_point(tables.view(), ray, hit, true);
        TextureContext context{
            .p = s.p, .n = s.ns, .uv = s.uv, .dpdx = {}, .dpdy = {}, .duvdx = {}, .duvdy = {}};
        context.duvdx = {footprint.x, 0};
        context.duvdy = {0, footprint.y};
        SampledWavelengths lambda = SampledWavelengths::sample_visible(0.5f);
        EXPECT_TRUE(tables.view().is_textured(0));
        return make_bsdf(tables.view(), s, wo, context, lambda);
    }
};

bool is_tilted(const SurfaceBsdf& b) { return std::holds_alternative<TiltedBsdf>(b.bsdf); }

void expect_near(Vec3f a, Vec3f b, float tolerance = 1e-5f) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], tolerance) << i;
}

TEST(NormalMap, IsInTheFrameOfTheTangents) {
    Sheet sheet;
    const Vec3f n = normalize(Vec3f{0.3f, -0.2f, 0.9f});
    sheet.add_map(n * 0.7f); // the length does not count
    const SurfaceBsdf b = sheet.shade();
    EXPECT_TRUE(is_tilted(b));
    expect_near(b.frame.n, n);
    expect_near(cross(b.frame.s, b.frame.t), n);
}

TEST(NormalMap, RightHandedOneDoesNotFollowTheSecondCoordinate) {
    const Vec3f n = normalize(Vec3f{0.3f, -0.2f, 0.9f});
    for (const bool right_handed : {false, true}) {
        Sheet sheet;
        for (Point2f& uv : sheet.scene.meshes[0].uvs) uv.y = 1 - uv.y;
        sheet.add_map(n);
        sheet.scene.normal_maps[0].right_handed = right_handed;
        expect_near(sheet.shade().frame.n, right_handed ? n : Vec3f{n.x, -n.y, n.z});
    }
}

// A smooth coat mirrors at the sheet over the dents of its base, or at the normals of its own map.
TEST(NormalMap, CoatsHaveTheirOwn) {
    const Vec3f dent = normalize(Vec3f{0.3f, -0.2f, 0.9f}), own = normalize(Vec3f{-0.2f, 0.1f, 0.9f});
    for (const auto& [dented, mapped] : {std::pair(true, false), {false, true}, {true, true}}) {
        Sheet sheet;
        sheet.add_map(dent);
        if (!dented) sheet.material.detail.normal_map = {};
        sheet.coated = PrincipledMaterial{.base_color = {0.5f}, .specular = {0}, .clearcoat = {1}};
        if (mapped) {
            sheet.scene.images.push_back(one_texel(own));
            sheet.scene.normal_maps.push_back(ImageTexture{.image = 1, .mapping = {}});
            sheet.coated->clearcoat_normal_map.map = 1;
        }
        sheet.wo = normalize(Vec3f{0.4f, 0.3f, 1});
        const SurfaceBsdf b = sheet.shade();
        EXPECT_EQ(is_tilted(b), dented);
        expect_near(b.frame.n, dented ? dent : Vec3f{0, 0, 1});
        const Vec3f n = mapped ? own : Vec3f{0, 0, 1}, mirrored = n * (2 * dot(n, sheet.wo)) - sheet.wo;
        testing::TestStream stream(3);
        int found = 0;
        for (int i = 0; i < 2000; ++i) {
            const auto s = testing::sample(b.bsdf, b.frame.to_local(sheet.wo), stream);
            if (!s || !s->specular) continue;
            ++found;
            expect_near(b.frame.to_world(s->wi), mirrored, 1e-4f);
        }
        EXPECT_GT(found, 20);
    }
}

// The normal of the sheet is the one that sides and angles refer to.
TEST(NormalMap, ShadowedOneFadesTowardsTheTerminator) {
    Sheet plain, shadowed;
    const Vec3f n = normalize(Vec3f{0.6f, 0, 0.8f});
    plain.add_map(n);
    shadowed.add_map(n);
    shadowed.material.detail.shadowed = true;
    const SurfaceBsdf a = plain.shade(), b = shadowed.shade();
    testing::TestStream stream(1);
    const float alpha2 = 0.125f * (0.6f * 0.6f / (0.8f * 0.8f));
    for (const float tan_theta : {0.0f, 1.0f, 10.0f}) {
        const Vec3f wi = normalize(Vec3f{0.5f * tan_theta, std::sqrt(0.75f) * tan_theta, 1});
        const auto value = [&](const SurfaceBsdf& s) {
            return evaluate(s.bsdf, s.frame.to_local({0, 0, 1}), s.frame.to_local(wi), stream).f[0];
        };
        EXPECT_NEAR(value(b) / value(a), 2 / (1 + std::sqrt(1 + alpha2 * tan_theta * tan_theta)), 1e-5);
    }
    // The weight of a sample is its value by its density.
    for (int i = 0; i < 100; ++i) {
        const Vec3f wo = b.frame.to_local({0, 0, 1});
        const auto s = sample(b.bsdf, wo, stream);
        if (!s) continue;
        EXPECT_NEAR(s->weight[0] * s->pdf, evaluate(b.bsdf, wo, s->wi, stream).f[0], 1e-5);
    }
}

// Light comes from the sampled direction in paths from the camera, from the other one in paths from lights.
TEST(NormalMap, ShadowIsThatOfTheDirectionOfTheLight) {
    const Normal3f up = normalize(Normal3f{0.3f, 0, 1});
    const float alpha2 = 0.4f;
    const DiffuseBsdf paint{SampledSpectrum(0.5f)};
    const TiltedBsdf plain{paint, up}, shadowed{paint, up, alpha2};
    const Vec3f wo = normalize(Vec3f{0.9f, 0.4f, 0.5f});
    for (const TransportMode mode : {TransportMode::radiance, TransportMode::importance}) {
        testing::TestStream one(2), other(2);
        int found = 0;
        for (int i = 0; i < 100; ++i) {
            const auto a = plain.sample(wo, mode, one), b = shadowed.sample(wo, mode, other);
            ASSERT_EQ(a.has_value(), b.has_value());
            if (!a) continue;
            ++found;
            const float cosine = dot(up, mode == TransportMode::radiance ? a->wi : wo);
            const float share = 2 / (1 + std::sqrt(1 + alpha2 * (1 / (cosine * cosine) - 1)));
            EXPECT_NEAR(b->weight[0] / a->weight[0], share, 1e-5);
            EXPECT_NEAR(shadowed.evaluate(wo, a->wi, mode, other).f[0] /
                            plain.evaluate(wo, a->wi, mode, one).f[0],
                        share, 1e-5);
        }
        EXPECT_GT(found, 50);
    }
}

TEST(NormalMap, ShadowedOneIsMirroredWhereItFacesAway) {
    Sheet sheet;
    const Vec3f n = normalize(Vec3f{-0.8f, 0.1f, 0.3f});
    sheet.add_map(n);
    sheet.material.detail.shadowed = true;
    sheet.wo = normalize(Vec3f{0.9f, 0, 0.1f});
    expect_near(sheet.shade().frame.n, {-n.x, -n.y, n.z});
    sheet.wo = {0, 0, 1};
    expect_near(sheet.shade().frame.n, n);
}

TEST(NormalMap, FlatOneLeavesTheFrame) {
    Sheet sheet, plain;
    sheet.add_map({0, 0, 1});
    plain.add_ramp(0, 0);
    for (Sheet* s : {&sheet, &plain}) {
        const SurfaceBsdf b = s->shade();
        EXPECT_FALSE(is_tilted(b));
        const Frame expected = Frame::from_normal({0, 0, 1});
        EXPECT_TRUE(b.frame.s == expected.s && b.frame.t == expected.t && b.frame.n == expected.n);
    }
}

// Height a u + b v over a sheet of 2 by 4 rises by a / 2 and b / 4 a unit of length.
TEST(Bumps, RampTiltsTheNormalByItsSlope) {
    TextureMapping planar;
    planar.kind = TextureMapping::Kind::planar;
    planar.vs = {0.5f, 0, 0};
    planar.vt = {0, 0.25f, 0};
    planar.du = planar.dv = 0.5f;
    for (const TextureMapping& mapping : {TextureMapping{}, planar})
        for (float footprint : {0.0f, 0.01f, 0.1f}) {
            Sheet sheet;
            sheet.add_ramp(0.8f, -0.6f, mapping);
            const SurfaceBsdf b = sheet.shade({footprint, footprint});
            EXPECT_TRUE(is_tilted(b));
            // Floats lose digits where the difference is over a small step.
            expect_near(b.frame.n, normalize(Vec3f{-0.4f, 0.15f, 1}), footprint == 0 ? 2e-3f : 2e-4f);
            EXPECT_NEAR(dot(b.frame.s, b.frame.n), 0, 1e-6);
        }
}

// The map lies on the surface with its bumps.
TEST(Bumps, CarryTheNormalMap) {
    Sheet sheet;
    sheet.add_ramp(0.8f, 0);
    sheet.add_map(normalize(Vec3f{0.4f, 0, 1})); // undoes the slope
    expect_near(sheet.shade({0.01f, 0.01f}).frame.n, {0, 0, 1}, 2e-4f);
}

// What a mirror shows of a surface with dents has mirrored dents, whichever side is its front.
TEST(SurfaceDetail, MirroredInstancesAreMirrorImages) {
    const Transform mirror = Transform::scale({-1, 1, 1});
    for (bool map : {true, false})
        for (bool flip : {false, true}) {
            Sheet sheet, mirrored;
            for (Sheet* s : {&sheet, &mirrored}) {
                s->scene.shapes[0].flip_normal = flip;
                s->wo = {0, 0, flip ? -1.0f : 1.0f};
                if (map)
                    s->add_map(normalize(Vec3f{0.3f, -0.2f, 0.9f}));
                else
                    s->add_ramp(0.8f, -0.6f);
            }
            mirrored.place(mirror);
            mirrored.ray.o.x = -mirrored.ray.o.x;
            const Vec3f n = sheet.shade({0.01f, 0.01f}).frame.n;
            const Vec3f m = mirrored.shade({0.01f, 0.01f}).frame.n;
            EXPECT_EQ(n.z < 0, flip);
            expect_near(m, {-n.x, n.y, n.z}, 1e-4f);
        }
}

// Any map and any direction to the viewer: the normal stays on the front, and its mirror direction above the
// surface.
TEST(SurfaceDetail, NormalsMirrorAboveTheSurface) {
    TestUniforms uniforms(3);
    int turned = 0;
    for (int i = 0; i < 300; ++i) {
        auto any = [&] {
            const float z = 2 * uniforms.next_float() - 1, phi = two_pi_f * uniforms.next_float();
            const float r = std::sqrt(1 - z * z);
            return Vec3f{r * std::cos(phi), r * std::sin(phi), z};
        };
        Sheet sheet;
        const Vec3f given = any();
        sheet.add_map(given);
        sheet.wo = any();
        const SurfaceBsdf b = sheet.shade();
        const float side = sheet.wo.z < 0 ? -1 : 1;
        const Vec3f n = b.frame.n, mirrored = n * (2 * dot(n, sheet.wo)) - sheet.wo;
        EXPECT_GT(n.z, 0);
        EXPECT_GT(dot(n, sheet.wo) * side, 0);
        EXPECT_GT(mirrored.z * side, 0);
        EXPECT_NEAR(length(n), 1, 1e-5);
        turned += dot(n, normalize(given)) < 0.9999f ? 1 : 0;
    }
    EXPECT_GT(turned, 30);
    EXPECT_LT(turned, 270);
}

// Directions above the tilted normal's plane but below the surface get nothing, nor the other way round.
TEST(SurfaceDetail, NothingPassesToTheOtherSide) {
    const Frame frame = Frame::from_normal(normalize(Vec3f{1, 0, 1}));
    const TiltedBsdf b{DiffuseTransmissionBsdf{SampledSpectrum(0.5f), SampledSpectrum(0.5f)},
                       frame.to_local({0, 0, 1})};
    auto value = [&](Vec3f wi) {
        PhiloxStream stream(1);
        const Vec3f wo = frame.to_local(normalize(Vec3f{0.5f, 0.2f, 1}));
        return b.evaluate(wo, frame.to_local(normalize(wi)), TransportMode::radiance, stream).f[0];
    };
    EXPECT_GT(value({0, 0, 1}), 0);
    EXPECT_GT(value({0, 0, -1}), 0);
    EXPECT_EQ(value({1, 0, -0.5f}), 0);
    EXPECT_EQ(value({-1, 0, 0.5f}), 0);
}

} // namespace
} // namespace montelux
