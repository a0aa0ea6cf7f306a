// Scenes of OBJ files: materials, pictures, and what is missing.
#include "test/temporary_folder.h"
#include <cmath>
#include <gtest/gtest.h>
#include <string>

#include "montelux/formats/load_scene.h"
#include "montelux/image/image_write.h"
#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

class ObjScene : public ::testing::Test {
  protected:
    // A triangle of the material "a".
    SceneDescription load(const std::string& mtl, const std::string& before = "mtllib a.mtl\n") {
        folder_.write("a.mtl", mtl);
        return load_scene(
            folder_.write("a.obj", before + "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\n"),
            warnings_);
    }
    Material material(const std::string& statements) {
        return load("newmtl a\n" + statements).scene.materials.at(0);
    }
    template <typename M>
    M material_of_kind(const std::string& statements) {
        const Material m = material(statements);
        EXPECT_TRUE(std::holds_alternative<M>(m)) << statements;
        return std::holds_alternative<M>(m) ? std::get<M>(m) : M{};
    }
    void picture(const std::string& name, std::vector<std::string> channels) {
        write_image(folder_ / name, Image(2, 2, std::move(channels), PixelFormat::u8, ColorEncoding::srgb()));
    }

    TemporaryFolder folder_;
    Warnings warnings_;
};

TEST_F(ObjScene, MaterialsAreWhatTheyMeant) {
    EXPECT_EQ(
        material_of_kind<DiffuseMaterial>("Kd 0.25 0.25 0.25\nKs 0 0 0\nNs 100\n").reflectance.value.constant,
        0.25f);
    material_of_kind<DiffuseMaterial>("Kd 1 0 0\nKs 1 1 1\nNs 96\nillum 1\n");
    material_of_kind<DiffuseMaterial>("Kd 1 0 0\nKs 1 1 1\nNs 1\n");
    const auto gloss = material_of_kind<CoatedDiffuseMaterial>("Kd 1 0 0\nKs 0.5 0.5 0.5\nNs 198\nNi 1.4\n");
    EXPECT_FLOAT_EQ(gloss.coating.roughness.u.value, 0.1f); // sqrt(2 / 200)
    EXPECT_FALSE(gloss.coating.roughness.remap);
    EXPECT_EQ(gloss.coating.eta.constant, 1.4f);
    EXPECT_EQ(material_of_kind<CoatedDiffuseMaterial>("Ks 1 1 1\nNs 9\nNi 1\n").coating.eta.constant, 1.5f);
    EXPECT_EQ(material_of_kind<ConductorMaterial>("Kd 0 0 0\nKs 0.75 0.75 0.75\nillum 3\n").roughness.u.value,
              0);
    EXPECT_EQ(material_of_kind<DielectricMaterial>("Kd 1 1 1\nd 0.1\nillum 4\nNi 1.33\n").eta.constant,
              1.33f);
    material_of_kind<DielectricMaterial>("Kd 0 0 0\nillum 7\n");
    EXPECT_TRUE(warnings_.messages().empty());
}

TEST_F(ObjScene, VertexColorsAreTheReflectanceOfClay) {
    const std::string triangle = "v 0 0 0 1 0.5 0\nv 1 0 0 0 0 0\nv 0 1 0 2 0 0\nf 1 2 3\n";
    const SceneDescription d = load_scene(folder_.write("c.obj", triangle), warnings_);
    const auto& clay = std::get<DiffuseMaterial>(d.scene.materials.at(0));
    EXPECT_TRUE(
        std::holds_alternative<VertexColorTexture>(d.scene.spectrum_textures.at(clay.reflectance.texture)));
    const std::vector<Vec3f>& colors = d.scene.meshes.at(0).colors;
    ASSERT_EQ(colors.size(), 3u);
    EXPECT_FLOAT_EQ(colors[0].y, 0.21404114f); // 0.5 of sRGB
    EXPECT_EQ(colors[2].x, 1);
    EXPECT_TRUE(warnings_.messages().empty());
    folder_.write("a.mtl", "newmtl a\nKd 0.5 0.5 0.5\n");
    const SceneDescription hidden =
        load_scene(folder_.write("h.obj", "mtllib a.mtl\nusemtl a\n" + triangle), warnings_);
    EXPECT_TRUE(hidden.scene.meshes.at(0).colors.empty());
    EXPECT_EQ(warnings_.messages().size(), 1u);
}

TEST_F(ObjScene, PhysicallyBasedMaterials) {
    picture("rough.png", {"Y"});
    picture("cloth.png", {"R", "G", "B"});
    const auto metal = material_of_kind<PrincipledMaterial>(
        "Kd 0.5 0.5 0.5\nPm 1\nPr 0.25\naniso -0.5\nanisor 0.5\nNi 1.4\n");
    EXPECT_EQ(metal.base_color.value.constant, 0.5f);
    EXPECT_EQ(metal.metallic.value, 1);
    EXPECT_EQ(metal.roughness.value, 0.25f);
    EXPECT_EQ(metal.anisotropy.value, 0.5f);
    EXPECT_FLOAT_EQ(metal.anisotropy_rotation.value, 1.5f * pi_f);
    EXPECT_EQ(metal.ior.value, 1.4f);
    const auto coated = material_of_kind<PrincipledMaterial>("Pc 0.5\nPcr 0.25\nNs 198\n");
    EXPECT_EQ(coated.clearcoat.value, 0.5f);
    EXPECT_EQ(coated.clearcoat_roughness.value, 0.25f);
    EXPECT_FLOAT_EQ(coated.roughness.value, std::sqrt(0.1f)); // of Ns
    EXPECT_EQ(material_of_kind<PrincipledMaterial>("Ps 0.5\n").sheen_color.value.constant, 0.5f);
    const SceneDescription d =
        load("newmtl a\nPr 0.5\nmap_Pr -s 2 2 rough.png\nmap_Pm rough.png\nmap_Ps cloth.png\n");
    const auto& m = std::get<PrincipledMaterial>(d.scene.materials.at(0));
    const auto& roughness = std::get<ImageTexture>(d.scene.float_textures.at(m.roughness.texture));
    EXPECT_EQ(roughness.mapping.su, 2);
    EXPECT_EQ(roughness.scale, 1);
    EXPECT_EQ(d.scene.images[roughness.image].encoding(), ColorEncoding::linear());
    EXPECT_EQ(std::get<ImageTexture>(d.scene.float_textures.at(m.metallic.texture)).image, roughness.image);
    const auto& sheen = std::get<ImageTexture>(d.scene.spectrum_textures.at(m.sheen_color.texture));
    EXPECT_EQ(d.scene.images[sheen.image].encoding(), ColorEncoding::linear());
    material_of_kind<DielectricMaterial>("Kd 0 0 0\nillum 7\nPr 0.5\n"); // glass
    EXPECT_TRUE(warnings_.messages().empty());
}

TEST_F(ObjScene, OpacityAndLight) {
    SceneDescription d = load("newmtl a\nd 0.25\nKe 2 2 2\n");
    EXPECT_EQ(d.scene.shapes[0].alpha.value, 0.25f);
    ASSERT_EQ(d.scene.lights.size(), 1u);
    EXPECT_EQ(name_of(d.scene.lights[0]), "area light");
    EXPECT_EQ(d.scene.material_names[0], "a");
    EXPECT_EQ(load("newmtl a\nKd 0 0 0\nillum 4\nd 0.25\n").scene.shapes[0].alpha.value,
              1); // glass is no cut-out
}

TEST_F(ObjScene, PicturesAreFound) {
    picture("oak.png", {"R", "G", "B"});
    picture("bump.png", {"Y"});
    picture("mask.png", {"R", "G", "B", "A"});
    SceneDescription d = load("newmtl a\nKd 0.5 0.5 0.5\nmap_Kd -s 2 3 -clamp on C:\\elsewhere\\oak.png\n"
                              "map_bump -bm 0.5 bump.png\nmap_d ../mask.png\n");
    EXPECT_TRUE(warnings_.messages().empty());
    ASSERT_EQ(d.scene.images.size(), 3u);
    const auto& color = std::get<ImageTexture>(d.scene.spectrum_textures.at(0));
    EXPECT_EQ(color.scale, 0.5f);
    EXPECT_EQ(color.mapping.su, 2);
    EXPECT_EQ(color.mapping.sv, 3);
    EXPECT_EQ(color.wrap, TextureWrap::clamp);
    EXPECT_EQ(d.scene.images[color.image].encoding(), ColorEncoding::srgb());
    const auto& m = std::get<DiffuseMaterial>(d.scene.materials[0]);
    EXPECT_EQ(m.reflectance.texture, 0u);
    const auto& bumps = std::get<ImageTexture>(d.scene.float_textures.at(m.detail.displacement.texture));
    EXPECT_FLOAT_EQ(bumps.scale, 0.5f * 0.01f * std::sqrt(2.0f));
    EXPECT_EQ(d.scene.images[bumps.image].encoding(), ColorEncoding::linear());
    const auto& mask = std::get<ImageTexture>(d.scene.float_textures.at(d.scene.shapes[0].alpha.texture));
    EXPECT_EQ(mask.channels, ImageChannels::alpha);
    // A coloured bump map is a normal map.
    d = load("newmtl a\nmap_bump oak.png\n");
    EXPECT_EQ(d.scene.normal_maps.size(), 1u);
    EXPECT_EQ(std::get<DiffuseMaterial>(d.scene.materials[0]).detail.normal_map.map, 0u);
}

TEST_F(ObjScene, WhatIsMissingIsTold) {
    const std::string obj = (folder_ / "a.obj").string(), mtl = (folder_ / "a.mtl").string();
    load("newmtl b\n", "mtllib a.mtl\nmtllib ../../no.mtl\n");
    load("newmtl a\nKd 1 0 0\nmap_Kd no.png\n");
    folder_.write("bad.png", "no picture");
    load("newmtl a\nmap_Kd bad.png\n");
    picture("grey.png", {"Y"});
    picture("oak.png", {"R", "G", "B"});
    load("newmtl a\nnorm grey.png\n");
    load("newmtl a\nKd 1 0 0\nmap_Kd oak.png\n");
    ASSERT_EQ(warnings_.messages().size(), 6u);
    EXPECT_EQ(warnings_.messages()[0],
              obj + ":2: there is no file '../../no.mtl' in the folder of the OBJ file");
    EXPECT_EQ(warnings_.messages()[1], obj + ":8: no MTL file has the material 'a'");
    EXPECT_EQ(warnings_.messages()[2],
              mtl + ":3: there is no picture 'no.png' in the folder of the file; the material is without it");
    EXPECT_TRUE(warnings_.messages()[3].starts_with(mtl + ":2: ")) << warnings_.messages()[3];
    EXPECT_EQ(warnings_.messages()[4],
              mtl + ":2: the normal map 'grey.png' has no channels R, G and B; it is ignored");
    EXPECT_EQ(warnings_.messages()[5],
              mtl + ":3: 'Kd' of material 'a' is ignored beside its picture: it is not grey");
}

// No file outside the folder is read, whatever path a file names.
TEST_F(ObjScene, PathsStayInTheFolder) {
    folder_.write("secret.mtl", "newmtl a\nKd 0 0 0\n");
    const auto inside =
        folder_.write("model/a.obj", "mtllib ../secret.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n");
    std::vector<std::filesystem::path> files_read;
    load_scene(inside, warnings_, {.files_read = &files_read});
    EXPECT_EQ(files_read, std::vector{inside});
    EXPECT_EQ(warnings_.messages().size(), 1u);
    folder_.write("model/x.obj",
                  "mtllib " + (folder_ / "secret.mtl").string() + "\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    files_read.clear();
    load_scene(folder_ / "model/x.obj", warnings_, {.files_read = &files_read});
    EXPECT_EQ(files_read.size(), 1u);
}

} // namespace
} // namespace montelux
