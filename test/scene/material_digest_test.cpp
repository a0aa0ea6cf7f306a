// Digests of materials: every parameter of every kind counts.
#include "test/scene/scene_digest_testing.h"
#include <gtest/gtest.h>

#include "montelux/scene/material/material_model.h"
#include "montelux/scene/scene_digest.h"

namespace montelux {
namespace {

using testing::expect_changes;

TEST(SceneDigest, MaterialsCount) {
    auto at = []<typename T>(Scene& s, std::type_identity<T>) -> T& {
        for (Material& m : s.materials)
            if (auto* found = std::get_if<T>(&m)) return *found;
        throw std::bad_variant_access();
    };
    using Conductor = std::type_identity<ConductorMaterial>;
    using Coated = std::type_identity<CoatedDiffuseMaterial>;
    using CoatedMetal = std::type_identity<CoatedConductorMaterial>;
    expect_changes(&SceneDigest::materials,
                   {[=](Scene& s) { at(s, std::type_identity<DiffuseMaterial>()).reflectance.value = 0.1f; },
                    [=](Scene& s) { at(s, std::type_identity<DiffuseMaterial>()).reflectance.value = 0.9f; },
                    [=](Scene& s) { at(s, std::type_identity<DiffuseMaterial>()).reflectance.texture = 0; },
                    [=](Scene& s) { at(s, Conductor()).metal.k.value = 0.1f; },
                    [=](Scene& s) { at(s, Conductor()).metal.from_reflectance = true; },
                    [=](Scene& s) { at(s, Conductor()).roughness.u.value = 0.1f; },
                    [=](Scene& s) { at(s, Conductor()).roughness.v.value = 0.1f; },
                    [=](Scene& s) { at(s, Conductor()).roughness.remap = false; },
                    [=](Scene& s) { at(s, std::type_identity<DielectricMaterial>()).eta = 1.6f; },
                    [=](Scene& s) { at(s, std::type_identity<ThinDielectricMaterial>()).eta = 1.6f; },
                    [=](Scene& s) { at(s, Coated()).coating.thickness.value = 1; },
                    [=](Scene& s) { at(s, Coated()).coating.albedo.value = 1; },
                    [=](Scene& s) { at(s, Coated()).coating.g.value = 0.5f; },
                    [=](Scene& s) { at(s, Coated()).coating.max_depth = 3; },
                    [=](Scene& s) { at(s, Coated()).coating.sample_count = 3; },
                    [=](Scene& s) { at(s, CoatedMetal()).metal.eta.texture = 1; },
                    [=](Scene& s) { at(s, CoatedMetal()).coating.eta = 1.1f; },
                    [](Scene& s) { s.measured_brdfs.pop_back(); },
                    [](Scene& s) { s.measured_brdfs[0] = testing::measured_case(0.3f, 0.6f); },
                    [](Scene& s) { std::swap(s.materials[0], s.materials[1]); },
                    [](Scene& s) { s.materials.pop_back(); }});
}

// Changes a simple field of a material.
struct ChangeField {
    void operator()(SceneSpectrum& x) const { x = 0.123f; }
    void operator()(SpectrumParameter& x) const { x.texture = 7; }
    void operator()(FloatParameter& x) const { x.texture = 7; }
    void operator()(NormalMapParameter& x) const { x.map = 7; }
    void operator()(MeasuredBrdfIndex& x) const { x.index = 7; }
    void operator()(MediumIndex& x) const { x.index = 7; }
    void operator()(MaterialIndex& x) const { x.index = 7; }
    void operator()(MaterialOfSide& x) const { x.index = 7; }
    void operator()(MicrofacetDistribution& x) const { x = MicrofacetDistribution::beckmann; }
    void operator()(float& x) const { x += 1; }
    void operator()(int& x) const { x += 1; }
    void operator()(bool& x) const { x = !x; }
};

// Checkpoints made before these materials had distributions and factors are valid.
TEST(SceneDigest, AddedParametersWithoutEffectDoNotCount) {
    Scene scene;
    scene.materials = {ConductorMaterial{}, DielectricMaterial{}, ThinDielectricMaterial{}};
    const ContentDigest before{0xdc1d1c2e34220fc0, 0x0fefd8d6d1e4d46e};
    EXPECT_EQ(digest_of(scene).materials, before);
    std::get<ConductorMaterial>(scene.materials[0]).specular_reflectance = {0.5f};
    EXPECT_NE(digest_of(scene).materials, before);
}

TEST(SceneDigest, EveryParameterOfEveryMaterialCounts) {
    std::size_t changed = 0;
    for_each_material_kind([&]<typename M>(std::type_identity<M>) {
        auto digest = [](const M& m) {
            Scene scene;
            scene.materials = {m};
            return digest_of(scene).materials;
        };
        std::vector<ContentDigest> seen{digest(M{})};
        for (std::size_t n = 0;; ++n) {
            M m;
            std::size_t i = 0;
            visit_parameters(m, [&](const ParameterInfo& info, auto& field) {
                visit_leaves(info.name, field, [&](std::string_view, auto& leaf) {
                    if (i++ == n) ChangeField{}(leaf);
                });
            });
            if (n == i) break;
            for (const ContentDigest& d : seen) EXPECT_NE(digest(m), d) << M::name << ' ' << n;
            seen.push_back(digest(m));
            ++changed;
        }
    });
    EXPECT_GT(changed, 50u);
}

} // namespace
} // namespace montelux
