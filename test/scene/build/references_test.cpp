// SceneBuilder: spectra are shared, and indices that lead nowhere are refused.
#include "test/scene/build/located_error.h"
#include "test/scene/light_testing.h"
#include "test/scene/measured_brdf_testing.h"
#include <functional>
#include <gtest/gtest.h>
#include <string>
#include <utility>
#include <vector>

#include "montelux/scene/build/scene_builder.h"
#include "montelux/scene/material/material_model.h"

namespace montelux {
namespace {

using testing::with_spectrum;

// The error of a scene with two materials, one texture of each kind and one spectrum after the change.
std::string finish_error(const std::function<void(Scene&)>& change) {
    Scene scene;
    scene.spectra = {Spectrum(BlackbodySpectrum(3000))};
    scene.float_textures = {ConstantTexture<FloatParameter>{{1}}};
    scene.spectrum_textures = {ConstantTexture<SpectrumParameter>{{SceneSpectrum::at(0)}}};
    scene.images.emplace_back(1, 1, std::vector<std::string>{"R", "G", "B"});
    scene.normal_maps = {ImageTexture{.image = 0, .mapping = {}}};
    scene.materials = {DiffuseMaterial{{{}, 0}}, DielectricMaterial{SceneSpectrum::at(0)}};
    scene.measured_brdfs = {testing::measured_case(0.5f, 0.5f)};
    change(scene);
    CallMessages messages("test");
    return testing::located_error([&] { SceneBuilder(scene, messages).finish(); });
}

std::string error_of_material(const Material& material) {
    return finish_error([&](Scene& s) { s.materials.push_back(material); });
}
std::string error_of_texture(const FloatTexture& texture) {
    return finish_error([&](Scene& s) { s.float_textures.push_back(texture); });
}
std::string error_of_texture(const SpectrumTexture& texture) {
    return finish_error([&](Scene& s) { s.spectrum_textures.push_back(texture); });
}

const SceneSpectrum no_spectrum = SceneSpectrum::at(1);
const FloatParameter no_float{0, 2};
const SpectrumParameter no_color{{}, 3};

TEST(SceneReferences, WhatIsThereIsTaken) {
    EXPECT_EQ(finish_error([](Scene&) {}), "");
    EXPECT_EQ(error_of_material(DiffuseMaterial{.reflectance = {SceneSpectrum::at(0)},
                                                .detail = {.displacement = {0, 0}, .normal_map = {0}}}),
              "");
    // A texture replaces the value.
    EXPECT_EQ(error_of_material(DiffuseMaterial{.reflectance = {no_spectrum, 0}}), "");
    EXPECT_EQ(error_of_texture(MixTexture<SpectrumParameter>{{{}, 0}, {{}, 0}, {0, 0}}), "");
}

TEST(SceneReferences, MaterialsNameTheParameter) {
    EXPECT_EQ(error_of_material(DielectricMaterial{no_spectrum}),
              "test: material 2 (Dielectric), eta: there is no spectrum 1; the scene has 1");
    EXPECT_EQ(error_of_material(DiffuseMaterial{{no_spectrum}}),
              "test: material 2 (Diffuse), reflectance: there is no spectrum 1; the scene has 1");
    EXPECT_EQ(error_of_material(DiffuseMaterial{no_color}),
              "test: material 2 (Diffuse), reflectance: there is no spectrum texture 3; the scene has 1");
    EXPECT_EQ(error_of_material(ConductorMaterial{.metal = {.k = no_color}}),
              "test: material 2 (Conductor), k: there is no spectrum texture 3; the scene has 1");
    EXPECT_EQ(error_of_material(CoatedConductorMaterial{.coating = {.roughness = {.v = no_float}}}),
              "test: material 2 (CoatedConductor), interface_roughness_v: there is no float texture 2; the "
              "scene has 1");
    EXPECT_EQ(error_of_material(DiffuseMaterial{.detail = {.displacement = no_float}}),
              "test: material 2 (Diffuse), displacement: there is no float texture 2; the scene has 1");
    EXPECT_EQ(error_of_material(DiffuseMaterial{.detail = {.normal_map = {1}}}),
              "test: material 2 (Diffuse), normal_map: there is no normal map 1; the scene has 1");
}

// Every parameter of every material that has an index.
TEST(SceneReferences, NoParameterIsForgotten) {
    struct Break {
        void operator()(SceneSpectrum& s) const { s = no_spectrum; }
        void operator()(SpectrumParameter& p) const { p = no_color; }
        void operator()(FloatParameter& p) const { p = no_float; }
        void operator()(NormalMapParameter& p) const { p.map = 1; }
        void operator()(MeasuredBrdfIndex& p) const { p.index = 1; }
        void operator()(MediumIndex& p) const { p.index = 1; }
        void operator()(MaterialIndex& p) const { p.index = 9; }
        void operator()(MaterialOfSide& p) const { p.index = 9; }
    };
    for_each_material_kind([]<typename M>(std::type_identity<M>) {
        std::size_t i = 0;
        for (std::size_t n = 0; n <= i; ++n) {
            M m;
            if constexpr (std::is_same_v<M, MixMaterial>) m.materials = {{0}, {0}};
            if constexpr (std::is_same_v<M, MeasuredMaterial>) m.brdf = {0};
            i = 0;
            visit_parameters(m, [&](const ParameterInfo& info, auto& field) {
                visit_leaves(info.name, field, [&](std::string_view, auto& leaf) {
                    if constexpr (std::is_invocable_v<Break, decltype(leaf)>)
                        if (i++ == n) Break{}(leaf);
                });
            });
            EXPECT_EQ(error_of_material(m).empty(), n == i) << M::name << ' ' << n;
        }
        EXPECT_GE(i, (std::is_same_v<M, InterfaceMaterial> ? 2u : 3u)) << M::name;
    });
}

TEST(SceneReferences, MixesHaveNoCycles) {
    EXPECT_EQ(error_of_material(MixMaterial{}), "test: material 2 (Mix), first: no material is given");
    EXPECT_EQ(error_of_material(MixMaterial{.materials = {{0}, {3}}}),
              "test: material 2 (Mix), second: there is no material 3; the scene has 3");
    EXPECT_EQ(error_of_material(MixMaterial{.materials = {{0}, {1}}}), "");
    EXPECT_EQ(error_of_material(MixMaterial{.materials = {{0}, {2}}}),
              "test: material 2 (Mix) depends on itself");
    const auto chain = [](Index length) {
        return finish_error([=](Scene& s) {
            const auto first = static_cast<Index>(s.materials.size());
            s.materials.emplace_back(DiffuseMaterial{});
            for (Index i = 0; i < length; ++i)
                s.materials.emplace_back(MixMaterial{.materials = {{first + i}, {first + i}}});
        });
    };
    EXPECT_EQ(chain(63), "");
    EXPECT_NE(chain(64).find("more than 64 levels deep"), std::string::npos) << chain(64);
    EXPECT_NE(chain(100000).find("more than 64 levels deep"), std::string::npos);
}

TEST(SceneReferences, SidesHaveNoCycles) {
    EXPECT_EQ(error_of_material(SidedMaterial{}), "");
    EXPECT_EQ(error_of_material(SidedMaterial{.front = {1}}), "");
    EXPECT_EQ(error_of_material(SidedMaterial{.back = {3}}),
              "test: material 2 (Sided), back: there is no material 3; the scene has 3");
    EXPECT_EQ(error_of_material(SidedMaterial{.front = {2}}), "test: material 2 (Sided) depends on itself");
    // Through a mix.
    EXPECT_EQ(finish_error([](Scene& s) {
                  const auto first = static_cast<Index>(s.materials.size());
                  s.materials.emplace_back(SidedMaterial{.back = {first + 1}});
                  s.materials.emplace_back(MixMaterial{.materials = {{0}, {first}}});
              }),
              "test: material 2 (Sided) depends on itself");
}

TEST(SceneReferences, MediaNameTheParameter) {
    const auto error_of_medium = [](const Medium& medium) {
        return finish_error([&](Scene& s) {
            s.scalar_grids.resize(2);
            s.scalar_grids[0].size = {1, 1, 2};
            s.scalar_grids[0].values = {1, 2};
            s.scalar_grids[1].size = {1, 1, 2};
            s.sparse_grids.resize(2);
            s.sparse_grids[1].nodes = {0};
            s.media.push_back(medium);
        });
    };
    EXPECT_EQ(error_of_medium(HomogeneousMedium{.sigma_a = SceneSpectrum::at(0)}), "");
    EXPECT_EQ(error_of_medium(HomogeneousMedium{.sigma_s = no_spectrum}),
              "test: medium 0 (Homogeneous), sigma_s: there is no spectrum 1; the scene has 1");
    EXPECT_EQ(error_of_medium(HomogeneousMedium{.le = no_spectrum}),
              "test: medium 0 (Homogeneous), le: there is no spectrum 1; the scene has 1");
    GridMedium grid;
    EXPECT_NE(error_of_medium(grid), "");
    grid.density = 0;
    EXPECT_EQ(error_of_medium(grid), "");
    grid.temperature = 2;
    EXPECT_EQ(error_of_medium(grid),
              "test: medium 0 (UniformGrid), temperature: there is no scalar grid 2; the scene has 2");
    grid.temperature = 1;
    EXPECT_EQ(error_of_medium(grid), "test: scalar grid 1 has 0 values; its size wants 2");
    SparseGridMedium sparse;
    EXPECT_NE(error_of_medium(sparse), "");
    sparse.density = 0;
    EXPECT_EQ(error_of_medium(sparse), "");
    sparse.temperature = 2;
    EXPECT_EQ(error_of_medium(sparse),
              "test: medium 0 (SparseGrid), temperature: there is no sparse grid 2; the scene has 2");
    sparse.temperature = 1;
    EXPECT_EQ(error_of_medium(sparse), "test: sparse grid 1 has tables that lead outside it");
    RgbGridMedium colors;
    EXPECT_EQ(error_of_medium(colors), "");
    colors.le = 0;
    EXPECT_EQ(error_of_medium(colors),
              "test: medium 0 (RgbGrid), le: there is no color grid 0; the scene has 0");
    EXPECT_NE(error_of_medium(CloudMedium{.box = {}, .sigma_a = no_spectrum}), "");

    EXPECT_EQ(finish_error([](Scene& s) { s.camera.medium = 0; }),
              "test: the camera, medium: there is no medium 0; the scene has 0");
    for (const MediumInterface media : {MediumInterface{no_index, 3}, MediumInterface{3, no_index}})
        EXPECT_EQ(finish_error([&](Scene& s) {
                      s.meshes.emplace_back();
                      s.shapes.push_back({.geometry = MeshIndex{0}, .material = 0, .media = media});
                  }),
                  "test: shape 0, medium: there is no medium 3; the scene has 0");
}

TEST(SceneReferences, TexturesNameTheirInputs) {
    EXPECT_EQ(error_of_texture(ConstantTexture<FloatParameter>{no_float}),
              "test: float texture 1, value: there is no float texture 2; the scene has 2");
    EXPECT_EQ(error_of_texture(ConstantTexture<SpectrumParameter>{{no_spectrum}}),
              "test: spectrum texture 1, value: there is no spectrum 1; the scene has 1");
    EXPECT_EQ(error_of_texture(ScaleTexture<SpectrumParameter>{no_color, {1}}),
              "test: spectrum texture 1, texture: there is no spectrum texture 3; the scene has 2");
    EXPECT_EQ(error_of_texture(ScaleTexture<SpectrumParameter>{{}, no_float}),
              "test: spectrum texture 1, scale: there is no float texture 2; the scene has 1");
    EXPECT_EQ(error_of_texture(MixTexture<FloatParameter>{no_float, {}, {}}),
              "test: float texture 1, first: there is no float texture 2; the scene has 2");
    EXPECT_EQ(error_of_texture(MixTexture<FloatParameter>{{}, no_float, {}}),
              "test: float texture 1, second: there is no float texture 2; the scene has 2");
    EXPECT_EQ(error_of_texture(MixTexture<SpectrumParameter>{{}, {}, no_float}),
              "test: spectrum texture 1, amount: there is no float texture 2; the scene has 1");
    EXPECT_EQ(error_of_texture(CheckerboardTexture<SpectrumParameter>{2, {}, {{no_color, {}}}}),
              "test: spectrum texture 1, first value: there is no spectrum texture 3; the scene has 2");
    EXPECT_EQ(error_of_texture(CheckerboardTexture<SpectrumParameter>{2, {}, {{{}, no_color}}}),
              "test: spectrum texture 1, second value: there is no spectrum texture 3; the scene has 2");
    const ImageTexture no_image{.image = 1, .mapping = {}};
    EXPECT_EQ(error_of_texture(FloatTexture(no_image)),
              "test: float texture 1, image: there is no image 1; the scene has 1");
    EXPECT_EQ(error_of_texture(SpectrumTexture(no_image)),
              "test: spectrum texture 1, image: there is no image 1; the scene has 1");
    EXPECT_EQ(finish_error([&](Scene& s) { s.normal_maps.push_back(no_image); }),
              "test: normal map 1, image: there is no image 1; the scene has 1");
}

TEST(SceneReferences, NoTextureDependsOnItselfOrOnTooManyLevels) {
    using Floats = std::vector<FloatTexture>;
    using Colors = std::vector<SpectrumTexture>;
    auto error = [](const Floats& floats, const Colors& colors) {
        return finish_error([&](Scene& s) {
            s.float_textures = floats;
            s.spectrum_textures = colors;
        });
    };
    const auto scaled = [](Index texture) { return ScaleTexture<FloatParameter>{{0, texture}, {1}}; };
    const auto color = [](Index texture) { return ConstantTexture<SpectrumParameter>{{{}, texture}}; };
    const ConstantTexture<SpectrumParameter> red{};
    EXPECT_EQ(error({scaled(0)}, {red}), "test: float texture 0 depends on itself");
    EXPECT_EQ(error({scaled(1), scaled(2), scaled(1)}, {red}), "test: float texture 1 depends on itself");
    EXPECT_EQ(error({}, {color(1), color(2), color(1)}), "test: spectrum texture 1 depends on itself");
    EXPECT_EQ(error({ScaleTexture<FloatParameter>{{1}, {0, 0}}}, {red}),
              "test: float texture 0 depends on itself");
    // A texture may be used twice, by later and by earlier ones.
    const ConstantTexture<FloatParameter> one{{1}};
    EXPECT_EQ(error({MixTexture<FloatParameter>{{0, 2}, {0, 1}, {0, 1}}, scaled(2), one}, {color(1), red}),
              "");
    // A spectrum texture has the number of the float texture that it uses.
    EXPECT_EQ(error({one}, {MixTexture<SpectrumParameter>{{}, {}, {0, 0}}}), "");
    const auto chain = [&](Index levels) {
        Floats textures;
        for (Index i = 1; i < levels; ++i) textures.emplace_back(scaled(i));
        textures.emplace_back(one);
        return textures;
    };
    EXPECT_EQ(error(chain(64), {red}), "");
    EXPECT_EQ(error(chain(65), {red}),
              "test: float texture 0: textures refer to one another more than 64 levels deep");
    // Longer than the stack would hold.
    Floats ring = chain(300'000);
    ring.back() = scaled(0);
    EXPECT_EQ(error(ring, {red}), "test: float texture 0 depends on itself");
}

TEST(SceneReferences, LightsAreCheckedWhenAdded) {
    Scene scene;
    scene.spectra = {Spectrum(BlackbodySpectrum(3000))};
    CallMessages messages("test");
    SceneBuilder builder(scene, messages);
    auto error = [&](const Light& light) -> std::string {
        return testing::located_error([&] { builder.add_light(light); });
    };
    EXPECT_EQ(error(with_spectrum<PointLight>(SceneSpectrum::at(0))), "");
    EXPECT_EQ(error(with_spectrum<PointLight>(no_spectrum)),
              "test: light 1 (point light), spectrum: there is no spectrum 1; the scene has 1");
    EXPECT_EQ(error(with_spectrum<SunLight>(no_spectrum)),
              "test: light 1 (sun), spectrum: there is no spectrum 1; the scene has 1");
    PointLight moving = with_spectrum<PointLight>(1.0f);
    moving.motion = 2;
    EXPECT_EQ(error(moving), "test: light 1 (point light), motion: there is no motion 2; the scene has 0");
    EXPECT_EQ(error(AreaLight{1, 1, false, 4}),
              "test: light 1 (area light), shape: there is no shape 4; the scene has 0");
    EXPECT_EQ(error(ImageInfiniteLight{.environment = 0, .world_from_light = {}}),
              "test: light 1 (environment map), environment: there is no environment map 0; the scene has 0");
    scene.environments.emplace_back(2, 2, std::vector<std::string>{"R", "G", "B"});
    EXPECT_EQ(error(SkyLight{.sky = 0, .environment = 0, .world_from_light = {}}),
              "test: light 1 (sky), sky: there is no sky 0; the scene has 0");
    EXPECT_EQ(scene.lights.size(), 1u);
}

TEST(SceneSpectra, EqualOnesShareAnEntry) {
    Scene scene;
    CallMessages messages("test");
    SceneBuilder builder(scene, messages);
    const float lambda[] = {400, 500, 600}, values[] = {1, 2, 3}, others[] = {1, 2, 3.5f};
    const SceneSpectrum a = builder.add_spectrum(Spectrum(PiecewiseLinear(lambda, values)));
    const SceneSpectrum b = builder.add_spectrum(Spectrum(PiecewiseLinear(lambda, others)));
    const SceneSpectrum again = builder.add_spectrum(Spectrum(PiecewiseLinear(lambda, values)));
    EXPECT_EQ(scene.spectra.size(), 2u);
    EXPECT_EQ(again.index, a.index);
    EXPECT_NE(b.index, a.index);
    EXPECT_EQ(spectrum_of(a, scene.spectra)(600), 3);
    EXPECT_EQ(spectrum_of(b, scene.spectra)(600), 3.5f);
    // A constant needs no entry.
    const SceneSpectrum two = builder.add_spectrum(Spectrum(2.0f));
    EXPECT_TRUE(two.is_constant());
    EXPECT_EQ(two.constant, 2);
    EXPECT_EQ(scene.spectra.size(), 2u);
}

} // namespace
} // namespace montelux
