// Limits on what a small file may demand: memory, time, distances.
#include "test/formats/pbrt/parse.h"
#include "test/image/bounded_run.h"
#include <gtest/gtest.h>
#include <string>

#include "montelux/formats/loop_subdivision.h"

namespace montelux {
namespace {

using test::parse_world;
using test::world_error;

// Without a crash, within bounded_run's memory and time.
std::string bounded_error(const std::string& world) {
    BoundedRun run = bounded_run([&] { parse_world(world); }, 60);
    if (run.ending == Ending::crashed || run.ending == Ending::timed_out)
        return "crashed or timed out: " + run.message;
    return run.message;
}

std::string ones(int count) {
    std::string text = "[";
    for (int i = 0; i < count; ++i) text += " 1";
    return text + " ]\n";
}

TEST(PbrtLimits, DefaultsAreShared) {
    std::string text = "Attribute \"material\" \"float g\" " + ones(100000);
    for (int i = 0; i < 20000; ++i) text += "Material \"diffuse\"\n";
    EXPECT_EQ(bounded_error(text), "");
    text = "Attribute \"shape\" \"point3 P\" " + ones(100000);
    for (int i = 0; i < 20000; ++i) text += "AttributeBegin Attribute \"shape\" \"float radius\" 2\n";
    for (int i = 0; i < 20000; ++i) text += "AttributeEnd\n";
    EXPECT_EQ(bounded_error(text), "");
}

// Files of some programs give the same default before each shape.
TEST(PbrtLimits, DefaultsMayBeGivenAgainAndAgain) {
    std::string text;
    for (int i = 0; i < 20000; ++i)
        text += "Attribute \"shape\" \"float radius\" " + std::to_string(i + 1) + "\n";
    SceneDescription d = parse_world(text + "Shape \"sphere\"");
    EXPECT_EQ(std::get<Sphere>(d.scene.quadrics.at(0)).radius, 20000);
}

// Node t(n) looks up 2^(n+1) - 1 nodes.
TEST(PbrtLimits, TexturesThatBranch) {
    for (const char* type : {"float", "spectrum"}) {
        std::string text = "Texture \"t0\" \"" + std::string(type) + "\" \"constant\"\n";
        for (int i = 1; i <= 60; ++i) {
            const std::string before = "\"t" + std::to_string(i - 1) + "\"";
            text += "Texture \"t" + std::to_string(i) + "\" \"" + type + "\" \"mix\" \"texture tex1\" " +
                    before + " \"texture tex2\" " + before + "\n";
        }
        const std::string use = std::string(type) == "float"
                                    ? "Shape \"sphere\" \"texture alpha\" "
                                    : "Material \"diffuse\" \"texture reflectance\" ";
        EXPECT_EQ(world_error(text + use + "\"t11\""), "");
        EXPECT_EQ(
            world_error(text + use + "\"t60\""),
            "scene:14:1: one look-up of this texture would evaluate more than 4096 textures: it refers to "
            "others too often");
    }
}

const std::string one_triangle = "\"point3 P\" [ 0 0 0 1 0 0 0 1 0 1 1 0 ] \"integer indices\" [ 0 1 2 ]\n";

TEST(PbrtLimits, SubdividedTriangles) {
    auto sentence = [](const std::string& at, int levels, int most = 4194304) {
        return at + ": " + std::to_string(levels) +
               " levels would take the triangles of all 'loopsubdiv' shapes together beyond " +
               std::to_string(most);
    };
    EXPECT_EQ(bounded_error("Shape \"loopsubdiv\" \"integer levels\" 12 " + one_triangle),
              sentence("scene:2:20", 12));
    EXPECT_EQ(bounded_error("Shape \"loopsubdiv\" \"integer levels\" 0 " + one_triangle +
                            "Shape \"loopsubdiv\" \"integer levels\" 11 " + one_triangle),
              sentence("scene:3:20", 11));
    // Large control meshes may become larger ones.
    std::string many = "\"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"integer indices\" [ ";
    for (int i = 0; i < 5000; ++i) many += "0 1 2 ";
    EXPECT_EQ(bounded_error("Shape \"loopsubdiv\" \"integer levels\" 6 " + many + "]"),
              sentence("scene:2:20", 6, 5120000));
    SubdivisionBudget budget;
    EXPECT_TRUE(budget.take(5000, 5));
    EXPECT_FALSE(budget.take(1, 8));
    EXPECT_TRUE(budget.take(100000, 1));
    EXPECT_EQ(budget.limit(), max_subdivided_triangles);
    EXPECT_FALSE(budget.take(100000, 5));
    EXPECT_EQ(bounded_error("Shape \"loopsubdiv\" \"integer levels\" 2000000000 " + one_triangle),
              sentence("scene:2:20", 2000000000));
}

// Positions beyond single precision.
TEST(PbrtLimits, PlacesBeyondFloats) {
    struct FarCase {
        const char *world, *error;
    };
    const FarCase cases[] = {
        {"Translate 1e39 0 0 Shape \"sphere\"", "scene:2:20: the shape reaches to infinity in world space"},
        {"Scale 10 10 10 Shape \"sphere\" \"float radius\" 2e38",
         "scene:2:16: the shape reaches to infinity in world space"},
        {"Scale 1 1e39 1 Shape \"disk\"", "scene:2:16: the shape reaches to infinity in world space"},
        {"Translate 1e39 0 0 LightSource \"point\"", "scene:2:20: the light lies at infinity in world space"},
        {"Scale 1000 1 1 LightSource \"point\" \"point3 from\" [ 3e38 0 0 ]",
         "scene:2:16: the light lies at infinity in world space"},
        {"Translate 0 1e39 0 LightSource \"spot\"", "scene:2:20: the light lies at infinity in world space"},
        {"Scale 1e39 1e39 1e39 LightSource \"distant\"",
         "scene:2:22: the light's direction is not finite in world space"},
        {"Scale 1e39 1e39 1e39 LightSource \"infinite\"",
         "scene:2:22: the light's transformation is beyond what single-precision numbers hold"},
        {"Scale 1e-39 1 1 LightSource \"sky\"",
         "scene:2:17: the light's transformation is beyond what single-precision numbers hold"},
        {"ObjectBegin \"o\" Shape \"sphere\" ObjectEnd\nTranslate 1e39 0 0 ObjectInstance \"o\"",
         "scene:3:20: the instance's transformation is beyond what single-precision numbers hold"},
        {"ObjectBegin \"o\" Shape \"sphere\" ObjectEnd\nScale 1e-39 1 1 ObjectInstance \"o\"",
         "scene:3:17: the instance's transformation is beyond what single-precision numbers hold"},
        {"ObjectBegin \"o\" Shape \"disk\" \"float radius\" 1e38 Shape \"sphere\" ObjectEnd\n"
         "Scale 9 9 9 ObjectInstance \"o\"",
         "scene:3:13: the instance reaches to infinity in world space"},
        {"ObjectBegin \"o\" Shape \"trianglemesh\" \"point3 P\" [ 3e38 0 0 0 1 0 0 0 1 ] ObjectEnd\n"
         "Scale 9 9 9 ObjectInstance \"o\"",
         "scene:3:13: the instance reaches to infinity in world space"},
        {"Translate 1e39 0 0 Texture \"t\" \"float\" \"checkerboard\" \"string mapping\" \"planar\" "
         "Identity Shape \"sphere\" \"texture alpha\" \"t\"",
         "scene:2:20: the texture's transformation is beyond what single-precision numbers hold"},
        {"Scale 1e-39 1 1 Texture \"t\" \"float\" \"checkerboard\" \"integer dimension\" 3 "
         "Identity Shape \"sphere\" \"texture alpha\" \"t\"",
         "scene:2:17: the texture's transformation is beyond what single-precision numbers hold"},
        // What does no harm.
        {"Translate 1e39 0 0 LightSource \"distant\"", ""},
        {"Translate 1e39 0 0 LightSource \"infinite\"", ""},
        {"Translate 1e39 0 0 Translate -1e39 0 0 Shape \"sphere\"", ""},
        {"Scale 1e-39 1e-39 1e-39 Shape \"sphere\" \"float radius\" 1e38", ""},
        {"Translate 1e39 0 0 Texture \"t\" \"float\" \"checkerboard\" "
         "Identity Shape \"sphere\" \"texture alpha\" \"t\"",
         ""},
        {"ObjectBegin \"o\" ObjectEnd ObjectInstance \"o\"", ""},
    };
    for (const FarCase& c : cases) EXPECT_EQ(world_error(c.world), c.error) << c.world;
    for (const char* transformation : {"Translate 1e39 0 0", "Scale 1e39 1 1", "Scale 1e-39 1 1"})
        EXPECT_EQ(test::error_of(transformation + std::string(" Camera \"perspective\" WorldBegin")),
                  "scene:1:" + std::to_string(std::string(transformation).size() + 2) +
                      ": the camera's transformation is beyond what single-precision numbers hold");
}

} // namespace
} // namespace montelux
