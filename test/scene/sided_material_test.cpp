// Materials of the sides of a surface: which one a path meets, within mixes too, and what the surface then needs.
#include <gtest/gtest.h>

#include "montelux/scene/material/make_bsdf.h"
#include "montelux/scene/scene_tables.h"

namespace montelux {
namespace {

// A triangle in the plane z = 0 with its normal along +z; its materials differ in reflectance.
struct SidedSheet {
    Scene scene;

    explicit SidedSheet(std::vector<Material> materials) {
        TriangleMesh mesh;
        mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}};
        mesh.indices = {0, 1, 2};
        scene.meshes.push_back(mesh);
        scene.shapes.push_back(Shape{.geometry = MeshIndex{0}, .material = 0});
        scene.world_shapes = {0};
        scene.materials = std::move(materials);
    }
    // Met by a ray from above or below.
    SurfaceBsdf met(float z) const {
        const SceneTables tables(scene);
        const Vec3f wo = normalize(Vec3f{0.3f, 0.1f, z});
        const Ray ray{Point3f{0.2f, 0, 0} + wo, -wo};
        const Hit hit{.t = 1, .b1 = 0.1f, .b2 = 0.5f, .shape = 0, .instance = no_index};
        const SurfacePoint s = surface_point(tables.view(), ray, hit, true);
        const TextureContext context{
            .p = s.p, .n = s.ns, .uv = s.uv, .dpdx = {}, .dpdy = {}, .duvdx = {}, .duvdy = {}};
        SampledWavelengths lambda = SampledWavelengths::sample_visible(0.5f);
        return make_bsdf(tables.view(), s, wo, context, lambda);
    }
    float reflectance(float z) const { return std::get<DiffuseBsdf>(met(z).bsdf).reflectance[0]; }
};

DiffuseMaterial grey_paint(float reflectance) { return {.reflectance = {reflectance}}; }

TEST(SidedMaterial, IsThatOfTheSideOfThePath) {
    SidedSheet sheet({SidedMaterial{.front = {1}, .back = {2}}, grey_paint(0.3f), grey_paint(0.8f)});
    EXPECT_EQ(sheet.reflectance(1), 0.3f);
    EXPECT_EQ(sheet.reflectance(-1), 0.8f);
    sheet.scene.shapes[0].flip_normal = true;
    EXPECT_EQ(sheet.reflectance(1), 0.8f);
    EXPECT_EQ(sheet.reflectance(-1), 0.3f);
}

// Vertex normals shade a surface, but leave its sides where they are.
TEST(SidedMaterial, SidesAreThoseOfTheGeometricNormal) {
    SidedSheet sheet({SidedMaterial{.front = {1}, .back = {2}}, grey_paint(0.3f), grey_paint(0.8f)});
    for (const float x : {-1.0f, 1.0f}) { // turned away from the ray from above, towards the one from below
        sheet.scene.meshes[0].normals.assign(3, normalize(Normal3f{x, 0, 0.2f}));
        EXPECT_EQ(sheet.reflectance(1), 0.3f) << x;
        EXPECT_EQ(sheet.reflectance(-1), 0.8f) << x;
    }
}

TEST(SidedMaterial, IsBlackWhereNoneIsGiven) {
    EXPECT_EQ(SidedSheet({SidedMaterial{.front = {1}}, grey_paint(0.3f)}).reflectance(1), 0.3f);
    EXPECT_EQ(SidedSheet({SidedMaterial{.front = {1}}, grey_paint(0.3f)}).reflectance(-1), 0);
    EXPECT_EQ(SidedSheet({SidedMaterial{.back = {1}}, grey_paint(0.3f)}).reflectance(1), 0);
    EXPECT_EQ(SidedSheet({SidedMaterial{.back = {1}}, grey_paint(0.3f)}).reflectance(-1), 0.3f);
}

TEST(SidedMaterial, NestsWithMixes) {
    const SidedSheet of_mixes({SidedMaterial{.front = {1}, .back = {2}},
                               MixMaterial{.materials = {{2}, {3}}, .amount = {1}}, grey_paint(0.3f),
                               grey_paint(0.8f)});
    EXPECT_EQ(of_mixes.reflectance(1), 0.8f);
    EXPECT_EQ(of_mixes.reflectance(-1), 0.3f);
    const SidedSheet in_a_mix({MixMaterial{.materials = {{1}, {2}}, .amount = {0}},
                               SidedMaterial{.front = {3}, .back = {2}}, grey_paint(0.3f), grey_paint(0.8f)});
    EXPECT_EQ(in_a_mix.reflectance(1), 0.8f);
    EXPECT_EQ(in_a_mix.reflectance(-1), 0.3f);
}

// An interface as a side is what it is as a part of a mix: a surface that all light passes.
TEST(SidedMaterial, InterfacesLetLightPass) {
    const SidedSheet sheet({SidedMaterial{.front = {1}, .back = {2}}, InterfaceMaterial{}, grey_paint(0.5f)});
    const auto through = std::get<ThinDielectricBsdf>(sheet.met(1).bsdf);
    EXPECT_EQ(through.reflectance({0, 0, 1}), 0);
    EXPECT_EQ(sheet.reflectance(-1), 0.5f);
    const SceneTables tables(sheet.scene);
    EXPECT_FALSE(tables.view().is_interface(0)); // shadow rays end on it
}

// Coordinates and tangents are computed where some part needs them, and only there.
TEST(SidedMaterial, NeedsWhatItsPartsNeed) {
    const auto flags = [](const Material& part) {
        const SidedSheet sheet(
            {SidedMaterial{.front = {1}}, MixMaterial{.materials = {{3}, {2}}}, part, grey_paint(0.5f)});
        const SceneTables tables(sheet.scene);
        EXPECT_EQ(tables.view().is_textured(0), tables.view().is_textured(1));
        EXPECT_EQ(tables.view().frame_follows_tangents(0), tables.view().frame_follows_tangents(1));
        return std::pair{tables.view().is_textured(0), tables.view().frame_follows_tangents(0)};
    };
    EXPECT_EQ(flags(grey_paint(0.2f)), (std::pair{false, false}));
    EXPECT_EQ(flags(DiffuseMaterial{.reflectance = {{}, 0}}), (std::pair{true, true}));
    EXPECT_EQ(flags(DiffuseMaterial{.reflectance = {0.5f}, .detail = {.displacement = {0, 0}}}),
              (std::pair{true, false}));
    EXPECT_EQ(flags(ConductorMaterial{.roughness = {{0.2f}, {0.4f}}}), (std::pair{false, true}));
    EXPECT_EQ(flags(HairMaterial{}), (std::pair{true, true}));
}

// Each side has its own bumps and normal map.
TEST(SidedMaterial, SidesHaveTheirOwnDetail) {
    SidedSheet sheet({SidedMaterial{.front = {1}, .back = {2}},
                      DiffuseMaterial{.reflectance = {0.5f}, .detail = {.normal_map = {0}}},
                      grey_paint(0.5f)});
    Image normals(1, 1, {"R", "G", "B"});
    normals.set(0, 0, 0, 0.7f);
    normals.set(0, 0, 1, 0.5f);
    normals.set(0, 0, 2, 0.9f);
    sheet.scene.images.push_back(normals);
    sheet.scene.normal_maps = {ImageTexture{.image = 0, .mapping = {}}};
    sheet.scene.meshes[0].uvs = {{0, 0}, {1, 0}, {1, 1}};
    EXPECT_TRUE(std::holds_alternative<TiltedBsdf>(sheet.met(1).bsdf));
    EXPECT_TRUE(std::holds_alternative<DiffuseBsdf>(sheet.met(-1).bsdf));
}

// The parameters of plastic reach its BSDF, with one table for both of the same interface.
TEST(PlasticMaterial, HasATable) {
    SidedSheet sheet(
        {PlasticMaterial{.reflectance = {0.5f},
                         .specular_reflectance = {0.7f},
                         .eta = 1.4f,
                         .alpha = 0.2f,
                         .distribution = MicrofacetDistribution::beckmann,
                         .nonlinear = true},
         PlasticMaterial{.eta = 1.4f, .alpha = 0.2f, .distribution = MicrofacetDistribution::beckmann},
         PlasticMaterial{.eta = 1.4f, .alpha = 0.2f}});
    const SceneTables tables(sheet.scene);
    EXPECT_EQ(tables.view().plastic_tables.size(), 2u);
    EXPECT_EQ(&tables.view().plastic(0), &tables.view().plastic(1));
    EXPECT_NE(&tables.view().plastic(0), &tables.view().plastic(2));
    const auto b = std::get<PlasticBsdf>(sheet.met(1).bsdf);
    EXPECT_EQ(b.normals.distribution, MicrofacetDistribution::beckmann);
    EXPECT_EQ(b.normals.alpha_x, 0.2f);
    EXPECT_EQ(b.normals.alpha_y, 0.2f);
    EXPECT_EQ(b.reflected[0], 0.7f);
    const PlasticTable table(1.4f, 0.2f, MicrofacetDistribution::beckmann);
    EXPECT_EQ(b.base_albedo, table.base_albedo(SampledSpectrum(0.5f), true));
    EXPECT_EQ(table.eta(), 1.4f);
}

// The distribution and factors of conductors and dielectrics; without them the BSDF is the one that has none.
TEST(TintedMaterials, AreTintedWhereTheyNeedIt) {
    const auto made = [](const Material& m) { return SidedSheet({m}).met(1).bsdf; };
    const RoughnessParameter rough{{0.3f}, {0.3f}, false};
    EXPECT_TRUE(std::holds_alternative<ConductorBsdf>(made(ConductorMaterial{.roughness = rough})));
    EXPECT_TRUE(std::holds_alternative<DielectricBsdf>(made(DielectricMaterial{.roughness = rough})));
    EXPECT_TRUE(std::holds_alternative<ThinDielectricBsdf>(made(ThinDielectricMaterial{})));
    const auto metal = std::get<TintedConductorBsdf>(
        made(ConductorMaterial{.roughness = rough,
                               .specular_reflectance = {0.4f},
                               .distribution = MicrofacetDistribution::beckmann}));
    EXPECT_EQ(metal.reflected[0], 0.4f);
    EXPECT_EQ(metal.interface.normals.alpha_x, 0.3f);
    EXPECT_EQ(metal.interface.normals.distribution, MicrofacetDistribution::beckmann);
    EXPECT_EQ(metal.interface.eta[0], 0.96f);
    EXPECT_EQ(metal.interface.k[0], 6.69f);
    const auto glass = std::get<TintedDielectricBsdf>(made(DielectricMaterial{
        .eta = 1.7f, .roughness = rough, .specular_reflectance = {0.4f}, .specular_transmittance = {2}}));
    EXPECT_EQ(glass.interface.eta, 1.7f);
    EXPECT_EQ(glass.interface.normals.alpha_x, 0.3f);
    EXPECT_EQ(glass.reflected[0], 0.4f);
    EXPECT_EQ(glass.transmitted[0], 1);
    const auto pane =
        std::get<TintedThinDielectricBsdf>(made(ThinDielectricMaterial{.specular_transmittance = {0.2f}}));
    EXPECT_EQ(pane.reflected[0], 1);
    EXPECT_EQ(pane.transmitted[0], 0.2f);
    for (const Material& m :
         {Material(ConductorMaterial{.distribution = MicrofacetDistribution::ggx_separable}),
          Material(ConductorMaterial{.specular_reflectance = {0.5f}})})
        EXPECT_TRUE(std::holds_alternative<TintedConductorBsdf>(made(m)));
    for (const Material& m : {Material(DielectricMaterial{.specular_reflectance = {0.5f}}),
                              Material(DielectricMaterial{.specular_transmittance = {0.5f}}),
                              Material(DielectricMaterial{.distribution = MicrofacetDistribution::beckmann})})
        EXPECT_TRUE(std::holds_alternative<TintedDielectricBsdf>(made(m)));
}

} // namespace
} // namespace montelux
