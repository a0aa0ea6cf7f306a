// The XML of Mitsuba scenes as a graph: values, transformations, parameters, includes, references, old versions.
#include "test/formats/mitsuba/scene_text.h"
#include <gtest/gtest.h>

#include "montelux/formats/mitsuba/scene_graph.h"

namespace montelux {
namespace {

using mitsuba::Plugin;
using test::LoadedGraph;
using test::mitsuba_scene;

TEST(MitsubaGraph, ReadsValuesOfEveryType) {
    const LoadedGraph loaded(mitsuba_scene(R"(
        <shape type="sphere" id="ball">
            <float name="f" value=" 1.5e1 "/> <integer name="i" value="-3"/> <boolean name="b" value="True"/>
            <string name="s" value="a &amp; b"/> <point name="p" x="1" z="3"/> <vector name="v" value="1, 2 3"/>
            <rgb name="grey" value="0.25"/> <rgb name="red" value="#ff0000"/>
            <spectrum name="flat" value="0.5"/> <spectrum name="steps" value="400:0.1, 500:0.2"/>
        </shape>)"));
    Plugin shape = loaded.plugin("shape");
    EXPECT_EQ(shape.type(), "sphere");
    EXPECT_EQ(shape.id(), "ball");
    EXPECT_EQ(shape.number("f", 0), 15);
    EXPECT_EQ(shape.number("i", 0), -3);
    EXPECT_EQ(shape.integer("i", 0), -3);
    EXPECT_TRUE(shape.flag("b", false));
    EXPECT_EQ(shape.text("s", ""), "a & b");
    EXPECT_EQ(shape.vector("p", {}), (Vec3d{1, 0, 3}));
    EXPECT_EQ(shape.vector("v", {}), (Vec3d{1, 2, 3}));
    EXPECT_EQ(std::get<mitsuba::RgbValue>(shape.find("grey")->value).rgb, (Vec3d{0.25, 0.25, 0.25}));
    EXPECT_EQ(std::get<mitsuba::RgbValue>(shape.find("red")->value).rgb, (Vec3d{1, 0, 0}));
    EXPECT_EQ(std::get<mitsuba::SpectrumValue>(shape.find("flat")->value).values, std::vector{0.5});
    const auto& steps = std::get<mitsuba::SpectrumValue>(shape.find("steps")->value);
    EXPECT_EQ(steps.wavelengths, (std::vector{400.0, 500.0}));
    EXPECT_EQ(steps.values, (std::vector{0.1, 0.2}));
    EXPECT_EQ(shape.number("absent", 7), 7);
    shape.finish();
    EXPECT_TRUE(loaded.warnings.messages().empty());
}

// The first operation is applied first.
TEST(MitsubaGraph, TransformationsAreAppliedInOrder) {
    const LoadedGraph loaded(mitsuba_scene(R"(
        <shape type="sphere"><transform name="to_world">
            <scale x="2"/> <rotate z="1" angle="90"/> <translate value="1 0 0"/>
            <matrix value="1 0 0  0 1 0  0 0 3"/> <matrix value="1 0 0 0  0 1 0 0  0 0 1 5  0 0 0 1"/>
        </transform></shape>)"));
    const Vec3d p = loaded.plugin("shape").transform("to_world").point(Vec3d{1, 1, 1});
    EXPECT_NEAR(p.x, 0, 1e-12); // (1, 1, 1) scaled (2, 1, 1), turned (-1, 2, 1), moved (0, 2, 1)
    EXPECT_NEAR(p.y, 2, 1e-12);
    EXPECT_NEAR(p.z, 8, 1e-12);
}

// The camera looks along +z of its space, +x is to the left and +y up.
TEST(MitsubaGraph, LookAt) {
    const LoadedGraph loaded(mitsuba_scene(R"(
        <sensor type="perspective"><transform name="to_world">
            <lookat origin="1, 2, 3" target="1, 2, 9" up="0, 1, 0"/></transform></sensor>)"));
    const Transform t = loaded.plugin("sensor").transform("to_world");
    EXPECT_EQ(t.point(Vec3d{0, 0, 1}), (Vec3d{1, 2, 4}));
    EXPECT_EQ(t.vector(Vec3d{1, 0, 0}), (Vec3d{1, 0, 0}));
    EXPECT_EQ(t.vector(Vec3d{0, 1, 0}), (Vec3d{0, 1, 0}));
    EXPECT_FALSE(t.swaps_handedness());
}

TEST(MitsubaGraph, ParametersComeFromTheUserFirst) {
    const std::string text = mitsuba_scene(R"(
        <default name="spp" value="16"/> <default name="sp" value="9"/> <default name="kind" value="sphere"/>
        <shape type="$kind"><integer name="a" value="$spp"/><integer name="b" value="$sp"/>
            <string name="c" value="$kind-$sp \$sp"/></shape>)");
    const LoadedGraph plain(text);
    EXPECT_EQ(plain.plugin("shape").type(), "sphere");
    EXPECT_EQ(plain.plugin("shape").integer("a", 0), 16);
    EXPECT_EQ(plain.plugin("shape").integer("b", 0), 9);
    EXPECT_EQ(plain.plugin("shape").text("c", ""), "sphere-9 $sp");
    const LoadedGraph given(text, {{"spp", "4"}, {"kind", "cube"}, {"unused", "1"}});
    EXPECT_EQ(given.plugin("shape").type(), "cube");
    EXPECT_EQ(given.plugin("shape").integer("a", 0), 4);
    ASSERT_EQ(given.warnings.messages().size(), 1u);
    EXPECT_EQ(given.warnings.messages()[0], "scene.xml:1:1: the scene does not use the parameter 'unused'");
}

TEST(MitsubaGraph, IncludesAndFolders) {
    const LoadedGraph loaded(mitsuba_scene(R"(
        <path value="data"/> <default name="radius" value="2"/> <include filename="parts/more.xml"/>
        <shape type="cube"><include filename="grey.xml" name="surface"/></shape>)"),
                             {},
                             {{"data/parts/more.xml", R"(<scene version="3.0.0"><shape type="sphere">
                                 <float name="radius" value="$radius"/></shape></scene>)"},
                              {"data/grey.xml", R"(<bsdf version="3.0.0" type="diffuse" id="grey"/>)"}});
    Plugin scene(loaded.graph, 0);
    const std::vector<Plugin> shapes = scene.children("shape");
    ASSERT_EQ(shapes.size(), 2u);
    EXPECT_EQ(Plugin(shapes[0]).number("radius", 0), 2);
    EXPECT_EQ(loaded.graph.diagnostics.describe(shapes[0].at()), "data/parts/more.xml:1:24");
    const std::optional<Plugin> surface = Plugin(shapes[1]).object("surface");
    ASSERT_TRUE(surface);
    EXPECT_EQ(surface->id(), "grey");
    EXPECT_EQ(loaded.files.files_read().size(), 2u);
}

// A folder that leads up too far, since the scene was moved, is found further down.
TEST(MitsubaGraph, FoldersOfMovedScenes) {
    const LoadedGraph loaded(mitsuba_scene(R"(<path value="../../data"/><include filename="grey.xml"/>)"), {},
                             {{"data/grey.xml", R"(<bsdf version="3.0.0" type="diffuse" id="far"/>)"}});
    EXPECT_EQ(loaded.plugin("bsdf").id(), "far");
    const LoadedGraph both(mitsuba_scene(R"(<path value="../data"/><include filename="grey.xml"/>)"), {},
                           {{"data/grey.xml", R"(<bsdf version="3.0.0" type="diffuse" id="near"/>)"},
                            {"../data/grey.xml", R"(<bsdf version="3.0.0" type="diffuse" id="meant"/>)"}});
    EXPECT_EQ(both.plugin("bsdf").id(), "meant");
}

TEST(MitsubaGraph, ReferencesMayComeBeforeTheirObjects) {
    const LoadedGraph loaded(mitsuba_scene(R"(
        <shape type="cube"><ref id="red"/></shape> <bsdf type="diffuse" id="red"/> <alias id="red" as="rouge"/>
        <shape type="disk"><ref name="bsdf" id="rouge"/></shape>)"));
    Plugin scene(loaded.graph, 0);
    std::vector<Plugin> shapes = scene.children("shape");
    ASSERT_EQ(shapes.size(), 2u);
    const std::optional<Plugin> first = shapes[0].child("bsdf"), second = shapes[1].child("bsdf");
    ASSERT_TRUE(first && second);
    EXPECT_EQ(first->index(), second->index());
}

TEST(MitsubaGraph, SpectraFromFiles) {
    const LoadedGraph loaded(mitsuba_scene(R"(
        <bsdf type="conductor"><spectrum name="eta" filename="Au.spd"/></bsdf>)"),
                             {}, {{"Au.spd", "# gold\n400 1.5\n500 0.8 # green\n\n600.5 0.2\n"}});
    Plugin bsdf = loaded.plugin("bsdf");
    const auto& eta = std::get<mitsuba::SpectrumValue>(bsdf.find("eta")->value);
    EXPECT_EQ(eta.wavelengths, (std::vector{400.0, 500.0, 600.5}));
    ASSERT_EQ(eta.values.size(), 3u);
    EXPECT_FLOAT_EQ(static_cast<float>(eta.values[1]), 0.8f);
}

// Version 0.6: names in camel case, <lookAt>, offsets and scales of textures.
TEST(MitsubaGraph, OldVersionsHaveOldNames) {
    const LoadedGraph loaded(R"(<scene version="0.6.0">
        <sensor type="perspective"><transform name="toWorld"><lookAt origin="0 0 0" target="0 0 1"/></transform>
            <string name="fovAxis" value="x"/></sensor>
        <bsdf type="dielectric"><float name="extIOR" value="1.1"/></bsdf>
        <texture type="bitmap" id="t"><float name="uscale" value="2"/><float name="voffset" value="0.5"/></texture>
        <shape type="cube"><bsdf type="diffuse"><ref id="t" name="diffuseReflectance"/></bsdf></shape></scene>)");
    EXPECT_EQ(loaded.plugin("sensor").text("fov_axis", ""), "x");
    EXPECT_TRUE(loaded.plugin("sensor").has("to_world"));
    EXPECT_EQ(loaded.plugin("bsdf").number("ext_ior", 0), 1.1);
    EXPECT_EQ(loaded.plugin("texture").transform("to_uv").point(Vec3d{1, 1, 0}), (Vec3d{2, 1.5, 0}));
    Plugin shape = loaded.plugin("shape");
    EXPECT_TRUE(shape.child("bsdf")->object("reflectance"));
}

TEST(MitsubaGraph, PropertiesThatNothingReadsAreReported) {
    const LoadedGraph loaded(mitsuba_scene(
        "\n<shape type=\"sphere\"><float name=\"radios\" value=\"1\"/><bsdf type=\"diffuse\"/></shape>"));
    Plugin shape = loaded.plugin("shape");
    shape.number("radius", 1);
    shape.finish();
    ASSERT_EQ(loaded.warnings.messages().size(), 2u);
    EXPECT_EQ(loaded.warnings.messages()[0],
              "scene.xml:2:22: the shape 'sphere' has no property 'radios' (did you mean 'radius'?)");
    EXPECT_EQ(loaded.warnings.messages()[1],
              "scene.xml:2:54: the shape 'sphere' has no use for the bsdf 'diffuse'");
}

} // namespace
} // namespace montelux
