// Parameters of one name given several times: in a directive, and as defaults of an Attribute.
#include "test/formats/pbrt/parse.h"
#include <gtest/gtest.h>
#include <string>

#include "montelux/spectrum/named_spectra.h"

namespace montelux {
namespace {

using test::error_of;
using test::parse_world;
using test::world_error;

const DiffuseMaterial& diffuse_of(const SceneDescription& d) {
    return std::get<DiffuseMaterial>(d.scene.materials.at(d.scene.shapes.at(0).material));
}

const std::string with_light = "LightSource \"point\"\n";
const std::string green_texture = "Texture \"t\" \"spectrum\" \"constant\" \"rgb value\" [0 1 0]\n";
const std::string half_texture = "Texture \"a\" \"float\" \"constant\" \"float value\" 0.5\n";

// Own parameters win over defaults, whatever the types.
TEST(PbrtParameters, OwnOnesWinOverDefaultsOfAnotherType) {
    SceneDescription d =
        parse_world(green_texture + "Attribute \"material\" \"texture reflectance\" \"t\" "
                                    "Material \"diffuse\" \"rgb reflectance\" [1 0 0] Shape \"sphere\"");
    EXPECT_TRUE(diffuse_of(d).reflectance.is_constant());
    EXPECT_GT(spectrum_of(diffuse_of(d).reflectance.value, d.scene.spectra)(650), 0.5f);
    EXPECT_LT(spectrum_of(diffuse_of(d).reflectance.value, d.scene.spectra)(530), 0.5f);
    d = parse_world(green_texture + "Attribute \"material\" \"rgb reflectance\" [1 0 0] "
                                    "Material \"diffuse\" \"texture reflectance\" \"t\" Shape \"sphere\"");
    EXPECT_FALSE(diffuse_of(d).reflectance.is_constant());
}

TEST(PbrtParameters, OwnOnesOfAWrongTypeAreErrors) {
    EXPECT_EQ(world_error("Attribute \"shape\" \"float radius\" 3\nShape \"sphere\" \"integer radius\" 5"),
              "scene:3:16: parameter 'radius' has type integer; expected float");
    EXPECT_EQ(error_of("Camera \"perspective\" \"float fov\" 40 \"integer fov\" 50 WorldBegin"),
              "scene:1:37: parameter 'fov' has type integer; expected float");
    EXPECT_EQ(error_of("Camera \"perspective\" \"integer fov\" 50 \"float fov\" 40 WorldBegin"),
              "scene:1:22: parameter 'fov' has type integer; expected float");
}

TEST(PbrtParameters, OfSeveralTypesInOneDirectiveTheLastCounts) {
    Warnings warnings;
    const std::string texture = "\"texture reflectance\" \"t\" ", rgb = "\"rgb reflectance\" [1 0 0] ";
    SceneDescription d = parse_world(
        with_light + green_texture + "Material \"diffuse\" " + texture + rgb + "Shape \"sphere\"", &warnings);
    EXPECT_TRUE(diffuse_of(d).reflectance.is_constant());
    EXPECT_EQ(warnings.messages(),
              (std::vector<std::string>{
                  "scene:4:46: parameter 'reflectance' is given as texture and as rgb; the last one counts",
                  "scene:3:1: texture 't' is not used and was not read"}));
    Warnings other;
    d = parse_world(with_light + green_texture + "Material \"diffuse\" " + rgb + texture + "Shape \"sphere\"",
                    &other);
    EXPECT_FALSE(diffuse_of(d).reflectance.is_constant());
    EXPECT_EQ(
        other.messages(),
        (std::vector<std::string>{
            "scene:4:46: parameter 'reflectance' is given as rgb and as texture; the last one counts"}));
}

// Plugins use different types, so a default may be given once for each.
TEST(PbrtParameters, OfSeveralDefaultsTheLastThatFitsCounts) {
    const std::string number = "\"float eta\" 2 ", spectrum = "\"spectrum eta\" \"glass-BK7\" ";
    auto eta_of_glass = [](const std::string& defaults) {
        SceneDescription d =
            parse_world("Attribute \"material\" " + defaults + "Material \"dielectric\" Shape \"sphere\"");
        return spectrum_of(std::get<DielectricMaterial>(d.scene.materials.at(0)).eta, d.scene.spectra)(500);
    };
    EXPECT_EQ(eta_of_glass(spectrum + number), 2);
    EXPECT_EQ(eta_of_glass(number + spectrum), (*find_named_spectrum("glass-BK7"))(500));
    EXPECT_EQ(
        eta_of_glass(number + "Attribute \"material\" " + spectrum + "Attribute \"material\" " + number), 2);
    Warnings warnings;
    SceneDescription d = parse_world(with_light + "Attribute \"material\" " + spectrum + number +
                                         "Material \"conductor\" Shape \"sphere\"",
                                     &warnings);
    const SceneSpectrum eta = std::get<ConductorMaterial>(d.scene.materials.at(0)).metal.eta.value;
    EXPECT_EQ(spectrum_of(eta, d.scene.spectra)(500), (*find_named_spectrum("glass-BK7"))(500));
    EXPECT_TRUE(warnings.messages().empty());
}

TEST(PbrtParameters, AlphaAsNumberOrTexture) {
    auto alpha = [](const std::string& text, Warnings* warnings = nullptr) {
        return parse_world(with_light + half_texture + text, warnings).scene.shapes.at(0).alpha;
    };
    EXPECT_FALSE(alpha("Shape \"sphere\" \"texture alpha\" \"a\"").is_constant());
    EXPECT_EQ(alpha("Shape \"sphere\" \"float alpha\" 0.25").value, 0.25f);
    EXPECT_FALSE(alpha("Attribute \"shape\" \"texture alpha\" \"a\" Shape \"sphere\"").is_constant());
    EXPECT_FALSE(alpha("Attribute \"shape\" \"float alpha\" 0.25 Shape \"sphere\" \"texture alpha\" \"a\"")
                     .is_constant());
    FloatParameter number =
        alpha("Attribute \"shape\" \"texture alpha\" \"a\" Shape \"sphere\" \"float alpha\" 0.25");
    EXPECT_TRUE(number.is_constant());
    EXPECT_EQ(number.value, 0.25f);
    Warnings warnings;
    number = alpha("Shape \"sphere\" \"texture alpha\" \"a\" \"float alpha\" 0.25", &warnings);
    EXPECT_TRUE(number.is_constant());
    EXPECT_EQ(number.value, 0.25f);
    EXPECT_EQ(warnings.messages(),
              (std::vector<std::string>{
                  "scene:4:36: parameter 'alpha' is given as texture and as float; the last one counts",
                  "scene:3:1: texture 'a' is not used and was not read"}));
    EXPECT_FALSE(alpha("Shape \"sphere\" \"float alpha\" 0.25 \"texture alpha\" \"a\"").is_constant());
    EXPECT_EQ(world_error("Shape \"sphere\" \"float alpha\" [1 2]"),
              "scene:2:16: parameter 'alpha' has 2 values; expected 1");
    EXPECT_EQ(world_error("LightSource \"sky\" \"float groundalbedo\" []"),
              "scene:2:19: parameter 'groundalbedo' has 0 values; expected 1");
    EXPECT_EQ(world_error("LightSource \"sky\" \"rgb groundalbedo\" [1 1 1] \"float groundalbedo\" 0.5"), "");
}

} // namespace
} // namespace montelux
