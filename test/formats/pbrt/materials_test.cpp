// Materials with pbrt-v4's defaults.
#include "test/formats/pbrt/parse.h"
#include "test/formats/pbrt/same_spectrum.h"
#include "test/scene/measured_brdf_testing.h"
#include "test/temporary_folder.h"
#include <fstream>
#include <gtest/gtest.h>
#include <string>

#include "montelux/formats/pbrt/plugin_parameters.h"
#include "montelux/scene/material/material_model.h"
#include "montelux/spectrum/named_spectra.h"
#include "montelux/spectrum/rgb_colorspace.h"

namespace montelux {
namespace {

using test::expect_same_values;
using test::parse_world;
using test::WithSpectra;

template <typename T>
WithSpectra<T> material(const std::string& directive) {
    SceneDescription d = parse_world(directive + " Shape \"sphere\"");
    return {std::get<T>(d.scene.materials.at(d.scene.shapes.at(0).material)), d.scene.spectra};
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
    expect_same_values(metal.of(metal.metal.eta.value), *find_named_spectrum("metal-Cu-eta"));
    expect_same_values(metal.of(metal.metal.k.value), *find_named_spectrum("metal-Cu-k"));
    EXPECT_FALSE(metal.metal.from_reflectance);
    EXPECT_EQ(material<DielectricMaterial>("Material \"dielectric\"").eta.constant, 1.5f);
    EXPECT_EQ(material<ThinDielectricMaterial>("Material \"thindielectric\"").eta.constant, 1.5f);
    auto both = material<CoatedConductorMaterial>("Material \"coatedconductor\"");
    expect_same_values(both.of(both.metal.eta.value), *find_named_spectrum("metal-Cu-eta"));
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
    expect_same_values(c.of(c.coating.eta), *find_named_spectrum("glass-BK7"));
    EXPECT_EQ(c.roughness.u.value, 0.4f);
    EXPECT_EQ(c.roughness.v.value, 0);
    EXPECT_TRUE(c.metal.from_reflectance);
}

TEST(PbrtMaterials, MeaningOfColours) {
    auto m =
        material<ConductorMaterial>("Material \"conductor\" \"rgb eta\" [ 3 2 1 ] \"rgb k\" [ 3.9 2.4 2.1 ]");
    const RgbColorSpace& srgb = RgbColorSpace::srgb();
    expect_same_values(m.of(m.metal.eta.value), Spectrum(RgbUnboundedSpectrum(srgb, {3, 2, 1})));
    auto d = material<DiffuseMaterial>("Material \"diffuse\" \"rgb reflectance\" [ 0.1 0.2 0.3 ]");
    expect_same_values(d.of(d.reflectance.value), Spectrum(RgbAlbedoSpectrum(srgb, {0.1f, 0.2f, 0.3f})));
    d = material<DiffuseMaterial>(
        "ColorSpace \"rec2020\" Material \"diffuse\" \"rgb reflectance\" [ 0.1 0.2 0.3 ]");
    expect_same_values(d.of(d.reflectance.value),
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

TEST(PbrtMaterials, Principled) {
    auto m = material<PrincipledMaterial>("Material \"principled\"");
    EXPECT_EQ(m.of(m.base_color.value)(500), 1);
    EXPECT_EQ(m.metallic.value, 0);
    EXPECT_EQ(m.roughness.value, 0.5f);
    EXPECT_EQ(m.ior.value, 1.5f);
    EXPECT_EQ(m.specular.value, 1);
    EXPECT_EQ(m.of(m.specular_color.value)(500), 1);
    EXPECT_EQ(m.of(m.sheen_color.value)(500), 0);
    EXPECT_EQ(m.iridescence_ior.value, 1.3f);
    EXPECT_EQ(m.iridescence_thickness.value, 400);
    EXPECT_FALSE(m.thin_walled);
    for (const FloatParameter& p :
         {m.anisotropy, m.anisotropy_rotation, m.transmission, m.dispersion, m.diffuse_transmission,
          m.clearcoat, m.clearcoat_roughness, m.sheen_roughness, m.iridescence})
        EXPECT_EQ(p.value, 0);

    m = material<PrincipledMaterial>(
        "Material \"principled\" \"rgb basecolor\" [ 0.1 0.2 0.3 ] \"float metallic\" 0.1 \"float "
        "roughness\" 0.2 "
        "\"float anisotropy\" 0.3 \"float anisotropyrotation\" -1 \"float ior\" 1.7 \"float specular\" 0.4 "
        "\"rgb specularcolor\" [ 2 1 1 ] \"float transmission\" 0.5 \"float dispersion\" 0.6 "
        "\"float diffusetransmission\" 0.7 \"rgb diffusetransmissioncolor\" [ 0.3 0.2 0.1 ] \"float "
        "clearcoat\" 0.8 "
        "\"float clearcoatroughness\" 0.9 \"rgb sheencolor\" [ 0.1 0.3 0.2 ] \"float sheenroughness\" 0.15 "
        "\"float iridescence\" 0.25 \"float iridescenceior\" 1.35 \"float iridescencethickness\" 450 "
        "\"bool thinwalled\" true");
    const RgbColorSpace& srgb = RgbColorSpace::srgb();
    expect_same_values(m.of(m.base_color.value), Spectrum(RgbAlbedoSpectrum(srgb, {0.1f, 0.2f, 0.3f})));
    expect_same_values(m.of(m.specular_color.value), Spectrum(RgbUnboundedSpectrum(srgb, {2, 1, 1})));
    expect_same_values(m.of(m.diffuse_transmission_color.value),
                       Spectrum(RgbAlbedoSpectrum(srgb, {0.3f, 0.2f, 0.1f})));
    expect_same_values(m.of(m.sheen_color.value), Spectrum(RgbAlbedoSpectrum(srgb, {0.1f, 0.3f, 0.2f})));
    EXPECT_EQ(m.metallic.value, 0.1f);
    EXPECT_EQ(m.roughness.value, 0.2f);
    EXPECT_EQ(m.anisotropy.value, 0.3f);
    EXPECT_EQ(m.anisotropy_rotation.value, -1);
    EXPECT_EQ(m.ior.value, 1.7f);
    EXPECT_EQ(m.specular.value, 0.4f);
    EXPECT_EQ(m.transmission.value, 0.5f);
    EXPECT_EQ(m.dispersion.value, 0.6f);
    EXPECT_EQ(m.diffuse_transmission.value, 0.7f);
    EXPECT_EQ(m.clearcoat.value, 0.8f);
    EXPECT_EQ(m.clearcoat_roughness.value, 0.9f);
    EXPECT_EQ(m.sheen_roughness.value, 0.15f);
    EXPECT_EQ(m.iridescence.value, 0.25f);
    EXPECT_EQ(m.iridescence_ior.value, 1.35f);
    EXPECT_EQ(m.iridescence_thickness.value, 450);
    EXPECT_TRUE(m.thin_walled);
    EXPECT_EQ(test::world_error("Material \"principled\" \"float metallic\" 2"),
              "scene:2:23: parameter 'metallic' is above 1");
}

TEST(PbrtMaterials, Plastic) {
    auto m = material<PlasticMaterial>("Material \"plastic\"");
    EXPECT_EQ(m.of(m.reflectance.value)(500), 0.5f);
    EXPECT_EQ(m.of(m.specular_reflectance.value)(500), 1);
    EXPECT_EQ(m.eta, 1.5f);
    EXPECT_EQ(m.alpha, 0);
    EXPECT_EQ(m.distribution, MicrofacetDistribution::ggx);
    EXPECT_FALSE(m.nonlinear);
    EXPECT_EQ(m.internal_reflectance, 0);
    m = material<PlasticMaterial>(
        "Material \"plastic\" \"rgb reflectance\" [ 0.1 0.2 0.3 ] \"rgb specularreflectance\" [ 0.3 0.2 0.1 "
        "] "
        "\"float eta\" 1.4 \"float alpha\" 0.2 \"string distribution\" \"beckmann\" \"bool nonlinear\" true "
        "\"float internalreflectance\" 0.6");
    const RgbColorSpace& srgb = RgbColorSpace::srgb();
    expect_same_values(m.of(m.reflectance.value), Spectrum(RgbAlbedoSpectrum(srgb, {0.1f, 0.2f, 0.3f})));
    expect_same_values(m.of(m.specular_reflectance.value),
                       Spectrum(RgbAlbedoSpectrum(srgb, {0.3f, 0.2f, 0.1f})));
    EXPECT_EQ(m.eta, 1.4f);
    EXPECT_EQ(m.alpha, 0.2f);
    EXPECT_EQ(m.distribution, MicrofacetDistribution::beckmann);
    EXPECT_TRUE(m.nonlinear);
    EXPECT_EQ(m.internal_reflectance, 0.6f);
    EXPECT_EQ(test::world_error("Material \"plastic\" \"float eta\" 0.9"),
              "scene:2:20: parameter 'eta' is below 1");
    EXPECT_EQ(test::world_error("Material \"plastic\" \"spectrum eta\" \"glass-BK7\"").substr(0, 11),
              "scene:2:20:");
}

TEST(PbrtMaterials, Disney) {
    auto m = material<DisneyMaterial>("Material \"disney\"");
    EXPECT_EQ(m.of(m.base_color.value)(500), 0.5f);
    EXPECT_EQ(m.roughness.value, 0.5f);
    EXPECT_EQ(m.eta, 1.5f);
    for (const FloatParameter& p : {m.metallic, m.anisotropic, m.specular_tint, m.sheen, m.sheen_tint,
                                    m.flatness, m.clearcoat, m.clearcoat_gloss, m.specular_transmission})
        EXPECT_EQ(p.value, 0);
    m = material<DisneyMaterial>(
        "Material \"disney\" \"rgb basecolor\" [ 0.1 0.2 0.3 ] \"float metallic\" 0.1 \"float roughness\" "
        "0.2 "
        "\"float anisotropic\" 0.3 \"float eta\" 1.7 \"float speculartint\" 0.4 \"float sheen\" 0.5 \"float "
        "sheentint\" 0.6 \"float flatness\" 0.7 \"float clearcoat\" 0.8 \"float clearcoatgloss\" 0.9 \"float "
        "speculartransmission\" 0.15");
    expect_same_values(m.of(m.base_color.value),
                       Spectrum(RgbAlbedoSpectrum(RgbColorSpace::srgb(), {0.1f, 0.2f, 0.3f})));
    EXPECT_EQ(m.metallic.value, 0.1f);
    EXPECT_EQ(m.roughness.value, 0.2f);
    EXPECT_EQ(m.anisotropic.value, 0.3f);
    EXPECT_EQ(m.eta, 1.7f);
    EXPECT_EQ(m.specular_tint.value, 0.4f);
    EXPECT_EQ(m.sheen.value, 0.5f);
    EXPECT_EQ(m.sheen_tint.value, 0.6f);
    EXPECT_EQ(m.flatness.value, 0.7f);
    EXPECT_EQ(m.clearcoat.value, 0.8f);
    EXPECT_EQ(m.clearcoat_gloss.value, 0.9f);
    EXPECT_EQ(m.specular_transmission.value, 0.15f);
    const auto sheet = material<DisneyThinMaterial>(
        "Material \"disneythin\" \"float eta\" 1.3 \"float diffusetransmission\" 0.4 \"float "
        "speculartransmission\" 0.3");
    EXPECT_EQ(sheet.eta.value, 1.3f);
    EXPECT_EQ(sheet.diffuse_transmission.value, 0.4f);
    EXPECT_EQ(sheet.specular_transmission.value, 0.3f);
    EXPECT_EQ(sheet.roughness.value, 0.5f);
}

TEST(PbrtMaterials, DistributionsAndFactors) {
    const auto metal = material<ConductorMaterial>(
        "Material \"conductor\" \"string distribution\" \"ggx-separable\" \"spectrum specularreflectance\" "
        "[ 300 0.5 800 0.5 ]");
    EXPECT_EQ(metal.distribution, MicrofacetDistribution::ggx_separable);
    EXPECT_EQ(metal.of(metal.specular_reflectance.value)(500), 0.5f);
    const std::string both = "\"spectrum specularreflectance\" [ 300 0.5 800 0.5 ] \"spectrum "
                             "speculartransmittance\" [ 300 0.3 800 0.3 ]";
    const auto glass = material<DielectricMaterial>("Material \"dielectric\" \"string distribution\" "
                                                    "\"beckmann\" " +
                                                    both);
    EXPECT_EQ(glass.distribution, MicrofacetDistribution::beckmann);
    EXPECT_EQ(glass.of(glass.specular_reflectance.value)(500), 0.5f);
    EXPECT_EQ(glass.of(glass.specular_transmittance.value)(500), 0.3f);
    const auto pane = material<ThinDielectricMaterial>("Material \"thindielectric\" " + both);
    EXPECT_EQ(pane.of(pane.specular_reflectance.value)(500), 0.5f);
    EXPECT_EQ(pane.of(pane.specular_transmittance.value)(500), 0.3f);
    EXPECT_EQ(
        test::world_error("Material \"conductor\" \"string distribution\" \"beckman\""),
        "scene:2:22: parameter 'distribution' is 'beckman'; expected one of ggx, ggx-separable, beckmann "
        "(did you mean 'beckmann'?)");
}

TEST(PbrtMaterials, Sided) {
    const SceneDescription d = parse_world(R"(
        MakeNamedMaterial "sheet" "string type" "sided" "string front" "paint" "string back" "half"
        MakeNamedMaterial "half" "string type" "sided" "string back" "paint"
        MakeNamedMaterial "paint" "string type" "diffuse"
        NamedMaterial "sheet" Shape "sphere")");
    const std::vector<Material>& m = d.scene.materials;
    ASSERT_EQ(m.size(), 3u);
    const auto& sheet = std::get<SidedMaterial>(m[d.scene.shapes[0].material]);
    EXPECT_TRUE(std::holds_alternative<DiffuseMaterial>(m[sheet.front.index]));
    const auto& half = std::get<SidedMaterial>(m[sheet.back.index]);
    EXPECT_FALSE(half.front.is_given());
    EXPECT_EQ(half.back.index, sheet.front.index);
    EXPECT_EQ(test::world_error("MakeNamedMaterial \"a\" \"string type\" \"sided\"\n\"string back\" \"a\""),
              "scene:3:1: the material depends on itself");
    EXPECT_EQ(
        test::world_error("Material \"sided\" \"string front\" \"lost\" Shape \"sphere\"").substr(0, 11),
        "scene:2:18:");
}

// Parts of parts are visited once each: a long chain takes no time.
TEST(PbrtMaterials, InteriorsOfNestedMaterials) {
    std::string chain = "MakeNamedMaterial \"m0\" \"string type\" \"subsurface\"\n";
    for (int i = 1; i < 60; ++i) {
        const std::string part = "\"m" + std::to_string(i - 1) + "\"";
        chain += "MakeNamedMaterial \"m" + std::to_string(i) +
                 "\" \"string type\" \"sided\" \"string front\" " + part + " \"string back\" " + part + "\n";
    }
    const SceneDescription d = parse_world(chain + "NamedMaterial \"m59\" Shape \"sphere\"");
    EXPECT_EQ(d.scene.shapes.at(0).media.inside, 0u);
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

} // namespace
} // namespace montelux
