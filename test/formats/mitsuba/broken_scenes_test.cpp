// Broken Mitsuba scenes: each has its sentence, with file, line and column.
#include "test/formats/mitsuba/scene_text.h"
#include <gtest/gtest.h>

namespace montelux {
namespace {

using test::graph_error;
using test::mitsuba_scene;

struct BrokenScene {
    std::string text, message;
};

void expect_sentences(const std::vector<BrokenScene>& cases) {
    for (const BrokenScene& c : cases) EXPECT_EQ(graph_error(c.text), c.message) << c.text.substr(0, 500);
}

TEST(MitsubaErrors, Xml) {
    expect_sentences({
        {"", "scene.xml:1:1: this is not XML: no element found"},
        {"<scene version=\"3.0.0\">", "scene.xml:1:24: this is not XML: no element found"},
        {"<scene version=\"3.0.0\">\n<shape></scene>", "scene.xml:2:1: <shape> needs the attribute 'type'"},
        {"<scene version=\"3.0.0\">\n</shape>", "scene.xml:2:3: this is not XML: mismatched tag"},
        {"<scene version=3.0.0/>", "scene.xml:1:16: this is not XML: not well-formed (invalid token)"},
        {"<scene version=\"3.0.0\"/><scene/>",
         "scene.xml:1:25: this is not XML: junk after document element"},
        {"<!DOCTYPE s [<!ENTITY a \"aaaa\">]><scene version=\"3.0.0\">&a;</scene>",
         "scene.xml:1:25: entities are not read: write what they stand for"},
        {"<!DOCTYPE s [<!ENTITY a SYSTEM \"/etc/passwd\">]><scene version=\"3.0.0\">&a;</scene>",
         "scene.xml:1:45: entities are not read: write what they stand for"},
        {mitsuba_scene("&nothing;"), "scene.xml:1:24: this is not XML: undefined entity"},
        {std::string("<scene version=\"3.0.0\">\0</scene>", 32),
         "scene.xml:1:24: this is not XML: not well-formed (invalid token)"},
    });
}

TEST(MitsubaErrors, NestingIsLimited) {
    std::string deep;
    for (int i = 0; i < 100000; ++i) deep += "<bsdf type=\"twosided\">";
    EXPECT_EQ(graph_error(mitsuba_scene(deep)), "scene.xml:1:2202: elements are nested deeper than 100");
    std::string chain;
    for (int i = 0; i < 5000; ++i)
        chain += "<bsdf type=\"twosided\" id=\"b" + std::to_string(i) + "\"><ref id=\"b" +
                 std::to_string(i + 1) + "\"/></bsdf>";
    chain += "<bsdf type=\"diffuse\" id=\"b5000\"/>";
    EXPECT_NE(graph_error(mitsuba_scene(chain)).find("more than 100 levels deep"), std::string::npos);
}

TEST(MitsubaErrors, Elements) {
    expect_sentences({
        {"<shape version=\"3.0.0\" type=\"sphere\"/>",
         "scene.xml:1:1: the outermost element is <shape>; expected <scene>"},
        {"<scene/>", "scene.xml:1:1: <scene> needs the attribute 'version' (such as 3.0.0)"},
        {"<scene version=\"three\"/>", "scene.xml:1:1: the version is 'three'; expected one such as 3.0.0"},
        {"<scene version=\"3.0.0.0\"/>",
         "scene.xml:1:1: the version is '3.0.0.0'; expected one such as 3.0.0"},
        {"<scene version=\"4.0.0\"/>",
         "scene.xml:1:1: version '4.0.0' of Mitsuba's format; versions up to 3 are read"},
        {"<scene version=\"-1\"/>", "scene.xml:1:1: the version is '-1'; expected one such as 3.0.0"},
        {mitsuba_scene("<shap type=\"sphere\"/>"),
         "scene.xml:1:24: <shap> is no element of Mitsuba 3 (did you mean 'shape'?)"},
        {mitsuba_scene("<shape/>"), "scene.xml:1:24: <shape> needs the attribute 'type'"},
        {mitsuba_scene("<shape type=\"cube\" nam=\"a\"/>"),
         "scene.xml:1:24: <shape> has no attribute 'nam' (did you mean 'name'?)"},
        {mitsuba_scene("<scene type=\"scene\"/>"), "scene.xml:1:24: a scene within a scene"},
        {mitsuba_scene("<translate x=\"1\"/>"), "scene.xml:1:24: <translate> stands in a <transform>"},
        {mitsuba_scene("<float name=\"a\" value=\"1\"><float name=\"b\" value=\"1\"/></float>"),
         "scene.xml:1:50: <float> cannot stand in an element that has a value"},
        {mitsuba_scene("<transform name=\"t\"><float name=\"b\" value=\"1\"/></transform>"),
         "scene.xml:1:44: <float> in a transformation; expected translate, rotate, scale, lookat or matrix"},
    });
}

TEST(MitsubaErrors, Values) {
    const auto at = [](const std::string& sentence) { return "scene.xml:1:24: " + sentence; };
    expect_sentences({
        {mitsuba_scene("<float value=\"1\"/>"), at("<float> needs the attribute 'name'")},
        {mitsuba_scene("<float name=\"a\"/>"), at("<float> needs the attribute 'value'")},
        {mitsuba_scene("<float name=\"a\" value=\"one\"/>"), at("'a' is 'one'; expected a number")},
        {mitsuba_scene("<float name=\"a\" value=\"\"/>"), at("'a' is ''; expected a number")},
        {mitsuba_scene("<float name=\"a\" value=\"1 2\"/>"), at("'a' is '1 2'; expected a number")},
        {mitsuba_scene("<float name=\"a\" value=\"nan\"/>"), at("'a' is 'nan'; expected a number")},
        {mitsuba_scene("<float name=\"a\" value=\"1e999\"/>"), at("'a' is '1e999', which is too large")},
        {mitsuba_scene("<integer name=\"a\" value=\"1.5\"/>"), at("'a' is '1.5'; expected an integer")},
        {mitsuba_scene("<integer name=\"a\" value=\"1e30\"/>"), at("'a' is '1e30'; expected an integer")},
        {mitsuba_scene("<boolean name=\"a\" value=\"yes\"/>"), at("'a' is 'yes'; expected true or false")},
        {mitsuba_scene("<rgb name=\"a\" value=\"1 2\"/>"),
         at("the colour has 2 numbers; expected 3, or 1 for all")},
        {mitsuba_scene("<rgb name=\"a\" value=\"#12345g\"/>"),
         at("the colour is '#12345g'; expected '#' and six hexadecimal digits")},
        {mitsuba_scene("<rgb name=\"a\" value=\"#123\"/>"),
         at("the colour is '#123'; expected '#' and six hexadecimal digits")},
        {mitsuba_scene("<point name=\"a\" x=\"1\" value=\"1 2 3\"/>"),
         at("'value' cannot stand beside x, y and z")},
        {mitsuba_scene("<point name=\"a\" w=\"1\"/>"),
         at("unexpected attribute 'w'; expected x, y and z, or value")},
        {mitsuba_scene("<point x=\"1\"/>"), at("<point> needs the attribute 'name'")},
        {mitsuba_scene("<spectrum name=\"a\"/>"),
         at("<spectrum> has either the attribute 'value' or 'filename'")},
        {mitsuba_scene("<spectrum name=\"a\" value=\"400:1 300:2\"/>"),
         at("the wavelengths of a spectrum must ascend")},
        {mitsuba_scene("<spectrum name=\"a\" value=\"400:1 500\"/>"),
         at("a spectrum with '500'; expected pairs such as 500:0.3")},
        {mitsuba_scene("<spectrum name=\"a\" value=\"400:\"/>"),
         at("a value of the spectrum is ''; expected a number")},
        {mitsuba_scene("<spectrum name=\"a\" filename=\"no.spd\"/>"), at("there is no file 'no.spd'")},
        {mitsuba_scene("<float name=\"a\" value=\"1\"/><float name=\"a\" value=\"1\"/>"),
         "scene.xml:1:51: the property 'a' is already given at scene.xml:1:24"},
    });
}

TEST(MitsubaErrors, Transformations) {
    const auto within = [](const std::string& operation) {
        return mitsuba_scene("<transform name=\"t\">" + operation + "</transform>");
    };
    const auto at = [](const std::string& sentence) { return "scene.xml:1:44: " + sentence; };
    expect_sentences({
        {mitsuba_scene("<transform/>"), "scene.xml:1:24: <transform> needs the attribute 'name'"},
        {within("<rotate x=\"1\"/>"), at("<rotate> needs the attribute angle")},
        {within("<rotate angle=\"10\"/>"), at("the axis of a rotation is zero")},
        {within("<matrix value=\"1 2 3\"/>"), at("a matrix of 3 numbers; expected 9 or 16")},
        {within("<matrix values=\"1\"/>"), at("<matrix> has one attribute: value")},
        {within("<scale value=\"1 2\"/>"),
         at("the attribute 'value' has 2 numbers; expected 3, or 1 for all")},
        {within("<lookat target=\"0 0 1\"/>"), at("<lookat> needs the attributes origin and target")},
        {within("<lookat origin=\"0 0 1\" target=\"0 0 1\"/>"),
         at("<lookat> is undefined: origin and target are the same, or the line between them is along 'up'")},
        {within("<lookat origin=\"0 0 0\" target=\"0 2 0\" up=\"0 1 0\"/>"),
         at("<lookat> is undefined: origin and target are the same, or the line between them is along 'up'")},
        {within("<lookat origin=\"0 0 0\" targt=\"0 2 0\"/>"),
         at("<lookat> has no attribute 'targt'; expected origin, target and up")},
    });
    test::LoadedGraph flat(within("<scale value=\"0\"/>"));
    EXPECT_THROW(mitsuba::Plugin(flat.graph, 0).transform("t"), Error);
}

TEST(MitsubaErrors, Parameters) {
    expect_sentences({
        {mitsuba_scene("<integer name=\"a\" value=\"$spp\"/>"),
         "scene.xml:1:24: the parameter '$spp' has no value; give one with -D spp=VALUE"},
        {mitsuba_scene("<default name=\"spp\" value=\"1\"/><integer name=\"a\" value=\"$sqp\"/>"),
         "scene.xml:1:55: the parameter '$sqp' has no value (did you mean 'spp'?); give one with -D "
         "sqp=VALUE"},
        {mitsuba_scene("<default name=\"\" value=\"1\"/>"), "scene.xml:1:24: a parameter without a name"},
    });
    // Each doubles the one before.
    std::string bomb = "<default name=\"a0\" value=\"0123456789\"/>";
    for (int i = 1; i < 64; ++i)
        bomb += "<default name=\"a" + std::to_string(i) + "\" value=\"$a" + std::to_string(i - 1) + "$a" +
                std::to_string(i - 1) + "\"/>";
    EXPECT_NE(graph_error(mitsuba_scene(bomb)).find("longer than a mebibyte"), std::string::npos);
}

TEST(MitsubaErrors, ReferencesAndIncludes) {
    expect_sentences({
        {mitsuba_scene("<bsdf type=\"diffuse\" id=\"red\"/><ref id=\"rad\"/>"),
         "scene.xml:1:55: there is no object 'rad' (did you mean 'red'?)"},
        {mitsuba_scene("<bsdf type=\"twosided\" id=\"a\"><ref id=\"a\"/></bsdf>"),
         "scene.xml:1:53: references form a circle through 'a'"},
        {mitsuba_scene("<bsdf type=\"twosided\" id=\"a\"><ref id=\"b\"/></bsdf>"
                       "<bsdf type=\"twosided\" id=\"b\"><ref id=\"a\"/></bsdf>"),
         "scene.xml:1:102: references form a circle through 'a'"},
        {mitsuba_scene("<bsdf type=\"diffuse\" id=\"a\"/><bsdf type=\"diffuse\" id=\"a\"/>"),
         "scene.xml:1:53: the id 'a' is already used at scene.xml:1:24"},
        {mitsuba_scene("<alias id=\"a\" as=\"b\"/>"),
         "scene.xml:1:24: there is no object 'a' before this alias"},
        {mitsuba_scene("<include filename=\"none.xml\"/>"), "scene.xml:1:24: there is no file 'none.xml'"},
        {mitsuba_scene("<include filename=\"\"/>"), "scene.xml:1:24: an empty file name"},
    });
    EXPECT_EQ(graph_error(mitsuba_scene("<include filename=\"a.xml\"/>"),
                          {{"a.xml", "<scene version=\"3.0.0\"><include filename=\"a.xml\"/></scene>"}}),
              "a.xml:1:24: files include one another 15 levels deep; does one include itself?");
    EXPECT_EQ(
        graph_error(mitsuba_scene("<include filename=\"a.xml\"/>"), {{"a.xml", "<float version=\"3\"/>"}}),
        "a.xml:1:1: <float> cannot be included");
    // Each file includes the next one twice.
    std::map<std::string, std::string> files;
    for (int i = 0; i < 14; ++i) {
        std::string twelve;
        for (int k = 0; k < 12; ++k) twelve += "<include filename=\"" + std::to_string(i + 1) + ".xml\"/>";
        files[std::to_string(i) + ".xml"] = mitsuba_scene(i < 13 ? twelve : "");
    }
    EXPECT_NE(
        graph_error(mitsuba_scene("<include filename=\"0.xml\"/>"), files).find("more than 10000 files"),
        std::string::npos);
}

} // namespace
} // namespace montelux
