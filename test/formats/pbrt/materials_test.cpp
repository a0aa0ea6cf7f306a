// Materials and textures with pbrt-v4's defaults.
#include "test/formats/pbrt/parse.h"
#include "test/scene/measured_brdf_testing.h"
#include "test/temporary_folder.h"
#include <cmath>
#include <fstream>
#include <gtest/gtest.h>
#include <string>

#include "montelux/formats/pbrt/plugin_parameters.h"
#include "montelux/image/image_write.h"
#include "montelux/scene/light/light_sampling.h"
#include "montelux/scene/material/material_model.h"
#include "montelux/scene/medium/semi_infinite_albedo.h"
#include "montelux/scene/scene_tables.h"
#include "montelux/spectrum/named_spectra.h"
#include "montelux/spectrum/rgb_colorspace.h"

namespace montelux {
namespace {

using test::parse_world;
using test::WithSpectra;

template <typename T>
WithSpectra<T> material(const std::string& directive) {
    SceneDescription d = parse_world(directive + " Shape \"sphere\"");
    return {std::get<T>(d.scene.materials.at(d.scene.shapes.at(0).material)), d.scene.spectra};
}

void expect_same(const Spectrum& a, const Spectrum& b) {
    for (float lambda = 370; lambda < 820; lambda += 25) EXPECT_FLOAT_EQ(a(lambda), b(lambda)) << lambda;
}

TEST(PbrtMaterials, Defaults) {
    EXPECT_EQ(material<DiffuseMaterial>("").reflectance.value.constant, 0.5f);
    auto coated = material<CoatedDiffuseMaterial>("Material \"coateddiffuse\"");
    EXPECT_EQ(coated.of(coated.reflectance.value)(500), 0.5f);
    EXPECT_EQ(coated.coating.thickness.value, 0.01f);
    EXPECT_EQ(coated.of(coated.coating.eta)(500), 1.5f);
    EXPECT_EQ(coated.coating.g.value, 0);
    EXPECT_EQ(coated.of(coated.coating.albedo.value)(500), 0);
    EXPECT_EQ(coated.coating.max_depth, 10);
    EXPECT_EQ(coated.coating.sample_count, 1);
    EXPECT_EQ(coated.coating.roughness.u.value, 0);
    EXPECT_TRUE(coated.coating.roughness.remap);
    auto metal = material<ConductorMaterial>("Material \"conductor\"");
    expect_same(metal.of(metal.metal.eta.value), *find_named_spectrum("metal-Cu-eta"));
    expect_same(metal.of(metal.metal.k.value), *find_named_spectrum("metal-Cu-k"));
    EXPECT_FALSE(metal.metal.from_reflectance);
    EXPECT_EQ(material<DielectricMaterial>("Material \"dielectric\"").eta.constant, 1.5f);
    EXPECT_EQ(material<ThinDielectricMaterial>("Material \"thindielectric\"").eta.constant, 1.5f);
    auto both = material<CoatedConductorMaterial>("Material \"coatedconductor\"");
    expect_same(both.of(both.metal.eta.value), *find_named_spectrum("metal-Cu-eta"));
    EXPECT_EQ(both.of(both.coating.eta)(500), 1.5f);
    EXPECT_EQ(both.coating.thickness.value, 0.01f);
}

TEST(PbrtMaterials, RoughnessAndPrefixes) {
    auto m = material<ConductorMaterial>("Material \"conductor\" \"float roughness\" 0.3 \"float "
                                         "vroughness\" 0.1 \"bool remaproughness\" false");
    EXPECT_EQ(m.roughness.u.value, 0.3f);
    EXPECT_EQ(m.roughness.v.value, 0.1f);
    EXPECT_FALSE(m.roughness.remap);
    auto c = material<CoatedConductorMaterial>(
        "Material \"coatedconductor\" \"float interface.roughness\" 0.2 \"spectrum interface.eta\" "
        "\"glass-BK7\" "
        "\"float conductor.uroughness\" 0.4 \"rgb reflectance\" [ 0.5 0.25 0.125 ]");
    EXPECT_EQ(c.coating.roughness.v.value, 0.2f);
    expect_same(c.of(c.coating.eta), *find_named_spectrum("glass-BK7"));
    EXPECT_EQ(c.roughness.u.value, 0.4f);
    EXPECT_EQ(c.roughness.v.value, 0);
    EXPECT_TRUE(c.metal.from_reflectance);
}

TEST(PbrtMaterials, MeaningOfColours) {
    auto m =
        material<ConductorMaterial>("Material \"conductor\" \"rgb eta\" [ 3 2 1 ] \"rgb k\" [ 3.9 2.4 2.1 ]");
    const RgbColorSpace& srgb = RgbColorSpace::srgb();
    expect_same(m.of(m.metal.eta.value), Spectrum(RgbUnboundedSpectrum(srgb, {3, 2, 1})));
    auto d = material<DiffuseMaterial>("Material \"diffuse\" \"rgb reflectance\" [ 0.1 0.2 0.3 ]");
    expect_same(d.of(d.reflectance.value), Spectrum(RgbAlbedoSpectrum(srgb, {0.1f, 0.2f, 0.3f})));
    d = material<DiffuseMaterial>(
        "ColorSpace \"rec2020\" Material \"diffuse\" \"rgb reflectance\" [ 0.1 0.2 0.3 ]");
    expect_same(d.of(d.reflectance.value),
                Spectrum(RgbAlbedoSpectrum(RgbColorSpace::rec2020(), {0.1f, 0.2f, 0.3f})));
    d = material<DiffuseMaterial>("Material \"diffuse\" \"spectrum reflectance\" [ 400 0.2 600 0.6 ]");
    EXPECT_FLOAT_EQ(d.of(d.reflectance.value)(500), 0.4f);
}

TEST(PbrtMaterials, DiffuseTransmission) {
    auto m = material<DiffuseTransmissionMaterial>("Material \"diffusetransmission\"");
    EXPECT_EQ(m.of(m.reflectance.value)(500), 0.25f);
    EXPECT_EQ(m.of(m.transmittance.value)(500), 0.25f);
    EXPECT_EQ(m.scale, 1);
    m = material<DiffuseTransmissionMaterial>("Material \"diffusetransmission\" \"spectrum transmittance\" "
                                              "[ 400 0.2 600 0.6 ] \"float scale\" 0.5");
    EXPECT_FLOAT_EQ(m.of(m.transmittance.value)(500), 0.4f);
    EXPECT_EQ(m.of(m.reflectance.value)(500), 0.25f);
    EXPECT_EQ(m.scale, 0.5f);
}

// Else Attribute "material" would ignore it with a warning.
TEST(PbrtMaterials, AttributesKnowTheParametersOfEachMaterial) {
    for_each_material_kind([]<typename M>(std::type_identity<M>) {
        M m;
        visit_parameters(m, []<typename Field>(const ParameterInfo& info, const Field&) {
            if constexpr (!std::is_same_v<Field, RoughnessParameter> &&
                          !std::is_same_v<Field, MetalParameter> &&
                          !std::is_same_v<Field, HairColorParameter> && !std::is_same_v<Field, MediumIndex>) {
                EXPECT_TRUE(pbrt::has_parameter(pbrt::PluginKind::material, info.pbrt_name()))
                    << M::name << ' ' << info.pbrt_name() << ": to be added to plugin_parameters.cpp";
            }
        });
    });
}

const char* const all_materials[] = {
    "diffuse",       "conductor",       "dielectric",          "thindielectric",
    "coateddiffuse", "coatedconductor", "diffusetransmission", "interface",
    "hair"};

TEST(PbrtMaterials, EachHasNormalMapAndBumps) {
    TemporaryFolder folder;
    Image normals(1, 1, {"R", "G", "B"}, PixelFormat::u8, ColorEncoding::srgb());
    for (int c = 0; c < 3; ++c) normals.u8()[static_cast<std::size_t>(c)] = c == 2 ? 255 : 51;
    write_image(folder / "n.png", normals);
    for (const std::string name : all_materials) {
        if (name == "interface") continue; // WhatHasNoSurfaceHasNoBumps
        Warnings warnings;
        const SceneDescription d =
            parse_pbrt("WorldBegin LightSource \"point\"\n"
                       "Texture \"h\" \"float\" \"checkerboard\"\nMaterial \"" +
                           name +
                           "\" \"string normalmap\" \"n.png\" \"texture displacement\" "
                           "\"h\"\nShape \"sphere\" Shape \"disk\"",
                       "scene", folder.path(), warnings);
        EXPECT_TRUE(warnings.messages().empty()) << warnings.messages()[0];
        ASSERT_EQ(d.scene.materials.size(), 1u);
        const SurfaceDetail detail = std::visit([](const auto& m) { return m.detail; }, d.scene.materials[0]);
        EXPECT_EQ(detail.displacement.texture, 0u) << name;
        ASSERT_EQ(d.scene.normal_maps.size(), 1u);
        EXPECT_EQ(detail.normal_map.map, 0u) << name;
        // Linear, whatever PNG files are.
        const Image& picture = d.scene.images[d.scene.normal_maps[0].image];
        EXPECT_NEAR(picture.value(0, 0, 0), 0.2f, 1e-6f);
    }
}

TEST(PbrtMaterials, NormalMapsThatAreNoneSayWhere) {
    EXPECT_EQ(test::world_error("Material \"diffuse\"\n\"string normalmap\" \"lost.png\" Shape \"sphere\"")
                  .substr(0, 10),
              "scene:3:1:");
    TemporaryFolder folder;
    write_image(folder / "gray.png", Image(1, 1, {"Y"}, PixelFormat::u8, ColorEncoding::srgb()));
    Warnings warnings;
    try {
        parse_pbrt("WorldBegin Material \"diffuse\" \"string normalmap\" \"gray.png\" Shape \"sphere\"",
                   "scene", folder.path(), warnings);
        FAIL();
    } catch (const Error& e) {
        EXPECT_EQ(std::string(e.what()), "scene:1:31: normal map 'gray.png' has no channels R, G and B");
    }
}

TEST(PbrtMaterials, NamedOnesMayFollowAndUnusedOnesAreRead) {
    Warnings warnings;
    SceneDescription d = parse_world(
        "LightSource \"point\" NamedMaterial \"a\" Shape \"sphere\" Shape \"disk\" MakeNamedMaterial "
        "\"a\" \"string type\" \"dielectric\"\nMaterial \"diffuse\"",
        &warnings);
    EXPECT_EQ(d.scene.materials.size(), 2u);
    EXPECT_TRUE(std::holds_alternative<DielectricMaterial>(d.scene.materials[d.scene.shapes[1].material]));
    EXPECT_TRUE(warnings.messages().empty());
    EXPECT_EQ(test::world_error("Material \"hair\" \"float beta_m\" 2"),
              "scene:2:17: parameter 'beta_m' is above 1");
}

TEST(PbrtMaterials, MixesOfNamedMaterials) {
    // Of names that follow, and nested; each material is made once.
    const SceneDescription d = parse_world(R"(
        MakeNamedMaterial "outer" "string type" "mix" "string materials" [ "inner" "white" ]
        MakeNamedMaterial "inner" "string type" "mix" "string materials" [ "glass" "white" ] "float amount" 0.25
        MakeNamedMaterial "white" "string type" "diffuse"
        MakeNamedMaterial "glass" "string type" "dielectric"
        NamedMaterial "outer" Shape "sphere")");
    const std::vector<Material>& m = d.scene.materials;
    ASSERT_EQ(m.size(), 4u);
    const auto& outer = std::get<MixMaterial>(m[d.scene.shapes[0].material]);
    EXPECT_EQ(outer.amount.value, 0.5f);
    const auto& inner = std::get<MixMaterial>(m[outer.materials.first.index]);
    EXPECT_EQ(inner.amount.value, 0.25f);
    EXPECT_TRUE(std::holds_alternative<DielectricMaterial>(m[inner.materials.first.index]));
    EXPECT_TRUE(std::holds_alternative<DiffuseMaterial>(m[inner.materials.second.index]));
    EXPECT_EQ(inner.materials.second.index, outer.materials.second.index);
}

TEST(PbrtMaterials, MixesThatAreNoneSayWhere) {
    EXPECT_EQ(test::world_error("Material \"mix\" Shape \"sphere\""),
              "scene:2:1: 'mix' needs a parameter 'string materials' with 2 names");
    EXPECT_EQ(test::world_error("Material \"mix\"\n\"string materials\" [ \"a\" ] Shape \"sphere\""),
              "scene:3:1: 'mix' needs a parameter 'string materials' with 2 names");
    const std::string mix = "\"string type\" \"mix\"\n\"string materials\" ";
    EXPECT_EQ(test::world_error("MakeNamedMaterial \"a\" \"string type\" \"diffuse\"\nMaterial \"mix\" " +
                                mix.substr(mix.find('\n') + 1) + "[ \"a\" \"b\" ] Shape \"sphere\"")
                  .substr(0, 11),
              "scene:3:16:");
    EXPECT_EQ(test::world_error("MakeNamedMaterial \"a\" " + mix + "[ \"a\" \"a\" ]"),
              "scene:3:1: the material depends on itself");
    EXPECT_EQ(test::world_error("MakeNamedMaterial \"a\" " + mix +
                                "[ \"b\" \"b\" ]\nMakeNamedMaterial \"b\" " + mix + "[ \"a\" \"a\" ]"),
              "scene:5:1: the material depends on itself");
    std::string chain = "MakeNamedMaterial \"m0\" \"string type\" \"diffuse\"\n";
    for (int i = 1; i < 70; ++i) {
        const std::string below = "\"m" + std::to_string(i - 1) + "\" ";
        chain += "MakeNamedMaterial \"m" + std::to_string(i) + "\" " + mix + "[ " + below + below + "]\n";
    }
    EXPECT_NE(test::world_error(chain + "NamedMaterial \"m69\" Shape \"sphere\"").find("64 levels deep"),
              std::string::npos);
}

TEST(PbrtMaterials, WhatHasNoSurfaceHasNoBumps) {
    for (const std::string type : {"interface", "mix"}) {
        Warnings warnings;
        test::parse(R"(WorldBegin
Texture "t" "float" "fbm"
MakeNamedMaterial "m" "string type" "diffuse"
Material ")" + type + R"(" "texture displacement" "t" "string materials" [ "m" "m" ]
Shape "sphere"
LightSource "point")",
                    &warnings);
        const std::string expected =
            "scene:4:1: bumps and normal map of '" + type + "' are ignored: it has no surface of its own";
        EXPECT_NE(std::find(warnings.messages().begin(), warnings.messages().end(), expected),
                  warnings.messages().end())
            << type << " " << warnings.messages().size();
    }
}

HomogeneousMedium interior_of_sphere(const SceneDescription& d) {
    const Shape& shape = d.scene.shapes.at(0);
    EXPECT_EQ(std::get<SubsurfaceMaterial>(d.scene.materials.at(shape.material)).interior.index,
              shape.media.inside);
    return std::get<HomogeneousMedium>(d.scene.media.at(shape.media.inside));
}

TEST(PbrtMaterials, Subsurface) {
    const auto body = [](const std::string& parameters, Warnings* warnings = nullptr) {
        SceneDescription d = parse_world(
            "LightSource \"point\" Material \"subsurface\" " + parameters + " Shape \"sphere\"", warnings);
        return WithSpectra<HomogeneousMedium>{interior_of_sphere(d), d.scene.spectra};
    };
    const RgbColorSpace& srgb = RgbColorSpace::srgb();
    auto m = body("\"float g\" 0.3 \"float scale\" 2");
    expect_same(m.of(m.sigma_a), Spectrum(RgbUnboundedSpectrum(srgb, {0.0011f, 0.0024f, 0.014f})));
    expect_same(m.of(m.sigma_s), Spectrum(RgbUnboundedSpectrum(srgb, {2.55f, 3.21f, 3.77f})));
    EXPECT_EQ(m.scale, 2);
    EXPECT_EQ(std::get<HenyeyGreenstein>(m.phase).g, 0.3f);
    EXPECT_TRUE(m.is_body);
    m = body("\"rgb sigma_a\" [ 1 2 3 ] \"spectrum sigma_s\" [ 400 1 600 3 ]");
    expect_same(m.of(m.sigma_a), Spectrum(RgbUnboundedSpectrum(srgb, {1, 2, 3})));
    EXPECT_FLOAT_EQ(m.of(m.sigma_s)(500), 2);
    m = body("\"spectrum reflectance\" [ 300 0.8 900 0.8 ] \"spectrum mfp\" [ 300 0.25 900 0.25 ] \"float "
             "scale\" 2 "
             "\"float eta\" 1.5");
    EXPECT_EQ(m.scale, 1);
    const float albedo = single_scattering_albedo(0.8f, 1.5f);
    EXPECT_FLOAT_EQ(m.of(m.sigma_s)(500), 2 * albedo);
    EXPECT_NEAR(m.of(m.sigma_a)(700.5f), 2 * (1 - albedo), 1e-5f);
    // The same reduced albedo.
    m = body("\"spectrum reflectance\" [ 300 0.8 900 0.8 ] \"float eta\" 1.5 \"float g\" 0.5");
    const float s = m.of(m.sigma_s)(500), a = m.of(m.sigma_a)(500);
    EXPECT_NEAR(s + a, 1, 1e-6f);
    EXPECT_NEAR(s * 0.5f / (s * 0.5f + a), albedo, 1e-5f);

    Warnings warnings;
    m = body("\"string name\" \"Skimmilk\" \"float g\" 0.2 \"rgb reflectance\" [ 1 1 1 ]", &warnings);
    expect_same(m.of(m.sigma_s), Spectrum(RgbUnboundedSpectrum(srgb, {0.70f, 1.22f, 1.90f})));
    EXPECT_EQ(std::get<HenyeyGreenstein>(m.phase).g, 0);
    EXPECT_EQ(warnings.messages(),
              (std::vector<std::string>{
                  "scene:2:21: 'subsurface' has several of 'name', 'sigma_a' with 'sigma_s', and "
                  "'reflectance'; 'name' is used",
                  "scene:2:68: 'g' is ignored: the coefficients of 'name' are reduced ones"}));
}

TEST(PbrtMaterials, SubsurfaceIsInsideOfItsShapes) {
    // In fog; in a mix; one for both shapes.
    const SceneDescription d = parse_world("LightSource \"point\" MakeNamedMedium \"fog\" \"string type\" "
                                           "\"homogeneous\" MediumInterface \"fog\" \"fog\"\n"
                                           "MakeNamedMaterial \"skin\" \"string type\" \"subsurface\" "
                                           "MakeNamedMaterial \"dust\" \"string type\" \"diffuse\"\n"
                                           "NamedMaterial \"skin\" Shape \"sphere\" Material \"mix\" "
                                           "\"string materials\" [ \"dust\" \"skin\" ] Shape \"sphere\"\n"
                                           "NamedMaterial \"dust\" Shape \"sphere\"");
    ASSERT_EQ(d.scene.media.size(), 2u);
    for (int i : {0, 1}) {
        EXPECT_EQ(d.scene.shapes.at(static_cast<std::size_t>(i)).media.inside, 1u);
        EXPECT_EQ(d.scene.shapes.at(static_cast<std::size_t>(i)).media.outside, 0u);
    }
    EXPECT_FALSE(d.scene.shapes.at(2).media.is_transition());
    EXPECT_EQ(test::world_error("MakeNamedMaterial \"a\" \"string type\" \"subsurface\"\n"
                                "MakeNamedMaterial \"b\" \"string type\" \"subsurface\"\n"
                                "Material \"mix\" \"string materials\" [ \"a\" \"b\" ] Shape \"sphere\""),
              "scene:4:47: the materials of a mix have two interiors ('subsurface'); expected one");
}

TEST(PbrtMaterials, SubsurfaceErrors) {
    const auto error = [](const std::string& parameters) {
        return test::world_error("Material \"subsurface\" " + parameters + " Shape \"sphere\"");
    };
    EXPECT_EQ(error("\"rgb sigma_a\" [ 1 1 1 ]"),
              "scene:2:23: 'sigma_a' and 'sigma_s' must be given together");
    EXPECT_EQ(error("\"float g\" 1"), "scene:2:23: parameter 'g' is not between -1 and 1");
    EXPECT_EQ(error("\"float eta\" 0.5"), "scene:2:23: parameter 'eta' is below 1");
    EXPECT_EQ(error("\"float scale\" 0"), "scene:2:23: parameter 'scale' is not positive");
    EXPECT_EQ(error("\"rgb reflectance\" [ .5 .5 .5 ] \"spectrum mfp\" [ 400 0 500 1 ]"),
              "scene:2:54: parameter 'mfp' is 0 at a visible wavelength");
    EXPECT_EQ(error("\"string name\" \"Skimmilc\""),
              "scene:2:23: there is no medium preset 'Skimmilc' (did you mean 'Skimmilk'?)");
    EXPECT_EQ(error("\"texture reflectance\" \"t\""), "scene:2:23: there is no spectrum texture 't'");
    EXPECT_EQ(error("\"texture sigma_a\" \"t\""),
              "scene:2:23: 'sigma_a' and 'sigma_s' must be given together");
    EXPECT_EQ(error("\"spectrum sigma_a\" [ 400 -1 500 1 ] \"rgb sigma_s\" [ 1 1 1 ]"),
              "scene:2:23: parameter 'sigma_a' is negative or not finite at 400 nm");
}

TEST(PbrtMaterials, Measured) {
    TemporaryFolder folder;
    const std::vector<std::uint8_t> bytes =
        testing::measured_brdf_file(testing::measured_ggx({{0.5f, 0.5f}}, 8)).bytes();
    std::ofstream(folder / "a.bsdf", std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    std::ofstream(folder / "b.bsdf") << "no such file";
    Warnings warnings;
    const auto parse = [&](const std::string& file) {
        return parse_pbrt(
            "WorldBegin LightSource \"point\"\n"
            "Material \"measured\" \"string filename\" \"a.bsdf\" Shape \"sphere\" AttributeBegin\n"
            "Material \"measured\" \"string filename\" \"" +
                file + "\" \"float displacement\" 1 Shape \"disk\" AttributeEnd",
            "scene", folder.path(), warnings);
    };
    const SceneDescription d = parse("a.bsdf");
    EXPECT_TRUE(warnings.messages().empty());
    ASSERT_EQ(d.scene.measured_brdfs.size(), 1u);
    EXPECT_TRUE(d.scene.measured_brdfs[0].is_isotropic());
    ASSERT_EQ(d.scene.materials.size(), 2u);
    for (const Material& m : d.scene.materials) EXPECT_EQ(std::get<MeasuredMaterial>(m).brdf.index, 0u);
    try {
        parse("b.bsdf");
        FAIL() << "read";
    } catch (const Error& e) {
        EXPECT_EQ(std::string(e.what()),
                  "scene:3:21: " + (folder / "b.bsdf").string() + ": is no file of a measured BRDF (.bsdf)");
    }
}

TEST(PbrtMaterials, Hair) {
    auto m = material<HairMaterial>("Material \"hair\"");
    EXPECT_EQ(m.color.source, HairColorParameter::melanins);
    EXPECT_EQ(m.color.eumelanin.value, 1.3f);
    EXPECT_EQ(m.color.pheomelanin.value, 0);
    EXPECT_EQ(m.eta.value, 1.55f);
    EXPECT_EQ(m.beta_m.value, 0.3f);
    EXPECT_EQ(m.beta_n.value, 0.3f);
    EXPECT_EQ(m.alpha.value, 2);
    m = material<HairMaterial>("Material \"hair\" \"float pheomelanin\" 0.7 \"float beta_m\" 0.2 "
                               "\"float beta_n\" 0.4 \"float alpha\" 3 \"float eta\" 1.4");
    EXPECT_EQ(m.color.eumelanin.value, 0);
    EXPECT_EQ(m.color.pheomelanin.value, 0.7f);
    EXPECT_EQ(m.beta_m.value, 0.2f);
    EXPECT_EQ(m.beta_n.value, 0.4f);
    EXPECT_EQ(m.alpha.value, 3);
    EXPECT_EQ(m.eta.value, 1.4f);
    m = material<HairMaterial>("Material \"hair\" \"spectrum sigma_a\" [ 400 1 600 3 ]");
    EXPECT_EQ(m.color.source, HairColorParameter::absorption);
    EXPECT_FLOAT_EQ(m.of(m.color.sigma_a.value)(500), 2);
    for (const char* name : {"color", "reflectance"}) {
        m = material<HairMaterial>("Material \"hair\" \"spectrum " + std::string(name) +
                                   "\" [ 400 0.2 600 0.6 ]");
        EXPECT_EQ(m.color.source, HairColorParameter::reflectances) << name;
        EXPECT_FLOAT_EQ(m.of(m.color.reflectance.value)(500), 0.4f);
    }
    Warnings warnings;
    parse_world("LightSource \"point\" Material \"hair\" \"float eumelanin\" 1 \"rgb color\" [ 0.5 0.5 0.5 ] "
                "Shape \"sphere\"",
                &warnings);
    EXPECT_EQ(
        warnings.messages(),
        std::vector<std::string>{"scene:2:21: 'hair' has several of 'sigma_a', 'reflectance' and melanins; "
                                 "'reflectance' is used"});
}

TEST(PbrtTextures, NodesAndDefaults) {
    SceneDescription d = parse_world(R"(
        Texture "f" "float" "constant" "float value" 0.25
        Texture "s" "float" "scale" "texture tex" "f" "float scale" 3
        Texture "m" "spectrum" "mix" "rgb tex2" [ 0.5 0.5 0.5 ] "texture amount" "s"
        Translate 1 0 0
        Texture "c" "spectrum" "checkerboard" "texture tex1" "m" "float uscale" 20 "float vdelta" 0.5
        Texture "c3" "float" "checkerboard" "integer dimension" 3
        Material "diffuse" "texture reflectance" "c"
        Shape "sphere" "texture alpha" "c3"
        Material "conductor" "texture eta" "c"
        Shape "disk")");
    const auto& m = std::get<DiffuseMaterial>(d.scene.materials[d.scene.shapes[0].material]);
    const auto& c =
        std::get<CheckerboardTexture<SpectrumParameter>>(d.scene.spectrum_textures[m.reflectance.texture]);
    EXPECT_EQ(c.mapping.su, 20);
    EXPECT_EQ(c.mapping.sv, 1);
    EXPECT_EQ(c.mapping.dv, 0.5f);
    EXPECT_EQ(c.values[1].value.constant, 0);
    const auto& mix = std::get<MixTexture<SpectrumParameter>>(d.scene.spectrum_textures[c.values[0].texture]);
    EXPECT_EQ(spectrum_of(mix.first.value, d.scene.spectra)(500), 0);
    EXPECT_NEAR(spectrum_of(mix.second.value, d.scene.spectra)(500), 0.5f, 1e-3f);
    const auto& scale = std::get<ScaleTexture<FloatParameter>>(d.scene.float_textures[mix.amount.texture]);
    EXPECT_EQ(scale.scale.value, 3);
    EXPECT_EQ(
        std::get<ConstantTexture<FloatParameter>>(d.scene.float_textures[scale.texture.texture]).value.value,
        0.25f);
    const auto& c3 = std::get<CheckerboardTexture<FloatParameter>>(
        d.scene.float_textures[d.scene.shapes[0].alpha.texture]);
    EXPECT_EQ(c3.dimension, 3);
    EXPECT_EQ(c3.values[0].value, 1);
    EXPECT_EQ(c3.mapping.texture_from_world.point(Vec3f(1, 0, 0)), Vec3f());
    // As an index of refraction the same texture is another node.
    const auto& metal = std::get<ConductorMaterial>(d.scene.materials[d.scene.shapes[1].material]);
    EXPECT_NE(metal.metal.eta.texture, m.reflectance.texture);
}

TEST(PbrtTextures, ProceduralTexturesAndDefaults) {
    const SceneDescription d = parse_world(R"(
        Translate 1 0 0
        Rotate 90 0 0 1
        Texture "fbm" "float" "fbm"
        Texture "windy" "float" "windy"
        Texture "wrinkled" "float" "wrinkled" "integer octaves" 3 "float roughness" 0.25
        Texture "dots" "float" "dots" "texture inside" "fbm" "float vscale" 4
        Texture "bilerp" "float" "bilerp"
        Texture "turn" "float" "directionmix" "texture tex1" "dots" "texture tex2" "windy"
        Texture "marble" "spectrum" "marble" "float variation" 2
        Texture "corners" "spectrum" "bilerp" "spectrum v10" [ 400 0.5 700 0.5 ]
        Identity
        Material "coateddiffuse" "texture reflectance" "marble" "texture roughness" "wrinkled"
                 "texture thickness" "turn" "texture albedo" "corners"
        Shape "sphere" "texture alpha" "bilerp")");
    const Scene& s = d.scene;
    const auto& m = std::get<CoatedDiffuseMaterial>(s.materials.back());
    const auto& marble = std::get<MarbleTexture>(s.spectrum_textures[m.reflectance.texture]);
    EXPECT_EQ(marble.octaves.octaves, 8);
    EXPECT_EQ(marble.octaves.roughness, 0.5f);
    EXPECT_EQ(marble.scale, 1);
    EXPECT_EQ(marble.variation, 2);
    EXPECT_EQ(marble.texture_from_world.point(Vec3f(1, 0, 0)), Vec3f());
    const auto& wrinkled = std::get<NoiseTexture>(s.float_textures[m.coating.roughness.u.texture]);
    EXPECT_EQ(wrinkled.kind, NoiseTexture::Kind::wrinkled);
    EXPECT_EQ(wrinkled.octaves.octaves, 3);
    EXPECT_EQ(wrinkled.octaves.roughness, 0.25f);
    const auto& turn =
        std::get<DirectionMixTexture<FloatParameter>>(s.float_textures[m.coating.thickness.texture]);
    EXPECT_NEAR(turn.direction.x, -1, 1e-6); // y, turned
    EXPECT_NEAR(turn.direction.y, 0, 1e-6);
    const auto& dots = std::get<DotsTexture<FloatParameter>>(s.float_textures[turn.first.texture]);
    EXPECT_EQ(dots.outside.value, 0);
    EXPECT_EQ(dots.mapping.sv, 4);
    const auto& fbm = std::get<NoiseTexture>(s.float_textures[dots.inside.texture]);
    EXPECT_EQ(fbm.kind, NoiseTexture::Kind::fbm);
    EXPECT_EQ(fbm.octaves.octaves, 8);
    EXPECT_EQ(fbm.octaves.roughness, 0.5f);
    EXPECT_EQ(std::get<NoiseTexture>(s.float_textures[turn.second.texture]).kind, NoiseTexture::Kind::windy);
    const auto& bilerp = std::get<BilerpTexture<FloatParameter>>(s.float_textures[s.shapes[0].alpha.texture]);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(bilerp.corners[i].value, i < 2 ? 0 : 1);
    const auto& corners =
        std::get<BilerpTexture<SpectrumParameter>>(s.spectrum_textures[m.coating.albedo.texture]);
    EXPECT_NEAR(spectrum_of(corners.corners[1].value, s.spectra)(550), 0.5, 1e-6);
    EXPECT_EQ(corners.corners[0].value.constant, 0);
    EXPECT_EQ(corners.corners[3].value.constant, 1);
}

TEST(PbrtTextures, PicturesAreReadOnceForEachEncoding) {
    TemporaryFolder folder;
    Image picture(4, 4, {"R", "G", "B"}, PixelFormat::u8, ColorEncoding::srgb());
    write_image(folder / "a.png", picture);
    Warnings warnings;
    SceneDescription d = parse_pbrt(R"(WorldBegin
        LightSource "point"
        Texture "a" "spectrum" "imagemap" "string filename" "a.png" "bool invert" true "float scale" 2
        Texture "b" "float" "imagemap" "string filename" "a.png" "string filter" "ewa" "string wrap" "clamp"
        Texture "c" "float" "imagemap" "string filename" "a.png" "string encoding" "linear"
        Texture "d" "float" "imagemap" "string filename" "a.png" "string encoding" "gamma 2.2"
            "string mapping" "planar" "vector3 v1" [ 0 0 2 ]
        Texture "unused" "float" "imagemap" "string filename" "none.png"
        Material "coateddiffuse" "texture reflectance" "a" "texture roughness" "b" "texture thickness" "c"
        Shape "sphere" "texture alpha" "d")",
                                    "scene", folder.path(), warnings);
    ASSERT_EQ(d.scene.images.size(), 3u);
    const auto& m = std::get<CoatedDiffuseMaterial>(d.scene.materials[d.scene.shapes[0].material]);
    const auto& a = std::get<ImageTexture>(d.scene.spectrum_textures[m.reflectance.texture]);
    const auto& b = std::get<ImageTexture>(d.scene.float_textures[m.coating.roughness.u.texture]);
    const auto& c = std::get<ImageTexture>(d.scene.float_textures[m.coating.thickness.texture]);
    const auto& e = std::get<ImageTexture>(d.scene.float_textures[d.scene.shapes[0].alpha.texture]);
    EXPECT_EQ(a.image, b.image);
    EXPECT_NE(a.image, c.image);
    EXPECT_TRUE(a.invert);
    EXPECT_EQ(a.scale, 2);
    EXPECT_EQ(a.filter, TextureFilter::bilinear);
    EXPECT_EQ(a.wrap, TextureWrap::repeat);
    EXPECT_EQ(a.meaning, RgbMeaning::albedo);
    EXPECT_EQ(b.filter, TextureFilter::ewa);
    EXPECT_EQ(b.wrap, TextureWrap::clamp);
    EXPECT_EQ(d.scene.images[a.image].encoding(), ColorEncoding::srgb());
    EXPECT_EQ(d.scene.images[c.image].encoding(), ColorEncoding::linear());
    EXPECT_EQ(d.scene.images[e.image].encoding(), ColorEncoding::gamma(2.2f));
    EXPECT_EQ(e.mapping.kind, TextureMapping::Kind::planar);
    EXPECT_EQ(e.mapping.vs, Vec3f(0, 0, 2));
    EXPECT_EQ(warnings.messages(),
              std::vector<std::string>{"scene:8:9: texture 'unused' is not used and was not read"});
}

// As pbrt-v4: a number is the alpha of a picture in colour that has holes, and else the mean of its colours.
TEST(PbrtTextures, NumbersFromPicturesWithAlpha) {
    TemporaryFolder folder;
    Image opaque(2, 2, {"R", "G", "B", "A"}, PixelFormat::u8, ColorEncoding::srgb());
    for (std::uint8_t& v : opaque.u8()) v = 255;
    Image leaf = opaque;
    leaf.u8()[leaf.index(1, 1, 3)] = 0;
    write_image(folder / "opaque.png", opaque);
    write_image(folder / "leaf.png", leaf);
    Warnings warnings;
    SceneDescription d = parse_pbrt(R"(WorldBegin
        Texture "leaf" "float" "imagemap" "string filename" "leaf.png"
        Texture "opaque" "float" "imagemap" "string filename" "opaque.png"
        Texture "leaf" "spectrum" "imagemap" "string filename" "leaf.png"
        Material "diffuse" "texture reflectance" "leaf"
        Shape "sphere" "texture alpha" "leaf"
        Shape "sphere" "texture alpha" "opaque")",
                                    "scene", folder.path(), warnings);
    auto channels = [&](std::size_t shape) {
        return std::get<ImageTexture>(d.scene.float_textures[d.scene.shapes[shape].alpha.texture]).channels;
    };
    EXPECT_EQ(channels(0), ImageChannels::alpha);
    EXPECT_EQ(channels(1), ImageChannels::color);
    const auto& m = std::get<DiffuseMaterial>(d.scene.materials[d.scene.shapes[0].material]);
    EXPECT_EQ(std::get<ImageTexture>(d.scene.spectrum_textures[m.reflectance.texture]).channels,
              ImageChannels::color);
}

} // namespace
} // namespace montelux
