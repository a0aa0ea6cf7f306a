// Normal maps and bumps of pbrt's materials.
#include "test/formats/pbrt/parse.h"
#include "test/temporary_folder.h"
#include <algorithm>
#include <gtest/gtest.h>
#include <string>

#include "montelux/image/image_write.h"

namespace montelux {
namespace {

const char* const all_materials[] = {"diffuse",
                                     "conductor",
                                     "dielectric",
                                     "thindielectric",
                                     "coateddiffuse",
                                     "coatedconductor",
                                     "diffusetransmission",
                                     "interface",
                                     "hair",
                                     "principled",
                                     "plastic",
                                     "disney",
                                     "disneythin"};

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

TEST(PbrtMaterials, WhatHasNoSurfaceHasNoBumps) {
    for (const std::string type : {"interface", "mix", "sided"}) {
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

} // namespace
} // namespace montelux
