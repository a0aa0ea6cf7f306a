// Mixes of named materials in pbrt's files.
#include "test/formats/pbrt/parse.h"
#include <gtest/gtest.h>
#include <string>
#include <vector>

namespace montelux {
namespace {

using test::parse_world;

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

} // namespace
} // namespace montelux
