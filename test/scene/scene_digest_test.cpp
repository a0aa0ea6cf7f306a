// Digests of scenes: every value counts, by itself and in its part; addresses and origins do not.
#include "test/scene/light_testing.h"
#include "test/scene/measured_brdf_testing.h"
#include <array>
#include <functional>
#include <gtest/gtest.h>
#include <string>
#include <utility>
#include <vector>

#include "montelux/scene/material/material_model.h"
#include "montelux/scene/scene_digest.h"
#include "montelux/scene/value_hash.h"

namespace montelux {
namespace {

using testing::with_spectrum;

// A scene with one of every kind of value.
Scene scene_of_all_kinds() {
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
                        NoiseTexture{}};
    s.spectrum_textures = {ImageTexture{.image = 0, .mapping = {}},
                           MixTexture<SpectrumParameter>{gray, gray, {0.5f}},
                           CheckerboardTexture<SpectrumParameter>{2, {}, {gray, gray}},
                           BilerpTexture<SpectrumParameter>{{}, {gray, gray, gray, gray}},
                           DotsTexture<SpectrumParameter>{{}, gray, gray},
                           DirectionMixTexture<SpectrumParameter>{gray, gray},
                           MarbleTexture{}};
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
    s.media = {HomogeneousMedium{}, GridMedium{}, RgbGridMedium{}, CloudMedium{}, SparseGridMedium{}};
    s.scalar_grids.emplace_back();
    s.color_grids.emplace_back();
    s.sparse_grids.emplace_back();
    s.measured_brdfs.push_back(testing::measured_case(0.5f, 0.5f));
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
void expect_changes(Part part, const std::vector<Change>& changes) {
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

TEST(SceneDigest, CopiesAreEqual) {
    const Scene scene = scene_of_all_kinds(), again = scene_of_all_kinds(), copy = scene;
    EXPECT_EQ(digest_of(scene), digest_of(copy));
    EXPECT_EQ(digest_of(scene), digest_of(again));
    EXPECT_EQ(digest_of(scene).whole(), digest_of(again).whole());
    EXPECT_NE(digest_of(scene), digest_of(Scene()));
}

TEST(SceneDigest, GeometryCounts) {
    expect_changes(&SceneDigest::geometry,
                   {[](Scene& s) { s.meshes[0].positions[2].z = 1e-30f; },
                    [](Scene& s) { s.meshes[0].normals[1].x = -0.0f; },
                    [](Scene& s) { s.meshes[0].normals.clear(); },
                    [](Scene& s) { s.meshes[0].uvs[0].y = 1; },
                    [](Scene& s) {
                        s.meshes[0].tangents = {{1, 0, 0}, {1, 0, 0}, {1, 0, 0}};
                    },
                    [](Scene& s) { s.meshes[0].end_positions = s.meshes[0].positions; },
                    [](Scene& s) {
                        s.meshes[0].end_positions = s.meshes[0].positions;
                        s.meshes[0].end_positions[1].y = 1e-30f;
                    },
                    [](Scene& s) {
                        s.meshes[0].end_positions = s.meshes[0].positions;
                        s.meshes[0].end_normals = s.meshes[0].normals;
                    },
                    [](Scene& s) { std::swap(s.meshes[0].indices[0], s.meshes[0].indices[1]); },
                    [](Scene& s) { std::get<Sphere>(s.quadrics[0]).z_max = 0.5f; },
                    [](Scene& s) { std::get<Disk>(s.quadrics[1]).inner_radius = 0.5f; },
                    [](Scene& s) {
                        std::get<Disk>(s.quadrics[1]).world_from_object = Transform::scale({1, 1, 2});
                    },
                    [](Scene& s) { std::swap(s.quadrics[0], s.quadrics[1]); },
                    [](Scene& s) { s.shapes[0].material = 3; },
                    [](Scene& s) { s.shapes[0].light = 0; },
                    [](Scene& s) { s.shapes[1].alpha.value = 0.5f; },
                    [](Scene& s) { s.shapes[1].alpha.texture = 0; },
                    [](Scene& s) { s.shapes[2].flip_normal = true; },
                    [](Scene& s) { s.world_shapes.pop_back(); },
                    [](Scene& s) { s.objects[0].shapes.clear(); },
                    [](Scene& s) { s.objects.push_back({}); },
                    [](Scene& s) { s.instances[0].world_from_object = {}; },
                    [](Scene& s) { s.instances.push_back(s.instances[0]); },
                    [](Scene& s) { s.instances[0].motion = 0; },
                    [](Scene& s) {
                        s.motions.emplace_back(Transform(), Transform::translate({1, 0, 0}));
                    },
                    [](Scene& s) {
                        s.motions.emplace_back(Transform(), Transform::translate({2, 0, 0}));
                    }});
}

TEST(SceneDigest, CurvesCount) {
    expect_changes(&SceneDigest::geometry, {[](Scene& s) { s.curves[0].kind = Curves::Kind::cylinder; },
                                            [](Scene& s) { s.curves[0].control_points[0][3].z = 1; },
                                            [](Scene& s) { s.curves[0].widths[0][1] = 2; },
                                            [](Scene& s) { s.curves[0].normals.emplace_back(); },
                                            [](Scene& s) { s.curves.clear(); }});
    expect_changes(&SceneDigest::geometry, {[](Scene& s) { s.bilinear_meshes[0].positions[1].y = 2; },
                                            [](Scene& s) { s.bilinear_meshes[0].normals.emplace_back(); },
                                            [](Scene& s) { s.bilinear_meshes[0].uvs.emplace_back(); },
                                            [](Scene& s) { s.bilinear_meshes[0].indices[0] = 1; },
                                            [](Scene& s) { s.shapes[0].geometry = BilinearMeshIndex{0}; },
                                            [](Scene& s) { s.bilinear_meshes.clear(); }});
}

TEST(SceneDigest, CylindersCount) {
    expect_changes(&SceneDigest::geometry,
                   {[](Scene& s) { std::get<Cylinder>(s.quadrics[2]).radius = 2; },
                    [](Scene& s) { std::get<Cylinder>(s.quadrics[2]).z_min = -2; },
                    [](Scene& s) { std::get<Cylinder>(s.quadrics[2]).z_max = 2; },
                    [](Scene& s) { std::get<Cylinder>(s.quadrics[2]).phi_max = 2; },
                    [](Scene& s) {
                        std::get<Cylinder>(s.quadrics[2]).world_from_object = Transform::scale({1, 1, 2});
                    }});
}

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
    void operator()(float& x) const { x += 1; }
    void operator()(int& x) const { x += 1; }
    void operator()(bool& x) const { x = !x; }
};

TEST(SceneDigest, MediaCount) {
    const auto at = []<typename M>(Scene& s, std::type_identity<M>) -> M& {
        for (Medium& m : s.media)
            if (auto* found = std::get_if<M>(&m)) return *found;
        throw std::bad_variant_access();
    };
    const std::type_identity<HomogeneousMedium> fog;
    const std::type_identity<GridMedium> grid;
    const std::type_identity<RgbGridMedium> rgb;
    const std::type_identity<CloudMedium> cloud;
    const std::type_identity<SparseGridMedium> sparse;
    const Transform moved = Transform::translate({1, 0, 0});
    expect_changes(&SceneDigest::materials,
                   {[=](Scene& s) { at(s, fog).sigma_a = 2; },
                    [=](Scene& s) { at(s, fog).sigma_s = 2; },
                    [=](Scene& s) { at(s, fog).scale = 2; },
                    [=](Scene& s) { at(s, fog).le = 2; },
                    [=](Scene& s) { at(s, fog).le_scale = 2; },
                    [=](Scene& s) { at(s, fog).phase = HenyeyGreenstein{0.5f}; },
                    [=](Scene& s) { at(s, fog).phase = Draine{}; },
                    [=](Scene& s) {
                        at(s, fog).phase = Draine{0, 0.5f};
                    },
                    [=](Scene& s) { at(s, grid).box.p0.x = -1; },
                    [=](Scene& s) { at(s, grid).box.p1.z = 2; },
                    [=](Scene& s) { at(s, grid).box.world_from_medium = moved; },
                    [=](Scene& s) { at(s, grid).density = 0; },
                    [=](Scene& s) { at(s, grid).sigma_a = 2; },
                    [=](Scene& s) { at(s, grid).sigma_s = 2; },
                    [=](Scene& s) { at(s, grid).scale = 2; },
                    [=](Scene& s) { at(s, grid).le = 2; },
                    [=](Scene& s) { at(s, grid).le_scale = 2; },
                    [=](Scene& s) { at(s, grid).le_grid = 0; },
                    [=](Scene& s) { at(s, grid).temperature = 0; },
                    [=](Scene& s) { at(s, grid).temperature_offset = 2; },
                    [=](Scene& s) { at(s, grid).temperature_scale = 2; },
                    [=](Scene& s) { at(s, grid).phase = Draine{}; },
                    [=](Scene& s) { at(s, rgb).box.p0.y = -1; },
                    [=](Scene& s) { at(s, rgb).sigma_a = 0; },
                    [=](Scene& s) { at(s, rgb).sigma_s = 0; },
                    [=](Scene& s) { at(s, rgb).scale = 2; },
                    [=](Scene& s) { at(s, rgb).le = 0; },
                    [=](Scene& s) { at(s, rgb).illuminant = 1; },
                    [=](Scene& s) { at(s, rgb).le_scale = 2; },
                    [=](Scene& s) { at(s, rgb).phase = Draine{}; },
                    [=](Scene& s) { at(s, cloud).box.p0.z = -1; },
                    [=](Scene& s) { at(s, cloud).sigma_a = 2; },
                    [=](Scene& s) { at(s, cloud).sigma_s = 2; },
                    [=](Scene& s) { at(s, cloud).density = 2; },
                    [=](Scene& s) { at(s, cloud).wispiness = 2; },
                    [=](Scene& s) { at(s, cloud).frequency = 2; },
                    [=](Scene& s) { at(s, cloud).phase = Draine{}; },
                    [=](Scene& s) { at(s, sparse).box.p0.y = -1; },
                    [=](Scene& s) { at(s, sparse).density = 0; },
                    [=](Scene& s) { at(s, sparse).sigma_a = 2; },
                    [=](Scene& s) { at(s, sparse).sigma_s = 2; },
                    [=](Scene& s) { at(s, sparse).scale = 2; },
                    [=](Scene& s) { at(s, sparse).temperature = 0; },
                    [=](Scene& s) { at(s, sparse).temperature_space_from_density = moved; },
                    [=](Scene& s) { at(s, sparse).le_scale = 2; },
                    [=](Scene& s) { at(s, sparse).temperature_offset = 2; },
                    [=](Scene& s) { at(s, sparse).temperature_scale = 2; },
                    [=](Scene& s) { at(s, sparse).phase = Draine{}; },
                    [](Scene& s) { s.sparse_grids[0].node_count[0] = 1; },
                    [](Scene& s) { s.sparse_grids[0].nodes = {0}; },
                    [](Scene& s) { s.sparse_grids[0].blocks = {0}; },
                    [](Scene& s) { s.sparse_grids[0].values = {0}; },
                    [](Scene& s) { s.sparse_grids[0].constants[0] = 1; },
                    [](Scene& s) { s.sparse_grids.emplace_back(); },
                    [](Scene& s) { s.media.pop_back(); },
                    [](Scene& s) { s.scalar_grids[0].size[0] = 1; },
                    [](Scene& s) { s.scalar_grids[0].values = {0}; },
                    [](Scene& s) { s.color_grids[0].size[1] = 1; },
                    [](Scene& s) { s.color_grids[0].values.resize(1); },
                    [](Scene& s) { s.color_grids.emplace_back(); },
                    [](Scene& s) { s.camera.medium = 0; },
                    [](Scene& s) { s.shapes[0].media.inside = 0; },
                    [](Scene& s) { s.shapes[0].media.outside = 0; },
                    [](Scene& s) { s.shapes[1].media.inside = 0; }});
}

// Checkpoints of scenes without media stay valid.
TEST(SceneDigest, WithoutMediaTheirPlacesDoNotCount) {
    Scene scene = scene_of_all_kinds();
    scene.media.clear();
    scene.scalar_grids.clear();
    scene.color_grids.clear();
    scene.sparse_grids.clear();
    const SceneDigest before = digest_of(scene);
    scene.shapes[0].media.inside = 0;
    EXPECT_EQ(digest_of(scene), before);
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

TEST(SceneDigest, TexturesCount) {
    auto image = [](Scene& s) -> ImageTexture& { return std::get<ImageTexture>(s.spectrum_textures[0]); };
    expect_changes(&SceneDigest::textures,
                   {[](Scene& s) { s.images[0].u8()[5] = 1; },
                    [](Scene& s) { s.normal_maps[0].wrap = TextureWrap::clamp; },
                    [](Scene& s) { s.images[0].set_encoding(ColorEncoding::linear()); },
                    [](Scene& s) { s.images[0].set_encoding(ColorEncoding::gamma(2)); },
                    [](Scene& s) { s.images[0] = s.images[0].to_linear_f32(); },
                    [](Scene& s) {
                        s.images[0] = Image(4, 1, {"R", "G", "B"}, PixelFormat::u8, ColorEncoding::srgb());
                    },
                    [=](Scene& s) { image(s).filter = TextureFilter::ewa; },
                    [=](Scene& s) { image(s).wrap = TextureWrap::clamp; },
                    [=](Scene& s) { image(s).channels = ImageChannels::alpha; },
                    [=](Scene& s) { image(s).max_anisotropy = 2; },
                    [=](Scene& s) { image(s).scale = 2; },
                    [=](Scene& s) { image(s).invert = true; },
                    [=](Scene& s) { image(s).meaning = RgbMeaning::unbounded; },
                    [=](Scene& s) { image(s).color_space = &RgbColorSpace::rec2020(); },
                    [=](Scene& s) { image(s).mapping.kind = TextureMapping::Kind::planar; },
                    [=](Scene& s) { image(s).mapping.dv = 1; },
                    [=](Scene& s) {
                        image(s).mapping.vt = {1, 1, 1};
                    },
                    [=](Scene& s) {
                        image(s).mapping.texture_from_world = Transform::translate({1, 0, 0});
                    },
                    [](Scene& s) { std::get<0>(s.float_textures[0]).value.value = 3; },
                    [](Scene& s) { std::get<2>(s.float_textures[1]).scale.texture = 0; },
                    [](Scene& s) { std::get<3>(s.spectrum_textures[1]).amount.value = 0; },
                    [](Scene& s) { std::get<4>(s.spectrum_textures[2]).dimension = 3; },
                    [](Scene& s) { std::get<4>(s.spectrum_textures[2]).values[1].value = 0.1f; }});
    const Transform moved = Transform::translate({1, 0, 0});
    auto noise = [](Scene& s) -> NoiseTexture& { return std::get<8>(s.float_textures[2]); };
    auto marble = [](Scene& s) -> MarbleTexture& { return std::get<8>(s.spectrum_textures[6]); };
    expect_changes(&SceneDigest::textures,
                   {[](Scene& s) { std::get<5>(s.spectrum_textures[3]).corners[3].value = 0.1f; },
                    [](Scene& s) { std::get<5>(s.spectrum_textures[3]).mapping.su = 2; },
                    [](Scene& s) { std::get<6>(s.spectrum_textures[4]).outside.value = 0.1f; },
                    [](Scene& s) { std::get<6>(s.spectrum_textures[4]).inside.value = 0.1f; },
                    [](Scene& s) { std::get<6>(s.spectrum_textures[4]).mapping.su = 2; },
                    [](Scene& s) { std::get<7>(s.spectrum_textures[5]).first.value = 0.1f; },
                    [](Scene& s) { std::get<7>(s.spectrum_textures[5]).second.value = 0.1f; },
                    [](Scene& s) {
                        std::get<7>(s.spectrum_textures[5]).direction = {1, 0, 0};
                    },
                    [=](Scene& s) { noise(s).kind = NoiseTexture::Kind::windy; },
                    [=](Scene& s) { noise(s).octaves.octaves = 3; },
                    [=](Scene& s) { noise(s).octaves.roughness = 0.3f; },
                    [=](Scene& s) { noise(s).texture_from_world = moved; },
                    [=](Scene& s) { marble(s).octaves.octaves = 3; },
                    [=](Scene& s) { marble(s).octaves.roughness = 0.3f; },
                    [=](Scene& s) { marble(s).scale = 3; }, [=](Scene& s) { marble(s).variation = 3; },
                    [=](Scene& s) { marble(s).texture_from_world = moved; }});
}

TEST(SceneDigest, LightsCount) {
    const RgbColorSpace& srgb = RgbColorSpace::srgb();
    const Spectrum red(RgbIlluminantSpectrum(srgb, {1, 0, 0}));
    SkySettings dusk;
    dusk.elevation = 3;
    SkySettings snow;
    snow.ground_albedo = Spectrum(0.9f);
    const Transform moved = Transform::translate({1, 0, 0});
    SkySettings haze;
    haze.atmosphere.turbidity = 5;
    expect_changes(&SceneDigest::lights,
                   {change_spectrum_of_light<AreaLight>(red),
                    change_spectrum_of_light<PointLight>(red),
                    change_spectrum_of_light<SpotLight>(red),
                    change_spectrum_of_light<DistantLight>(red),
                    change_spectrum_of_light<UniformInfiniteLight>(red),
                    change_spectrum_of_light<SunLight>(red),
                    [](Scene& s) { std::get<AreaLight>(s.lights[0]).two_sided = true; },
                    [](Scene& s) { std::get<AreaLight>(s.lights[0]).primitive_flux = 1; },
                    [](Scene& s) { std::get<AreaLight>(s.lights[0]).picture = 0; },
                    [](Scene& s) { std::get<PointLight>(s.lights[1]).position.x = 1; },
                    [](Scene& s) { std::get<SpotLight>(s.lights[2]).cos_total_width = 0.5f; },
                    [](Scene& s) {
                        std::get<DistantLight>(s.lights[3]).to_light = {1, 0, 0};
                    },
                    [](Scene& s) { std::get<UniformInfiniteLight>(s.lights[4]).portal.reset(); },
                    [](Scene& s) { std::get<ImageInfiniteLight>(s.lights[5]).scale = 2; },
                    [](Scene& s) {
                        std::get<ImageInfiniteLight>(s.lights[5]).layout = EnvironmentLayout::equirectangular;
                    },
                    [](Scene& s) {
                        std::get<SkyLight>(s.lights[6]).world_from_light = Transform::rotate(9, {0, 0, 1});
                    },
                    [](Scene& s) { std::get<SunLight>(s.lights[7]).disc.versine = 0.5f; },
                    change_spectrum_of_light<GoniometricLight>(red),
                    [](Scene& s) { std::get<GoniometricLight>(s.lights[8]).scale = 2; },
                    [](Scene& s) { std::get<GoniometricLight>(s.lights[8]).environment = 1; },
                    [](Scene& s) {
                        std::get<GoniometricLight>(s.lights[8]).layout = EnvironmentLayout::equirectangular;
                    },
                    [=](Scene& s) { std::get<GoniometricLight>(s.lights[8]).world_from_map = moved; },
                    [](Scene& s) { std::get<ProjectionLight>(s.lights[9]).environment = 1; },
                    [](Scene& s) { std::get<ProjectionLight>(s.lights[9]).scale = 2; },
                    [](Scene& s) { std::get<ProjectionLight>(s.lights[9]).fov = 20; },
                    [=](Scene& s) { std::get<ProjectionLight>(s.lights[9]).world_from_light = moved; },
                    [](Scene& s) { s.environments[0].f32()[100] = 1; },
                    [=](Scene& s) { s.skies[0] = SkyModel(dusk); },
                    [=](Scene& s) { s.skies[0] = SkyModel(snow); },
                    [=](Scene& s) { s.skies[0] = SkyModel(haze); },
                    [](Scene& s) { std::swap(s.lights[1], s.lights[2]); }});
}

TEST(SceneDigest, EveryKindOfSpectrumCounts) {
    const RgbColorSpace &srgb = RgbColorSpace::srgb(), &wide = RgbColorSpace::aces2065_1();
    const float lambda[] = {400, 500, 600}, values[] = {1, 2, 3}, others[] = {1, 2, 3.5f};
    const Spectrum kinds[] = {Spectrum(2.0f),
                              Spectrum(Spectrum(3.0f).tabulate()),
                              Spectrum(Spectrum(3.0f).tabulate(2)),
                              Spectrum(PiecewiseLinear(lambda, values)),
                              Spectrum(PiecewiseLinear(lambda, others)),
                              Spectrum(PiecewiseLinear(lambda, values, SpectrumEnds::constant)),
                              Spectrum(BlackbodySpectrum(3000)),
                              Spectrum(BlackbodySpectrum(4000)),
                              Spectrum(RgbAlbedoSpectrum(srgb, {0.5f, 0.4f, 0.3f})),
                              Spectrum(RgbAlbedoSpectrum(wide, {0.5f, 0.4f, 0.3f})),
                              Spectrum(RgbUnboundedSpectrum(srgb, {0.5f, 0.4f, 0.3f})),
                              Spectrum(RgbUnboundedSpectrum(srgb, {5, 4, 3})),
                              Spectrum(RgbIlluminantSpectrum(srgb, {5, 4, 3})),
                              Spectrum(RgbIlluminantSpectrum(wide, {1, 1, 1})),
                              Spectrum(RgbIlluminantSpectrum(srgb, {1, 1, 1}))};
    std::vector<Change> changes;
    for (const Spectrum& s : kinds) changes.push_back(change_spectrum_of_light<PointLight>(s));
    expect_changes(&SceneDigest::lights, changes);
    // Data in two places with the same values.
    Scene a, b;
    for (Scene* s : {&a, &b})
        s->lights = {with_spectrum<PointLight>(add_spectrum(*s, Spectrum(PiecewiseLinear(lambda, values))))};
    EXPECT_EQ(digest_of(a), digest_of(b));
}

// A material, a texture and a light with one spectrum each.
Scene scene_of_spectra(SceneSpectrum material, SceneSpectrum texture, SceneSpectrum light,
                       std::vector<Spectrum> spectra) {
    Scene s;
    s.spectra = std::move(spectra);
    s.materials = {DielectricMaterial{material}};
    s.spectrum_textures = {ConstantTexture<SpectrumParameter>{{texture}}};
    s.lights = {with_spectrum<PointLight>(light)};
    return s;
}

TEST(SceneDigest, SpectraCountByTheirValues) {
    const auto at = [](Index i) { return SceneSpectrum::at(i); };
    const Spectrum warm(BlackbodySpectrum(3000)), cold(BlackbodySpectrum(9000)), two(2.0f);
    const SceneDigest expected = digest_of(scene_of_spectra(at(0), at(1), 2, {warm, cold}));
    EXPECT_EQ(digest_of(scene_of_spectra(at(1), at(0), 2, {cold, warm})), expected);
    EXPECT_EQ(digest_of(scene_of_spectra(at(3), at(2), at(1), {two, two, cold, warm, cold})), expected);
    EXPECT_NE(digest_of(scene_of_spectra(at(1), at(0), 2, {warm, cold})), expected);
}

TEST(SceneDigest, ASpectrumCountsWhereItIsUsed) {
    const Spectrum other(BlackbodySpectrum(9000));
    const Scene scene = scene_of_spectra(SceneSpectrum::at(0), SceneSpectrum::at(1), SceneSpectrum::at(2),
                                         std::vector<Spectrum>(4, Spectrum(BlackbodySpectrum(3000))));
    const SceneDigest before = digest_of(scene);
    const Part users[] = {&SceneDigest::materials, &SceneDigest::textures, &SceneDigest::lights};
    for (std::size_t i = 0; i < 4; ++i) {
        Scene changed = scene;
        changed.spectra[i] = other;
        SceneDigest after = digest_of(changed);
        if (i < 3) {
            EXPECT_NE(after.*users[i], before.*users[i]) << i;
            after.*users[i] = before.*users[i];
        }
        EXPECT_EQ(after, before) << i;
    }
}

TEST(SceneDigest, TheCameraCounts) {
    expect_changes(
        &SceneDigest::camera,
        {[](Scene& s) {
             s.camera.world_from_camera = Transform::translate({1e-9, 0, 0});
         },
         [](Scene& s) { std::get<PerspectiveCamera>(s.camera.model).fov = 45; },
         [](Scene& s) { std::get<PerspectiveCamera>(s.camera.model).lens_radius = 1; },
         [](Scene& s) { std::get<PerspectiveCamera>(s.camera.model).frame_aspect_ratio = 1; },
         [](Scene& s) { std::get<PerspectiveCamera>(s.camera.model).screen_window = ScreenWindow{}; },
         [](Scene& s) {
             s.camera.motion.emplace(Transform(), Transform::translate({1, 0, 0}));
         },
         [](Scene& s) { s.camera.shutter_open = 0.5f; }, [](Scene& s) { s.camera.shutter_close = 0.5f; },
         [](Scene& s) { s.camera.model = OrthographicCamera{}; },
         [](Scene& s) { s.camera.model = SphericalCamera{}; },
         [](Scene& s) { s.camera.model = SphericalCamera{SphericalCamera::Mapping::equirectangular}; }});
}

TEST(SceneDigest, HeadersOfImagesDoNotCount) {
    Scene scene = scene_of_all_kinds();
    const SceneDigest before = digest_of(scene);
    scene.images[0].attributes()["software"] = std::string("an editor");
    scene.environments[0].attributes()["exposure"] = 2.0f;
    EXPECT_EQ(digest_of(scene), before);
}

TEST(SceneDigest, AMeshIsNotTwoHalves) {
    Scene one, two;
    one.meshes.resize(1);
    one.meshes[0].positions.resize(4000);
    two.meshes.resize(2);
    two.meshes[0].positions.resize(1000);
    two.meshes[1].positions.resize(3000);
    EXPECT_NE(digest_of(one), digest_of(two));
    two.meshes[0].positions.swap(two.meshes[1].positions);
    EXPECT_NE(digest_of(one), digest_of(two));
}

// Pieces are gathered before they are hashed: lengths around the size of the buffer.
TEST(ValueHash, EveryByteCountsAtAnyLength) {
    for (const std::size_t size : {0, 1, 4095, 4096, 4097, 10000}) {
        std::vector<std::uint8_t> bytes(size, 7);
        auto hash = [&](std::size_t first) {
            ValueHash h;
            h.add(1.5f);
            h.add_bytes(bytes.data(), first);
            h.add_bytes(bytes.data() + first, size - first);
            h.add(true);
            return h.value();
        };
        const ContentDigest before = hash(size);
        EXPECT_EQ(hash(size), before);
        for (std::size_t at : {std::size_t{0}, size / 2, size - 1}) {
            if (at >= size) continue;
            bytes[at] ^= 1;
            EXPECT_NE(hash(size), before) << size << ' ' << at;
            bytes[at] ^= 1;
        }
        bytes.push_back(7);
        ValueHash longer;
        longer.add(1.5f);
        longer.add_bytes(bytes.data(), bytes.size());
        longer.add(true);
        EXPECT_NE(longer.value(), before) << size;
    }
}

} // namespace
} // namespace montelux
