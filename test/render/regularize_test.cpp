// Regularization: lobes are widened after the first event that is not specular, and nowhere else.
#include "test/render/scene_testing.h"
#include <gtest/gtest.h>

#include "montelux/scene/material/make_bsdf.h"
#include "montelux/scene/scene_tables.h"

namespace montelux::testing {
namespace {

RoughnessParameter alphas(float u, float v) { return {FloatParameter{u}, FloatParameter{v}, false}; }

CoatingParameters coat(RoughnessParameter roughness) { return CoatingParameters{.roughness = roughness}; }

Material material_of(int kind, RoughnessParameter r) {
    switch (kind) {
    case 0:
        return ConductorMaterial{.metal = {}, .roughness = r};
    case 1:
        return DielectricMaterial{.roughness = r};
    case 2:
        return CoatedConductorMaterial{{}, r, coat(r)};
    default:
        return CoatedDiffuseMaterial{.coating = coat(r)};
    }
}

// A matt floor below a ceiling; the camera sees the floor, or the ceiling alone.
SceneDescription room(const Material& ceiling, bool regularize, bool sees_ceiling, bool with_media) {
    SceneBuilder b;
    b.scene.lights.clear();
    b.add_uniform_light(1);
    b.add_mesh(square(Transform::scale({0.5, 0.5, 1})), b.add(DiffuseMaterial{gray(0.7f)}));
    b.add_mesh(square(Transform::translate({0, 0, 1}) * Transform::rotate(180, {1, 0, 0})), b.add(ceiling));
    b.look({0, 0, 0.5}, {0, 0, sees_ceiling ? 1.0 : 0.0}, 60);
    if (with_media) b.scene.media.push_back(HomogeneousMedium{}); // in no shape
    b.description.integrator.regularize = regularize;
    return b.description;
}

bool same_pictures(const SceneDescription& a, const SceneDescription& b) {
    const Film x = render(a), y = render(b);
    for (std::size_t i = 0; i < x.pixels().size(); ++i)
        if (!same_pixel(x.pixels()[i], y.pixels()[i])) return false;
    return true;
}

TEST(Regularization, WidensIndirectLobesAlone) {
    const std::pair<RoughnessParameter, RoughnessParameter> pairs[] = {
        {alphas(0, 0), alphas(0.1f, 0.1f)},
        {alphas(0.08f, 0.12f), alphas(0.16f, 0.24f)},
        {alphas(0.2f, 0.2f), alphas(0.3f, 0.3f)},
        {alphas(0.35f, 0.4f), alphas(0.35f, 0.4f)}};
    for (const bool with_media : {false, true})
        for (int kind = 0; kind < 4; ++kind)
            for (const auto& [given, widened] : pairs) {
                // The closed form of isotropic coats is a method of its own: its noise differs from the walk's.
                if (kind == 3 && given.u.value != 0.35f && given.u.value != 0.08f) continue;
                const std::string what = std::to_string(kind) + ' ' + std::to_string(given.u.value);
                EXPECT_TRUE(same_pictures(room(material_of(kind, given), true, false, with_media),
                                          room(material_of(kind, widened), false, false, with_media)))
                    << what;
                if (given.u.value < 0.3f) {
                    EXPECT_FALSE(same_pictures(room(material_of(kind, given), true, false, with_media),
                                               room(material_of(kind, given), false, false, with_media)))
                        << what;
                }
            }
    // Seen by the camera, with a depth of 1, nothing changes.
    for (int kind = 0; kind < 4; ++kind) {
        SceneDescription on = room(material_of(kind, alphas(0.05f, 0.07f)), true, true, false), off = on;
        on.integrator.max_depth = off.integrator.max_depth = 1;
        off.integrator.regularize = false;
        EXPECT_TRUE(same_pictures(on, off)) << kind;
    }
}

// A mirror shows what the camera would see from elsewhere: nothing behind it is widened.
TEST(Regularization, MirrorsDoNotCount) {
    for (const bool with_media : {false, true})
        for (int kind = 0; kind < 4; ++kind) {
            const auto mirrored = [&](bool regularize) {
                SceneDescription d =
                    room(material_of(kind, alphas(0.05f, 0.07f)), regularize, false, with_media);
                d.scene.materials[0] = ConductorMaterial{.metal = {}, .roughness = alphas(0, 0)};
                d.integrator.max_depth = 2;
                return d;
            };
            EXPECT_TRUE(same_pictures(mirrored(true), mirrored(false))) << kind << with_media;
        }
}

// Fog scatters light to a ceiling that the camera does not see.
TEST(Regularization, ScatteringInMediaCounts) {
    const auto foggy = [](RoughnessParameter roughness, bool regularize) {
        SceneBuilder b;
        b.add_mesh(square(Transform::translate({0, 0, 1}) * Transform::rotate(180, {1, 0, 0})),
                   b.add(material_of(0, roughness)));
        b.add_mesh(square(Transform::translate({0, 0, -3})), b.add(DiffuseMaterial{gray(0)}), 5);
        HomogeneousMedium fog;
        fog.sigma_a = {0.1f};
        fog.sigma_s = {0.5f};
        b.scene.media.emplace_back(fog);
        b.scene.camera.medium = 0;
        b.look({0, 0, 0.5}, {0, 0, 0}, 30);
        b.description.integrator.regularize = regularize;
        return b.description;
    };
    const RoughnessParameter given = alphas(0.08f, 0.12f), widened = alphas(0.16f, 0.24f);
    EXPECT_TRUE(same_pictures(foggy(given, true), foggy(widened, false)));
    EXPECT_FALSE(same_pictures(foggy(given, true), foggy(given, false)));
}

// Mixes choose among widened lobes, and so do tilted normals at soft shading terminators.
TEST(Regularization, WidensMixesAndTiltedNormals) {
    const auto mixed = [](float u, float v, bool regularize) {
        SceneDescription d = room(material_of(0, alphas(u, v)), regularize, false, false);
        d.scene.materials.push_back(material_of(0, alphas(v, u)));
        d.scene.materials.push_back(MixMaterial{.materials = {{1}, {2}}, .amount = {0.5f}});
        d.scene.shapes[1].material = 3;
        return d;
    };
    EXPECT_TRUE(same_pictures(mixed(0.08f, 0.12f, true), mixed(0.16f, 0.24f, false)));
    EXPECT_FALSE(same_pictures(mixed(0.08f, 0.12f, true), mixed(0.08f, 0.12f, false)));

    const auto tilted = [](float u, float v, bool regularize) {
        SceneDescription d = room(material_of(0, alphas(u, v)), regularize, false, false);
        TriangleMesh& ceiling = d.scene.meshes[1];
        for (const Point3f p : ceiling.positions)
            ceiling.normals.push_back(normalize(Vec3f{0.4f * p.x, 0.4f * p.y, -1}));
        Image map(1, 1, {"R", "G", "B"});
        const Vec3f normal = normalize(Vec3f{0.1f, 0.05f, 1});
        for (int c = 0; c < 3; ++c) map.set(0, 0, c, 0.5f * (normal[c] + 1));
        d.scene.images.push_back(map);
        d.scene.normal_maps.push_back({.image = 0, .mapping = {}});
        std::get<ConductorMaterial>(d.scene.materials[1]).detail.normal_map.map = 0;
        d.integrator.shading_terminator = ShadingTerminator::soft;
        return d;
    };
    EXPECT_TRUE(same_pictures(tilted(0.08f, 0.12f, true), tilted(0.16f, 0.24f, false)));
    EXPECT_FALSE(same_pictures(tilted(0.08f, 0.12f, true), tilted(0.08f, 0.12f, false)));
}

// The closed form gives way to the walk: the means agree.
TEST(Regularization, CoatsInClosedForm) {
    SceneDescription on = room(material_of(3, alphas(0.1f, 0.1f)), true, false, false),
                     wide = room(material_of(3, alphas(0.2f, 0.2f)), false, false, false);
    on.sampler.spp = wide.sampler.spp = 1024;
    const PictureMean a = picture_mean(render(on)), b = picture_mean(render(wide));
    EXPECT_NEAR(a.mean, b.mean, 5 * std::hypot(a.standard_error, b.standard_error));
    // The table is that of the narrow coat.
    const SceneTables tables(on.scene);
    SurfacePoint s;
    s.ng = s.ns = {0, 0, 1};
    s.shape = &tables.view().shapes[1];
    const auto bsdf = [&](bool widen) {
        auto lambda = SampledWavelengths::sample_visible(0.5f);
        return make_bsdf(tables.view(), s, {0, 0, 1}, TextureContext(), lambda, widen).bsdf;
    };
    EXPECT_TRUE(std::holds_alternative<CoatedDiffuseBsdf>(bsdf(false)));
    const Bsdf widened = bsdf(true);
    const auto* layers = std::get_if<LayeredBsdf<DiffuseBsdf>>(&widened);
    ASSERT_NE(layers, nullptr);
    EXPECT_EQ(layers->coat.normals.alpha_x, 0.2f);
}

} // namespace
} // namespace montelux::testing
