// BSDFs of Mitsuba scenes as materials.
#include "test/formats/mitsuba/material_text.h"
#include "test/scene/measured_brdf_testing.h"
#include <gtest/gtest.h>

#include "montelux/scene/material/conductor_material.h"
#include "montelux/scene/material/dielectric_material.h"
#include "montelux/scene/material/diffuse_material.h"
#include "montelux/scene/material/disney_material.h"
#include "montelux/scene/material/hair_material.h"
#include "montelux/scene/material/parameter_evaluator.h"
#include "montelux/scene/material/plastic_material.h"
#include "montelux/scene/material/sided_material.h"
#include "montelux/scene/material/thin_dielectric_material.h"

namespace montelux::mitsuba_materials_test {
namespace {

TEST(MitsubaDiffuse, HasAColorOrTexture) {
    One<DiffuseMaterial> standard(bsdf("diffuse"));
    EXPECT_TRUE(standard.one_sided);
    EXPECT_FLOAT_EQ(standard->reflectance.value.constant, 0.5f);
    One<DiffuseMaterial> red(bsdf("diffuse", rgb("reflectance", "0.8 0.1 0.1")));
    red.looks.expect_albedo(red->reflectance, {}, {0.8f, 0.1f, 0.1f});
    One<DiffuseMaterial> textured(bsdf("diffuse", four_colors("reflectance")));
    textured.looks.expect_albedo(textured->reflectance, {0.25f, 0.25f}, test::upper_left);
    expect_says(material_error(bsdf("diffuse", rgb("reflectance", "1.2 0 0"))),
                "a reflectance lies between 0 and 1");
    Looks odd(bsdf("diffuse", number("reflectence", "1")));
    odd.look();
    EXPECT_EQ(odd.warnings.messages().size(), 1u);
}

TEST(MitsubaDiffuse, IsTheStandardOfShapes) {
    Looks looks("");
    const mitsuba::SurfaceLook look = looks.materials.standard();
    EXPECT_EQ(looks.materials.standard().material, look.material);
    const Index front = looks.material<SidedMaterial>(look.material).front.index;
    EXPECT_FLOAT_EQ(looks.material<DiffuseMaterial>(front).reflectance.value.constant, 0.5f);
}

TEST(MitsubaConductor, IsAMirrorByDefault) {
    One<ConductorMaterial> m(bsdf("conductor"));
    EXPECT_TRUE(m.one_sided);
    EXPECT_EQ(m->metal.eta.value.constant, 0);
    EXPECT_EQ(m->metal.k.value.constant, 1);
    const SceneTables tables(m.looks.scene);
    SampledWavelengths lambda = m.looks.lambda;
    const ParameterEvaluator at(tables.view(), 0, {}, lambda);
    EXPECT_NEAR(at.conductor(m->metal, m->roughness, 1).albedo({0, 0, 1})[0], 1, 1e-6);
    EXPECT_NEAR(at.conductor(m->metal, m->roughness, 1).albedo({0.8f, 0, 0.6f})[0], 1, 1e-6);
}

TEST(MitsubaConductor, KnowsMaterialsByName) {
    const auto constants = [](const std::string& name, float lambda) {
        One<ConductorMaterial> m(bsdf("conductor", text("material", name)));
        return Vec2d(value_at(m.looks, m->metal.eta.value, lambda),
                     value_at(m.looks, m->metal.k.value, lambda));
    };
    EXPECT_NEAR(constants("Cu", 539.0617f).x, 1.04, 1e-5);
    EXPECT_NEAR(constants("Cu", 539.0617f).y, 2.583, 1e-5);
    EXPECT_EQ(constants("MgO_palik", 546.167f).x, double(1.74077f));
    EXPECT_EQ(constants("a-C", 563.55f), Vec2d(2.38f, 0.82f));
    EXPECT_EQ(constants("W_palik", 563.54f), constants("W", 563.54f));
    EXPECT_NE(constants("Cu_palik", 550), constants("Cu", 550));
    // Handbooks agree that it is a grey metal.
    for (const float lambda : {400.0f, 500.0f, 600.0f, 700.0f}) EXPECT_GT(constants("Cr", lambda).y, 2.5);
    EXPECT_EQ(constants("none", 500), Vec2d(0, 1));
    const std::string message = material_error(bsdf("conductor", text("material", "Cuu")));
    expect_says(message, "the conductor 'Cuu' is not known (did you mean 'Cu'?)");
    expect_says(message, "W");
    expect_says(material_error(bsdf("conductor", text("material", "Cu") + number("eta", "1"))),
                "'material' together with 'eta'");
}

TEST(MitsubaConductor, HasIndexAndFactor) {
    One<ConductorMaterial> m(bsdf("conductor", number("eta", "0.2") +
                                                   "<spectrum name=\"k\" value=\"400:3, 700:4\"/>" +
                                                   rgb("specular_reflectance", "0.9 0.5 0.4")));
    EXPECT_FLOAT_EQ(m->metal.eta.value.constant, 0.2f);
    EXPECT_NEAR(value_at(m.looks, m->metal.k.value, 550), 3.5, 1e-6);
    m.looks.expect_albedo(m->specular_reflectance, {}, {0.9f, 0.5f, 0.4f});
    EXPECT_EQ(m->roughness.u.value, 0);
}

TEST(MitsubaRoughConductor, HasDistributionsAndRoughness) {
    One<ConductorMaterial> standard(bsdf("roughconductor"));
    EXPECT_EQ(standard->distribution, MicrofacetDistribution::beckmann);
    EXPECT_FLOAT_EQ(standard->roughness.u.value, 0.1f);
    EXPECT_FLOAT_EQ(standard->roughness.v.value, 0.1f);
    EXPECT_FALSE(standard->roughness.remap);
    One<ConductorMaterial> m(bsdf("roughconductor", text("distribution", "GGX") + number("alpha_u", "0.3") +
                                                        four_colors("alpha_v") +
                                                        "<boolean name=\"sample_visible\" value=\"true\"/>"));
    EXPECT_EQ(m->distribution, MicrofacetDistribution::ggx_separable);
    EXPECT_FLOAT_EQ(m->roughness.u.value, 0.3f);
    EXPECT_FALSE(m->roughness.v.is_constant());
    expect_says(material_error(bsdf("roughconductor", text("distribution", "phong"))),
                "'distribution' is 'phong'; expected one of beckmann, ggx");
    expect_says(material_error(bsdf("roughconductor", number("alpha_u", "0.3"))),
                "expected both 'alpha_u' and 'alpha_v'");
    expect_says(material_error(bsdf("roughconductor", number("alpha_u", "0.3") + number("alpha_v", "0.3") +
                                                          number("alpha", "0.3"))),
                "'alpha' together with 'alpha_u'");
    expect_says(material_error(bsdf("roughconductor", number("alpha", "-1"))), "'alpha' is -1");
}

TEST(MitsubaDielectric, HasIndices) {
    One<DielectricMaterial> standard(bsdf("dielectric"));
    EXPECT_FALSE(standard.one_sided);
    EXPECT_FLOAT_EQ(standard->eta.constant, 1.5046f / 1.000277f);
    EXPECT_EQ(standard->roughness.u.value, 0);
    One<DielectricMaterial> m(bsdf("dielectric", text("int_ior", "Water") + number("ext_ior", "1.5") +
                                                     number("specular_transmittance", "0.5")));
    EXPECT_FLOAT_EQ(m->eta.constant, 1.333f / 1.5f);
    EXPECT_FLOAT_EQ(m->specular_transmittance.value.constant, 0.5f);
    EXPECT_FLOAT_EQ(m->specular_reflectance.value.constant, 1);
    expect_says(material_error(bsdf("dielectric", text("int_ior", "dimond"))),
                "the index of refraction of 'dimond' is not known (did you mean 'diamond'?)");
    expect_says(material_error(bsdf("dielectric", number("int_ior", "-1"))), "'int_ior' is -1");
}

TEST(MitsubaDielectric, MayBeRoughOrThin) {
    One<DielectricMaterial> rough(bsdf("roughdielectric", number("alpha", "0.2")));
    EXPECT_EQ(rough->distribution, MicrofacetDistribution::beckmann);
    EXPECT_FLOAT_EQ(rough->roughness.v.value, 0.2f);
    expect_says(material_error(bsdf("roughdielectric", number("int_ior", "1.3") + number("ext_ior", "1.3"))),
                "'int_ior' equals 'ext_ior'");
    One<ThinDielectricMaterial> thin(bsdf("thindielectric", text("int_ior", "bk7") +
                                                                text("ext_ior", "vacuum") +
                                                                rgb("specular_reflectance", "0.9 0.5 0.4")));
    EXPECT_FLOAT_EQ(thin->eta.constant, 1.5046f);
    thin.looks.expect_albedo(thin->specular_reflectance, {}, {0.9f, 0.5f, 0.4f});
}

TEST(MitsubaPlastic, HasABaseUnderAnInterface) {
    One<PlasticMaterial> smooth(bsdf("plastic", rgb("diffuse_reflectance", "0.1 0.3 0.4") +
                                                    number("int_ior", "1.9") +
                                                    "<boolean name=\"nonlinear\" value=\"true\"/>"));
    EXPECT_TRUE(smooth.one_sided);
    EXPECT_FLOAT_EQ(smooth->eta, 1.9f / 1.000277f);
    EXPECT_EQ(smooth->alpha, 0);
    EXPECT_TRUE(smooth->nonlinear);
    smooth.looks.expect_albedo(smooth->reflectance, {}, {0.1f, 0.3f, 0.4f});
    One<PlasticMaterial> rough(bsdf("roughplastic", text("distribution", "ggx") + number("alpha", "0.3")));
    EXPECT_FLOAT_EQ(rough->eta, 1.49f / 1.000277f);
    EXPECT_FLOAT_EQ(rough->alpha, 0.3f);
    EXPECT_FALSE(rough->nonlinear);
    EXPECT_EQ(rough->distribution, MicrofacetDistribution::ggx_separable);
    expect_says(material_error(bsdf("plastic", number("int_ior", "1") + number("ext_ior", "1.5"))),
                "'int_ior' is below 'ext_ior', which is not supported for plastic");
}

TEST(MitsubaMeasured, ReadsEachFileOnce) {
    const std::vector<std::uint8_t> file =
        testing::measured_brdf_file(testing::measured_ggx({{0.5f, 0.5f}}, 8)).bytes();
    Looks looks(bsdf("measured", text("filename", "a.bsdf")) + bsdf("measured", text("filename", "a.bsdf")),
                {{"a.bsdf", file}});
    for (std::size_t i = 0; i < looks.graph.objects.size(); ++i)
        if (looks.graph.objects[i].kind == "bsdf") looks.materials.of({looks.graph, i});
    EXPECT_EQ(looks.scene.measured_brdfs.size(), 1u);
    const std::string message = look_error(bsdf("measured", text("filename", "a.bsdf")),
                                           [](Looks& l) { l.look(); }, {{"a.bsdf", {1, 2}}});
    expect_says(message, "scene.xml:1:");
    expect_says(message, "a.bsdf: is no file of a measured BRDF");
}

TEST(MitsubaHair, HasPigmentsOrAbsorption) {
    One<HairMaterial> m(bsdf("hair", number("eumelanin", "0.2") + number("pheomelanin", "0.4") +
                                         number("longitudinal_roughness", "0.1") +
                                         number("scale_tilt", "3")));
    EXPECT_FALSE(m.one_sided);
    EXPECT_EQ(m->color.source, HairColorParameter::melanins);
    EXPECT_FLOAT_EQ(m->color.eumelanin.value, 0.2f);
    EXPECT_FLOAT_EQ(m->color.pheomelanin.value, 0.4f);
    EXPECT_FLOAT_EQ(m->eta.value, 1.55f / 1.000277f);
    EXPECT_FLOAT_EQ(m->beta_m.value, 0.1f);
    EXPECT_FLOAT_EQ(m->beta_n.value, 0.3f);
    EXPECT_FLOAT_EQ(m->alpha.value, 3);
    One<HairMaterial> standard(bsdf("hair"));
    EXPECT_FLOAT_EQ(standard->color.pheomelanin.value, 0.2f);
    One<HairMaterial> absorbing(bsdf("hair", number("sigma_a", "0.25") + number("scale", "8")));
    EXPECT_EQ(absorbing->color.source, HairColorParameter::absorption);
    EXPECT_FLOAT_EQ(absorbing.looks.value(absorbing->color.sigma_a)[0], 2);
    expect_says(material_error(bsdf("hair", number("sigma_a", "1") + number("eumelanin", "1"))),
                "'sigma_a' together with pigments");
}

TEST(MitsubaPrincipled, HasDisneysParameters) {
    One<DisneyMaterial> m(bsdf("principled", rgb("base_color", "0.2 0.8 0.1") + number("roughness", "0.15") +
                                                 number("metallic", "0.7") + number("specular", "0.6") +
                                                 number("anisotropic", "0.5") + number("spec_tint", "0.4") +
                                                 number("sheen", "0.3") + number("sheen_tint", "0.2") +
                                                 number("flatness", "0.1") + number("clearcoat", "0.6") +
                                                 number("clearcoat_gloss", "0.35") +
                                                 number("main_specular_sampling_rate", "2")));
    EXPECT_TRUE(m.one_sided);
    m.looks.expect_albedo(m->base_color, {}, {0.2f, 0.8f, 0.1f});
    EXPECT_FLOAT_EQ(m->roughness.value, 0.15f);
    EXPECT_FLOAT_EQ(m->metallic.value, 0.7f);
    EXPECT_FLOAT_EQ(m->anisotropic.value, 0.5f);
    EXPECT_FLOAT_EQ(m->specular_tint.value, 0.4f);
    EXPECT_FLOAT_EQ(m->sheen.value, 0.3f);
    EXPECT_FLOAT_EQ(m->sheen_tint.value, 0.2f);
    EXPECT_FLOAT_EQ(m->flatness.value, 0.1f);
    EXPECT_FLOAT_EQ(m->clearcoat.value, 0.6f);
    EXPECT_FLOAT_EQ(m->clearcoat_gloss.value, 0.35f);
    EXPECT_FLOAT_EQ(m->specular_transmission.value, 0);
    const double f0 = (m->eta - 1) / (m->eta + 1);
    EXPECT_NEAR(f0 * f0, 0.08 * 0.6, 1e-6);
}

TEST(MitsubaPrincipled, HasTwoSidesWhereItTransmits) {
    One<DisneyMaterial> m(bsdf("principled", number("spec_trans", "0.4") + number("eta", "1")));
    EXPECT_FALSE(m.one_sided);
    EXPECT_FLOAT_EQ(m->eta, 1.001f);
    EXPECT_FLOAT_EQ(m->specular_transmission.value, 0.4f);
    EXPECT_FALSE(One<DisneyMaterial>(bsdf("principled", four_colors("spec_trans"))).one_sided);
    EXPECT_TRUE(One<DisneyMaterial>(bsdf("principled", number("spec_trans", "0"))).one_sided);
    expect_says(material_error(bsdf("principled", number("eta", "1.5") + number("specular", "0.5"))),
                "'eta' together with 'specular'");
    expect_says(material_error(bsdf("principled", number("metallic", "2"))), "'metallic' is 2;");
}

TEST(MitsubaPrincipledThin, SharesItsDiffuseLight) {
    One<DisneyThinMaterial> m(bsdf("principledthin", number("diff_trans", "1.4") + number("eta", "1.33") +
                                                         number("spec_trans", "0.8")));
    EXPECT_FALSE(m.one_sided);
    EXPECT_FLOAT_EQ(m->diffuse_transmission.value, 0.7f);
    EXPECT_FLOAT_EQ(m->eta.value, 1.33f);
    EXPECT_FLOAT_EQ(m->specular_transmission.value, 0.8f);
    One<DisneyThinMaterial> textured(bsdf("principledthin", four_colors("diff_trans")));
    const double luminance = dot(RgbColorSpace::srgb().luminance_weights(), Vec3d(test::upper_left));
    EXPECT_NEAR(textured.looks.value(textured->diffuse_transmission, {0.25f, 0.25f}), 0.5 * luminance, 1e-6);
}

// A file may refer to the same object exponentially often.
TEST(MitsubaMaterials, AreMadeOnce) {
    std::string content = "<bsdf type=\"diffuse\" id=\"b0\"/>";
    for (int i = 1; i <= 60; ++i) {
        const std::string ref = "<ref id=\"b" + std::to_string(i - 1) + "\"/>";
        content += "<bsdf type=\"blendbsdf\" id=\"b" + std::to_string(i) + "\">" + number("weight", "0.5") +
                   ref + ref + "</bsdf>";
    }
    Looks looks(content);
    for (std::size_t i = 0; i < looks.graph.objects.size(); ++i)
        if (looks.graph.objects[i].id == "b60") looks.materials.of({looks.graph, i});
    EXPECT_EQ(looks.scene.materials.size(), 62u);
}

TEST(MitsubaMaterials, RefuseWhatIsNotRead) {
    expect_says(material_error(bsdf("polarizer")),
                "the bsdf 'polarizer' is not supported: the polarization of light");
    expect_says(material_error(bsdf("roughplastc")),
                "there is no bsdf 'roughplastc' (did you mean 'roughplastic'?)");
}

} // namespace
} // namespace montelux::mitsuba_materials_test
