// Textures of Mitsuba scenes: pictures, checkerboards, attributes of meshes, and numbers where a texture may stand.
#include "test/formats/mitsuba/looks.h"
#include <gtest/gtest.h>

namespace montelux::mitsuba_textures_test {
namespace {

using mitsuba::SpectrumUse;
using test::expect_says;
using test::look_error;
using test::Looks;

// <bsdf> with a texture as its reflectance.
std::string surface(const std::string& texture) { return "<bsdf type=\"diffuse\">" + texture + "</bsdf>"; }
std::string bitmap_surface(const std::string& properties, const std::string& file = "four.pfm") {
    return surface("<texture type=\"bitmap\" name=\"reflectance\"><string name=\"filename\" value=\"" + file +
                   "\"/>" + properties + "</texture>");
}

SpectrumParameter reflectance(Looks& looks) {
    mitsuba::Plugin bsdf = looks.plugin("bsdf");
    return looks.textures.spectrum(bsdf, "reflectance", 0.5f, SpectrumUse::reflectance);
}
FloatParameter number(Looks& looks) {
    mitsuba::Plugin bsdf = looks.plugin("bsdf");
    return looks.textures.number(bsdf, "reflectance", 0.5f, mitsuba::unit_range);
}
std::string texture_error(const std::string& content) {
    return look_error(content, [](Looks& looks) { reflectance(looks); });
}

// The picture's top row is at v = 0.
TEST(MitsubaBitmap, HasItsTopRowAtZero) {
    Looks looks(bitmap_surface("<string name=\"filter_type\" value=\"nearest\"/>"));
    const SpectrumParameter p = reflectance(looks);
    looks.expect_albedo(p, {0.25f, 0.25f}, test::upper_left);
    looks.expect_albedo(p, {0.75f, 0.25f}, test::upper_right);
    looks.expect_albedo(p, {0.25f, 0.75f}, test::lower_left);
    looks.expect_albedo(p, {0.75f, 0.75f}, test::lower_right);
    EXPECT_TRUE(looks.warnings.messages().empty());
}

TEST(MitsubaBitmap, IsInterpolatedByDefault) {
    Looks looks(bitmap_surface(""));
    looks.expect_albedo(reflectance(looks), {0.5f, 0.25f}, 0.5f * (test::upper_left + test::upper_right));
}

TEST(MitsubaBitmap, WrapsAsItSays) {
    const std::string nearest = "<string name=\"filter_type\" value=\"nearest\"/>";
    const auto at = [&](const std::string& mode, Vec3f expected) {
        Looks looks(bitmap_surface(nearest + "<string name=\"wrap_mode\" value=\"" + mode + "\"/>"));
        looks.expect_albedo(reflectance(looks), {1.25f, 0.25f}, expected);
    };
    at("repeat", test::upper_left);
    at("mirror", test::upper_right);
    at("clamp", test::upper_right);
}

TEST(MitsubaBitmap, CoordinatesAreTransformed) {
    const auto at = [&](const std::string& transform, Point2f uv, Vec3f expected) {
        Looks looks(
            bitmap_surface("<string name=\"filter_type\" value=\"nearest\"/><transform name=\"to_uv\">" +
                           transform + "</transform>"));
        looks.expect_albedo(reflectance(looks), uv, expected);
    };
    at("<scale x=\"2\" y=\"2\"/>", {0.4f, 0.1f}, test::upper_right);
    at("<translate x=\"0.5\" y=\"0.5\"/>", {0.2f, 0.3f}, test::lower_right);
    // (u, v) = (0.8, 0.3) goes to (-0.3, 0.8).
    at("<rotate z=\"1\" angle=\"90\"/>", {0.8f, 0.3f}, test::lower_right);
    at("<rotate z=\"1\" angle=\"90\"/><scale x=\"-1\"/>", {0.8f, 0.3f}, test::lower_left);
}

TEST(MitsubaBitmap, EqualFilesAreReadOnce) {
    const std::string texture = "<texture type=\"bitmap\" name=\"reflectance\">"
                                "<string name=\"filename\" value=\"four.pfm\"/></texture>";
    Looks looks("<bsdf type=\"diffuse\">" + texture + "</bsdf><bsdf type=\"diffuse\">" + texture + "</bsdf>");
    std::vector<Index> images;
    for (std::size_t i = 0; i < looks.graph.objects.size(); ++i)
        if (looks.graph.objects[i].kind == "bsdf") {
            mitsuba::Plugin bsdf(looks.graph, i);
            images.push_back(
                looks.textures.spectrum(bsdf, "reflectance", 0.5f, SpectrumUse::reflectance).texture);
        }
    EXPECT_EQ(images.size(), 2u);
    EXPECT_EQ(looks.scene.images.size(), 1u);
    EXPECT_EQ(looks.files.files_read().size(), 1u);
}

// Files of one name in two folders are different pictures; two spellings of a path are the same one.
TEST(MitsubaBitmap, FoldersTellFilesApart) {
    const auto texture = [](const std::string& file) {
        return R"(<bsdf type="diffuse"><texture type="bitmap" name="reflectance">
            <string name="filename" value=")" +
               file + R"("/></texture></bsdf>)";
    };
    Looks looks(texture("a/p.pfm") + texture("b/p.pfm") + texture("b/./p.pfm"),
                {{"a/p.pfm", test::picture_file(1, {test::upper_left})},
                 {"b/p.pfm", test::picture_file(1, {test::lower_right})}});
    std::vector<SpectrumParameter> parameters;
    for (std::size_t i = 0; i < looks.graph.objects.size(); ++i)
        if (looks.graph.objects[i].kind == "bsdf") {
            mitsuba::Plugin bsdf(looks.graph, i);
            parameters.push_back(
                looks.textures.spectrum(bsdf, "reflectance", 0.5f, SpectrumUse::reflectance));
        }
    ASSERT_EQ(parameters.size(), 3u);
    looks.expect_albedo(parameters[0], {0.5f, 0.5f}, test::upper_left);
    looks.expect_albedo(parameters[1], {0.5f, 0.5f}, test::lower_right);
    looks.expect_albedo(parameters[2], {0.5f, 0.5f}, test::lower_right);
    EXPECT_EQ(looks.scene.images.size(), 2u);
}

std::vector<std::uint8_t> grey_bytes(std::uint8_t value) {
    const std::string header = "P5 2 2 255\n";
    std::vector<std::uint8_t> bytes(header.begin(), header.end());
    bytes.insert(bytes.end(), 4, value);
    return bytes;
}

TEST(MitsubaBitmap, RawOnesAreLinear) {
    const auto grey = [](const std::string& properties) {
        Looks looks(bitmap_surface(properties, "grey.pgm"), {{"grey.pgm", grey_bytes(128)}});
        return looks.value(number(looks), {0.5f, 0.5f});
    };
    EXPECT_NEAR(grey(""), srgb_to_linear(128.0f / 255), 1e-6);
    EXPECT_NEAR(grey("<boolean name=\"raw\" value=\"true\"/>"), 128.0f / 255, 1e-6);
}

TEST(MitsubaBitmap, AsNumbersAreLuminances) {
    Looks looks(bitmap_surface("<string name=\"filter_type\" value=\"nearest\"/>"));
    const Vec3d weights = RgbColorSpace::srgb().luminance_weights();
    EXPECT_NEAR(looks.value(number(looks), {0.25f, 0.25f}), dot(weights, Vec3d(test::upper_left)), 1e-6);
}

TEST(MitsubaBitmap, SaysWhatIsWrong) {
    expect_says(texture_error(surface("<texture type=\"bitmap\" name=\"reflectance\"/>")),
                "the texture 'bitmap' needs the property 'filename'");
    expect_says(texture_error(bitmap_surface("", "none.png")), "there is no file 'none.png'");
    expect_says(texture_error(bitmap_surface("<string name=\"wrap_mode\" value=\"black\"/>")),
                "'wrap_mode' is 'black'; expected one of repeat, mirror, clamp");
    expect_says(texture_error(bitmap_surface("<string name=\"format\" value=\"int\"/>")),
                "'format' is 'int'");
    expect_says(texture_error(bitmap_surface("<transform name=\"to_uv\"><scale x=\"0\"/></transform>")),
                "'to_uv' has no inverse");
    const std::string broken =
        look_error(bitmap_surface("", "x.png"), [](Looks& looks) { reflectance(looks); },
                   {{"x.png", {0x89, 'P', 'N', 'G', 13, 10, 26, 10, 0}}});
    expect_says(broken, "scene.xml:1:");
    expect_says(broken, "x.png");
    Looks looks(bitmap_surface("<float name=\"filtertype\" value=\"1\"/>"));
    reflectance(looks);
    ASSERT_EQ(looks.warnings.messages().size(), 1u);
    expect_says(looks.warnings.messages()[0], "did you mean 'filter_type'");
}

std::string checkerboard(const std::string& properties, const std::string& name = "reflectance") {
    return "<texture type=\"checkerboard\" name=\"" + name + "\">" + properties + "</texture>";
}

TEST(MitsubaCheckerboard, HasCellsOfAHalf) {
    Looks looks(surface(checkerboard("<rgb name=\"color0\" value=\"0.8 0.1 0.1\"/>")));
    const SpectrumParameter p = reflectance(looks);
    looks.expect_albedo(p, {0.2f, 0.3f}, {0.8f, 0.1f, 0.1f});
    looks.expect_albedo(p, {0.7f, 0.8f}, {0.8f, 0.1f, 0.1f});
    EXPECT_NEAR(looks.value(p, {0.7f, 0.3f})[0], 0.2f, 1e-6);
    EXPECT_NEAR(looks.value(p, {0.2f, 1.7f})[0], 0.2f, 1e-6);
    EXPECT_TRUE(
        std::get<CheckerboardTexture<SpectrumParameter>>(looks.scene.spectrum_textures.at(p.texture)).sharp);
}

// As in Mitsuba, whose functions for numbers and for spectra differ.
TEST(MitsubaCheckerboard, AsNumbersHasTheColorsExchanged) {
    Looks looks(
        surface(checkerboard("<float name=\"color0\" value=\"0.9\"/><float name=\"color1\" "
                             "value=\"0.3\"/><transform name=\"to_uv\"><scale x=\"2\"/></transform>")));
    const FloatParameter p = number(looks);
    EXPECT_FLOAT_EQ(looks.value(p, {0.1f, 0.3f}), 0.3f);
    EXPECT_FLOAT_EQ(looks.value(p, {0.3f, 0.3f}), 0.9f);
}

TEST(MitsubaCheckerboard, MayContainTextures) {
    Looks looks(surface(checkerboard(
        "<texture type=\"bitmap\" name=\"color0\"><string name=\"filename\" value=\"four.pfm\"/><string "
        "name=\"filter_type\" value=\"nearest\"/></texture>")));
    looks.expect_albedo(reflectance(looks), {0.2f, 0.3f}, test::upper_left);
}

TEST(MitsubaTextures, RefuseToBeEvaluatedTooOften) {
    std::string content = "<texture type=\"checkerboard\" id=\"t0\"/>";
    for (int i = 1; i < 15; ++i) {
        const std::string ref = "id=\"t" + std::to_string(i - 1) + "\"/>";
        content += "<texture type=\"checkerboard\" id=\"t" + std::to_string(i) + "\"><ref name=\"color0\" " +
                   ref + "<ref name=\"color1\" " + ref + "</texture>";
    }
    expect_says(texture_error(content + surface("<ref name=\"reflectance\" id=\"t14\"/>")),
                "would evaluate more than 4096 textures");
}

TEST(MitsubaTextures, ConstantsAreNumbersColorsAndSpectra) {
    const auto value = [](const std::string& property) {
        Looks looks(surface(property));
        return looks.value(number(looks));
    };
    EXPECT_FLOAT_EQ(value(""), 0.5f);
    EXPECT_FLOAT_EQ(value("<float name=\"reflectance\" value=\"0.3\"/>"), 0.3f);
    EXPECT_FLOAT_EQ(value("<integer name=\"reflectance\" value=\"1\"/>"), 1);
    EXPECT_FLOAT_EQ(value("<spectrum name=\"reflectance\" value=\"0.4\"/>"), 0.4f);
    EXPECT_NEAR(value("<spectrum name=\"reflectance\" value=\"300:0.2, 900:0.4\"/>"), 0.2983f, 1e-3);
    EXPECT_NEAR(value("<rgb name=\"reflectance\" value=\"0.6\"/>"), 0.6f, 1e-3);
    EXPECT_FLOAT_EQ(value("<texture type=\"uniform\" name=\"reflectance\"><float name=\"value\" "
                          "value=\"0.7\"/></texture>"),
                    0.7f);
    expect_says(look_error(surface("<float name=\"reflectance\" value=\"1.5\"/>"),
                           [](Looks& looks) { number(looks); }),
                "'reflectance' is 1.5; expected a number from 0 to 1");
    expect_says(look_error(surface("<string name=\"reflectance\" value=\"red\"/>"),
                           [](Looks& looks) { number(looks); }),
                "'reflectance' is a text");
    expect_says(texture_error(surface("<bsdf type=\"diffuse\" name=\"reflectance\"/>")),
                "'reflectance' is an object; expected a colour, a number or a spectrum");
}

TEST(MitsubaMeshAttribute, IsTheVertexColor) {
    const auto attribute = [](const std::string& name) {
        return surface(
            "<texture type=\"mesh_attribute\" name=\"reflectance\"><string name=\"name\" value=\"" + name +
            "\"/><float name=\"scale\" value=\"0.5\"/></texture>");
    };
    Looks looks(attribute("vertex_color"));
    const SpectrumParameter p = reflectance(looks);
    EXPECT_EQ(std::get<VertexColorTexture>(looks.scene.spectrum_textures.at(p.texture)).factor,
              (Vec3f{0.5f, 0.5f, 0.5f}));
    expect_says(texture_error(attribute("face_color")), "the attribute 'face_color' is not supported");
    expect_says(look_error(attribute("vertex_color"), [](Looks& l) { number(l); }),
                "only the reflectance by 'vertex_color' is");
}

TEST(MitsubaTextures, RefuseWhatIsNotRead) {
    expect_says(texture_error(surface("<texture type=\"volume\" name=\"reflectance\"/>")),
                "the texture 'volume' is not supported");
    expect_says(texture_error(surface("<texture type=\"bitmp\" name=\"reflectance\"/>")),
                "there is no texture 'bitmp' (did you mean 'bitmap'?)");
}

TEST(MitsubaNormalMap, IsAPictureOrAVector) {
    Looks looks(
        "<bsdf type=\"normalmap\"><texture type=\"rawconstant\" name=\"normalmap\"><vector name=\"value\" "
        "value=\"0.5 0.6 1\"/></texture></bsdf>");
    const Index map = looks.textures.pictures().normal_map(*looks.plugin("bsdf").object("normalmap"));
    const ImageTexture& texture = looks.scene.normal_maps.at(map);
    EXPECT_TRUE(texture.right_handed);
    EXPECT_FLOAT_EQ(looks.scene.images.at(texture.image).value(0, 0, 1), 0.6f);
}

} // namespace
} // namespace montelux::mitsuba_textures_test
