// pbrt's subsurface materials: the media of their interiors.
#include "test/formats/pbrt/parse.h"
#include "test/formats/pbrt/same_spectrum.h"
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "montelux/scene/medium/semi_infinite_albedo.h"
#include "montelux/spectrum/rgb_colorspace.h"

namespace montelux {
namespace {

using test::expect_same_values;
using test::parse_world;
using test::WithSpectra;

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
    expect_same_values(m.of(m.sigma_a), Spectrum(RgbUnboundedSpectrum(srgb, {0.0011f, 0.0024f, 0.014f})));
    expect_same_values(m.of(m.sigma_s), Spectrum(RgbUnboundedSpectrum(srgb, {2.55f, 3.21f, 3.77f})));
    EXPECT_EQ(m.scale, 2);
    EXPECT_EQ(std::get<HenyeyGreenstein>(m.phase).g, 0.3f);
    EXPECT_TRUE(m.is_body);
    m = body("\"rgb sigma_a\" [ 1 2 3 ] \"spectrum sigma_s\" [ 400 1 600 3 ]");
    expect_same_values(m.of(m.sigma_a), Spectrum(RgbUnboundedSpectrum(srgb, {1, 2, 3})));
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
    expect_same_values(m.of(m.sigma_s), Spectrum(RgbUnboundedSpectrum(srgb, {0.70f, 1.22f, 1.90f})));
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
              "scene:4:47: the material's parts have two interiors ('subsurface'); expected one");
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

} // namespace
} // namespace montelux
