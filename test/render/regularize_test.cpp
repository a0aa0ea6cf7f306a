// Regularization: lobes are widened after the first event that is not specular, and nowhere else.
#include "test/render/scene_testing.h"
#include <gtest/gtest.h>

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

// The closed form gives way to the walk: the means agree.
TEST(Regularization, CoatsInClosedForm) {
    SceneDescription on = room(material_of(3, alphas(0.1f, 0.1f)), true, false, false),
                     wide = room(material_of(3, alphas(0.2f, 0.2f)), false, false, false);
    on.sampler.spp = wide.sampler.spp = 1024;
    const PictureMean a = picture_mean(render(on)), b = picture_mean(render(wide));
    EXPECT_NEAR(a.mean, b.mean, 5 * std::hypot(a.standard_error, b.standard_error));
}

} // namespace
} // namespace montelux::testing
