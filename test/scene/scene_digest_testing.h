// A scene with a value of every kind, and changes of it that its digest must see.
#pragma once

#include "test/scene/light_testing.h"
#include "test/scene/measured_brdf_testing.h"
#include <array>
#include <functional>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "montelux/scene/scene_digest.h"

namespace montelux::testing {

// A scene with one of every kind of value.
inline Scene scene_of_all_kinds() {
    Scene s;
    s.meshes.push_back({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                        {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}},
                        {{0, 0}, {1, 0}, {0, 1}},
                        {0, 1, 2}});
    s.quadrics = {Sphere{}, Disk{}, Cylinder{}};
    s.curves.push_back({.control_points = {{}}, .widths = {{1, 1}}, .normals = {}});
    s.bilinear_meshes.push_back(
        {.positions = {{}, {}, {}, {}}, .normals = {}, .uvs = {}, .indices = {0, 1, 2, 3}});
    s.shapes.resize(3);
    s.shapes[0].geometry = MeshIndex{0};
    s.shapes[1].geometry = QuadricIndex{0};
    s.shapes[2].geometry = QuadricIndex{1};
    s.world_shapes = {0, 1};
    s.objects = {{{2}}};
    s.instances = {{0, Transform::translate({1, 2, 3})}};
    const SpectrumParameter gray{0.5f};
    s.materials = {DiffuseMaterial{gray},
                   ConductorMaterial{{gray, gray, gray, false}},
                   DielectricMaterial{1.5f, {}},
                   ThinDielectricMaterial{1.5f},
                   CoatedDiffuseMaterial{gray, {}},
                   CoatedConductorMaterial{{gray, gray, gray, true}},
                   DiffuseTransmissionMaterial{gray, gray},
                   InterfaceMaterial{}};
    s.normal_maps = {ImageTexture{.image = 0, .mapping = {}}};
    s.float_textures = {ConstantTexture<FloatParameter>{{1}}, ScaleTexture<FloatParameter>{{1}, {2}},
                        NoiseTexture{}, VertexColorTexture{}, StepTexture{{1}, 0.5f}};
    s.spectrum_textures = {ImageTexture{.image = 0, .mapping = {}},
                           MixTexture<SpectrumParameter>{gray, gray, {0.5f}},
                           CheckerboardTexture<SpectrumParameter>{2, {}, {gray, gray}},
                           BilerpTexture<SpectrumParameter>{{}, {gray, gray, gray, gray}},
                           DotsTexture<SpectrumParameter>{{}, gray, gray},
                           DirectionMixTexture<SpectrumParameter>{gray, gray},
                           MarbleTexture{},
                           VertexColorTexture{}};
    s.images.emplace_back(2, 2, std::vector<std::string>{"R", "G", "B"}, PixelFormat::u8,
                          ColorEncoding::srgb());
    s.environments.emplace_back(8, 8, std::vector<std::string>{"R", "G", "B"});
    s.skies.emplace_back();
    const Portal portal(std::array<Point3f, 4>{{{0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}}});
    s.lights = {AreaLight{1.0f, 1, false, 0},
                with_spectrum<PointLight>(1.0f),
                with_spectrum<SpotLight>(1.0f),
                with_spectrum<DistantLight>(1.0f),
                UniformInfiniteLight{1.0f, 1, portal},
                ImageInfiniteLight{.environment = 0, .world_from_light = {}},
                SkyLight{.sky = 0, .environment = 0, .world_from_light = {}},
                with_spectrum<SunLight>(1.0f),
                GoniometricLight{.spectrum = 1.0f, .environment = 0, .world_from_map = {}},
                ProjectionLight{.environment = 0, .world_from_light = {}}};
    s.media = {HomogeneousMedium{}, GridMedium{},       RgbGridMedium{},
               CloudMedium{},       SparseGridMedium{}, FieldMedium{}};
    s.scalar_grids.emplace_back();
    s.color_grids.emplace_back();
    s.sparse_grids.emplace_back();
    s.measured_brdfs.push_back(measured_case(0.5f, 0.5f));
    return s;
}

using Part = ContentDigest SceneDigest::*;
using Change = std::function<void(Scene&)>;

template <typename T>
Change change_spectrum_of_light(const Spectrum& to) {
    return [to](Scene& s) {
        for (Light& l : s.lights)
            if (auto* found = std::get_if<T>(&l)) found->spectrum = add_spectrum(s, to);
    };
}

// Each change alters the digest of its part alone, and no two alter it alike.
inline void expect_changes(Part part, const std::vector<Change>& changes) {
    const Scene scene = scene_of_all_kinds();
    const SceneDigest before = digest_of(scene);
    std::vector<ContentDigest> seen{before.*part}, whole{before.whole()};
    for (std::size_t i = 0; i < changes.size(); ++i) {
        Scene changed = scene;
        changes[i](changed);
        const SceneDigest after = digest_of(changed);
        for (std::size_t k = 0; k < seen.size(); ++k) {
            EXPECT_NE(after.*part, seen[k]) << i << " and " << k;
            EXPECT_NE(after.whole(), whole[k]) << i << " and " << k;
        }
        seen.push_back(after.*part);
        whole.push_back(after.whole());
        SceneDigest rest = after;
        rest.*part = before.*part;
        EXPECT_EQ(rest, before) << i;
    }
}

} // namespace montelux::testing
