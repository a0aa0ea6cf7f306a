// Textures with pbrt-v4's defaults.
#include "test/formats/pbrt/parse.h"
#include "test/temporary_folder.h"
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "montelux/image/image_write.h"

namespace montelux {
namespace {

using test::parse_world;

TEST(PbrtTextures, NodesAndDefaults) {
    SceneDescription d = parse_world(R"(
        Texture "f" "float" "constant" "float value" 0.25
        Texture "s" "float" "scale" "texture tex" "f" "float scale" 3
        Texture "m" "spectrum" "mix" "rgb tex2" [ 0.5 0.5 0.5 ] "texture amount" "s"
        Translate 1 0 0
        Texture "c" "spectrum" "checkerboard" "texture tex1" "m" "float uscale" 20 "float vdelta" 0.5
        Texture "c3" "float" "checkerboard" "integer dimension" 3
        Material "diffuse" "texture reflectance" "c"
        Shape "sphere" "texture alpha" "c3"
        Material "conductor" "texture eta" "c"
        Shape "disk")");
    const auto& m = std::get<DiffuseMaterial>(d.scene.materials[d.scene.shapes[0].material]);
    const auto& c =
        std::get<CheckerboardTexture<SpectrumParameter>>(d.scene.spectrum_textures[m.reflectance.texture]);
    EXPECT_EQ(c.mapping.su, 20);
    EXPECT_EQ(c.mapping.sv, 1);
    EXPECT_EQ(c.mapping.dv, 0.5f);
    EXPECT_EQ(c.values[1].value.constant, 0);
    const auto& mix = std::get<MixTexture<SpectrumParameter>>(d.scene.spectrum_textures[c.values[0].texture]);
    EXPECT_EQ(spectrum_of(mix.first.value, d.scene.spectra)(500), 0);
    EXPECT_NEAR(spectrum_of(mix.second.value, d.scene.spectra)(500), 0.5f, 1e-3f);
    const auto& scale = std::get<ScaleTexture<FloatParameter>>(d.scene.float_textures[mix.amount.texture]);
    EXPECT_EQ(scale.scale.value, 3);
    EXPECT_EQ(
        std::get<ConstantTexture<FloatParameter>>(d.scene.float_textures[scale.texture.texture]).value.value,
        0.25f);
    const auto& c3 = std::get<CheckerboardTexture<FloatParameter>>(
        d.scene.float_textures[d.scene.shapes[0].alpha.texture]);
    EXPECT_EQ(c3.dimension, 3);
    EXPECT_EQ(c3.values[0].value, 1);
    EXPECT_EQ(c3.mapping.texture_from_world.point(Vec3f(1, 0, 0)), Vec3f());
    // As an index of refraction the same texture is another node.
    const auto& metal = std::get<ConductorMaterial>(d.scene.materials[d.scene.shapes[1].material]);
    EXPECT_NE(metal.metal.eta.texture, m.reflectance.texture);
}

TEST(PbrtTextures, ProceduralTexturesAndDefaults) {
    const SceneDescription d = parse_world(R"(
        Translate 1 0 0
        Rotate 90 0 0 1
        Texture "fbm" "float" "fbm"
        Texture "windy" "float" "windy"
        Texture "wrinkled" "float" "wrinkled" "integer octaves" 3 "float roughness" 0.25
        Texture "dots" "float" "dots" "texture inside" "fbm" "float vscale" 4
        Texture "bilerp" "float" "bilerp"
        Texture "turn" "float" "directionmix" "texture tex1" "dots" "texture tex2" "windy"
        Texture "marble" "spectrum" "marble" "float variation" 2
        Texture "corners" "spectrum" "bilerp" "spectrum v10" [ 400 0.5 700 0.5 ]
        Identity
        Material "coateddiffuse" "texture reflectance" "marble" "texture roughness" "wrinkled"
                 "texture thickness" "turn" "texture albedo" "corners"
        Shape "sphere" "texture alpha" "bilerp")");
    const Scene& s = d.scene;
    const auto& m = std::get<CoatedDiffuseMaterial>(s.materials.back());
    const auto& marble = std::get<MarbleTexture>(s.spectrum_textures[m.reflectance.texture]);
    EXPECT_EQ(marble.octaves.octaves, 8);
    EXPECT_EQ(marble.octaves.roughness, 0.5f);
    EXPECT_EQ(marble.scale, 1);
    EXPECT_EQ(marble.variation, 2);
    EXPECT_EQ(marble.texture_from_world.point(Vec3f(1, 0, 0)), Vec3f());
    const auto& wrinkled = std::get<NoiseTexture>(s.float_textures[m.coating.roughness.u.texture]);
    EXPECT_EQ(wrinkled.kind, NoiseTexture::Kind::wrinkled);
    EXPECT_EQ(wrinkled.octaves.octaves, 3);
    EXPECT_EQ(wrinkled.octaves.roughness, 0.25f);
    const auto& turn =
        std::get<DirectionMixTexture<FloatParameter>>(s.float_textures[m.coating.thickness.texture]);
    EXPECT_NEAR(turn.direction.x, -1, 1e-6); // y, turned
    EXPECT_NEAR(turn.direction.y, 0, 1e-6);
    const auto& dots = std::get<DotsTexture<FloatParameter>>(s.float_textures[turn.first.texture]);
    EXPECT_EQ(dots.outside.value, 0);
    EXPECT_EQ(dots.mapping.sv, 4);
    const auto& fbm = std::get<NoiseTexture>(s.float_textures[dots.inside.texture]);
    EXPECT_EQ(fbm.kind, NoiseTexture::Kind::fbm);
    EXPECT_EQ(fbm.octaves.octaves, 8);
    EXPECT_EQ(fbm.octaves.roughness, 0.5f);
    EXPECT_EQ(std::get<NoiseTexture>(s.float_textures[turn.second.texture]).kind, NoiseTexture::Kind::windy);
    const auto& bilerp = std::get<BilerpTexture<FloatParameter>>(s.float_textures[s.shapes[0].alpha.texture]);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(bilerp.corners[i].value, i < 2 ? 0 : 1);
    const auto& corners =
        std::get<BilerpTexture<SpectrumParameter>>(s.spectrum_textures[m.coating.albedo.texture]);
    EXPECT_NEAR(spectrum_of(corners.corners[1].value, s.spectra)(550), 0.5, 1e-6);
    EXPECT_EQ(corners.corners[0].value.constant, 0);
    EXPECT_EQ(corners.corners[3].value.constant, 1);
}

TEST(PbrtTextures, PicturesAreReadOnceForEachEncoding) {
    TemporaryFolder folder;
    Image picture(4, 4, {"R", "G", "B"}, PixelFormat::u8, ColorEncoding::srgb());
    write_image(folder / "a.png", picture);
    Warnings warnings;
    SceneDescription d = parse_pbrt(R"(WorldBegin
        LightSource "point"
        Texture "a" "spectrum" "imagemap" "string filename" "a.png" "bool invert" true "float scale" 2
        Texture "b" "float" "imagemap" "string filename" "a.png" "string filter" "ewa" "string wrap" "clamp"
        Texture "c" "float" "imagemap" "string filename" "a.png" "string encoding" "linear"
        Texture "d" "float" "imagemap" "string filename" "a.png" "string encoding" "gamma 2.2"
            "string mapping" "planar" "vector3 v1" [ 0 0 2 ]
        Texture "unused" "float" "imagemap" "string filename" "none.png"
        Material "coateddiffuse" "texture reflectance" "a" "texture roughness" "b" "texture thickness" "c"
        Shape "sphere" "texture alpha" "d")",
                                    "scene", folder.path(), warnings);
    ASSERT_EQ(d.scene.images.size(), 3u);
    const auto& m = std::get<CoatedDiffuseMaterial>(d.scene.materials[d.scene.shapes[0].material]);
    const auto& a = std::get<ImageTexture>(d.scene.spectrum_textures[m.reflectance.texture]);
    const auto& b = std::get<ImageTexture>(d.scene.float_textures[m.coating.roughness.u.texture]);
    const auto& c = std::get<ImageTexture>(d.scene.float_textures[m.coating.thickness.texture]);
    const auto& e = std::get<ImageTexture>(d.scene.float_textures[d.scene.shapes[0].alpha.texture]);
    EXPECT_EQ(a.image, b.image);
    EXPECT_NE(a.image, c.image);
    EXPECT_TRUE(a.invert);
    EXPECT_EQ(a.scale, 2);
    EXPECT_EQ(a.filter, TextureFilter::bilinear);
    EXPECT_EQ(a.wrap, TextureWrap::repeat);
    EXPECT_EQ(a.meaning, RgbMeaning::albedo);
    EXPECT_EQ(b.filter, TextureFilter::ewa);
    EXPECT_EQ(b.wrap, TextureWrap::clamp);
    EXPECT_EQ(d.scene.images[a.image].encoding(), ColorEncoding::srgb());
    EXPECT_EQ(d.scene.images[c.image].encoding(), ColorEncoding::linear());
    EXPECT_EQ(d.scene.images[e.image].encoding(), ColorEncoding::gamma(2.2f));
    EXPECT_EQ(e.mapping.kind, TextureMapping::Kind::planar);
    EXPECT_EQ(e.mapping.vs, Vec3f(0, 0, 2));
    EXPECT_EQ(warnings.messages(),
              std::vector<std::string>{"scene:8:9: texture 'unused' is not used and was not read"});
}

// As pbrt-v4: a number is the alpha of a picture in colour that has holes, and else the mean of its colours.
TEST(PbrtTextures, NumbersFromPicturesWithAlpha) {
    TemporaryFolder folder;
    Image opaque(2, 2, {"R", "G", "B", "A"}, PixelFormat::u8, ColorEncoding::srgb());
    for (std::uint8_t& v : opaque.u8()) v = 255;
    Image leaf = opaque;
    leaf.u8()[leaf.index(1, 1, 3)] = 0;
    write_image(folder / "opaque.png", opaque);
    write_image(folder / "leaf.png", leaf);
    Warnings warnings;
    SceneDescription d = parse_pbrt(R"(WorldBegin
        Texture "leaf" "float" "imagemap" "string filename" "leaf.png"
        Texture "opaque" "float" "imagemap" "string filename" "opaque.png"
        Texture "leaf" "spectrum" "imagemap" "string filename" "leaf.png"
        Material "diffuse" "texture reflectance" "leaf"
        Shape "sphere" "texture alpha" "leaf"
        Shape "sphere" "texture alpha" "opaque")",
                                    "scene", folder.path(), warnings);
    auto channels = [&](std::size_t shape) {
        return std::get<ImageTexture>(d.scene.float_textures[d.scene.shapes[shape].alpha.texture]).channels;
    };
    EXPECT_EQ(channels(0), ImageChannels::alpha);
    EXPECT_EQ(channels(1), ImageChannels::color);
    const auto& m = std::get<DiffuseMaterial>(d.scene.materials[d.scene.shapes[0].material]);
    EXPECT_EQ(std::get<ImageTexture>(d.scene.spectrum_textures[m.reflectance.texture]).channels,
              ImageChannels::color);
}

} // namespace
} // namespace montelux
