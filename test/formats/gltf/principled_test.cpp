// Principled materials of glTF: which factor and which channel is which parameter.
#include "test/formats/gltf/model.h"
#include <gtest/gtest.h>

#include "montelux/scene/material/material.h"

namespace montelux {
namespace {

using test::load_model;
using test::Model;

// A PNG picture of one texel, 255 51 102 204.
const std::string texel =
    R"(, "images": [{"uri": "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR4nGP4b5x2BgAGMgJlrgZiagAAAABJRU5ErkJggg=="}], "textures": [{"source": 0}])";

struct Principled : PrincipledMaterial {
    Scene scene;
};

Principled principled(const std::string& members) {
    Model m;
    m.add_triangle();
    m.add<float>({0, 0, 1, 0, 0, 1}, "VEC2");
    SceneDescription d = load_model(m.text(
        R"("meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "material": 0}]}],
        "nodes": [{"mesh": 0}], "materials": [{)" +
        members + "}]" + texel));
    return {std::get<PrincipledMaterial>(d.scene.materials.at(0)), std::move(d.scene)};
}

Principled extended(const std::string& extension, const std::string& members) {
    return principled(R"("extensions": {"KHR_materials_)" + extension + "\": {" + members + "}}");
}

// The channel and the factor of a picture.
void expect_channel(const Principled& m, const FloatParameter& p, ImageChannels channel, float factor) {
    ASSERT_FALSE(p.is_constant());
    const auto& t = std::get<ImageTexture>(m.scene.float_textures.at(p.texture));
    EXPECT_EQ(t.channels, channel);
    EXPECT_EQ(t.scale, factor);
    EXPECT_EQ(m.scene.images.at(t.image).encoding(), ColorEncoding::linear());
}
// The picture's channel A is an image of its own.
void expect_alpha(const Principled& m, const FloatParameter& p, float factor) {
    expect_channel(m, p, ImageChannels::color, factor);
    EXPECT_EQ(
        m.scene.images.at(std::get<ImageTexture>(m.scene.float_textures.at(p.texture)).image).channels(), 1);
}
void expect_color(const Principled& m, const SpectrumParameter& p, Vec3f factor) {
    ASSERT_FALSE(p.is_constant());
    const auto& t = std::get<ImageTexture>(m.scene.spectrum_textures.at(p.texture));
    EXPECT_EQ(t.factor, factor);
    EXPECT_EQ(m.scene.images.at(t.image).encoding(), ColorEncoding::srgb());
}

TEST(GltfPrincipled, Defaults) {
    const Principled m = principled("");
    EXPECT_EQ(m.metallic.value, 1);
    EXPECT_EQ(m.roughness.value, 1);
    EXPECT_EQ(m.ior.value, 1.5f);
    EXPECT_EQ(m.transmission.value, 0);
    EXPECT_EQ(m.clearcoat.value, 0);
    EXPECT_FALSE(m.thin_walled);
}

TEST(GltfPrincipled, MetallicRoughness) {
    const Principled m =
        principled(R"("pbrMetallicRoughness": {"metallicFactor": 0.25, "roughnessFactor": 0.5,
        "metallicRoughnessTexture": {"index": 0}, "baseColorTexture": {"index": 0}, "baseColorFactor": [1, 0.5, 0, 1]})");
    expect_channel(m, m.metallic, ImageChannels::blue, 0.25f);
    expect_channel(m, m.roughness, ImageChannels::green, 0.5f);
    expect_color(m, m.base_color, {1, 0.5f, 0});
}

TEST(GltfPrincipled, SpecularGlossiness) {
    const Principled m = extended("pbrSpecularGlossiness",
                                  R"("diffuseFactor": [1, 0.5, 0, 1], "diffuseTexture": {"index": 0},
        "specularFactor": [0.5, 1, 0.25], "glossinessFactor": 0.75, "specularGlossinessTexture": {"index": 0})");
    expect_color(m, m.base_color, {1, 0.5f, 0});
    expect_color(m, m.specular_color, {0.5f, 1, 0.25f});
    EXPECT_EQ(m.metallic.value, 0);
    EXPECT_EQ(m.ior.value, 0);
    const auto& rough = std::get<MixTexture<FloatParameter>>(m.scene.float_textures.at(m.roughness.texture));
    EXPECT_EQ(rough.first.value, 1);
    EXPECT_EQ(rough.second.value, 0.25f);
    expect_alpha(m, rough.amount, 1);

    // It wins over metallic-roughness.
    const Principled plain = principled(R"("pbrMetallicRoughness": {"baseColorFactor": [0, 1, 0, 1]},
        "extensions": {"KHR_materials_pbrSpecularGlossiness": {"glossinessFactor": 0.25}})");
    EXPECT_EQ(plain.roughness.value, 0.75f);
    EXPECT_EQ(plain.metallic.value, 0);
    EXPECT_NEAR(spectrum_of(plain.base_color.value, plain.scene.spectra)(650), 1, 1e-3f);
}

TEST(GltfPrincipled, Layers) {
    Principled m = extended("clearcoat", R"("clearcoatFactor": 0.5, "clearcoatTexture": {"index": 0},
        "clearcoatRoughnessFactor": 0.75, "clearcoatRoughnessTexture": {"index": 0})");
    expect_channel(m, m.clearcoat, ImageChannels::red, 0.5f);
    expect_channel(m, m.clearcoat_roughness, ImageChannels::green, 0.75f);
    m = extended("sheen", R"("sheenColorFactor": [1, 0.5, 0.25], "sheenColorTexture": {"index": 0},
        "sheenRoughnessFactor": 0.5, "sheenRoughnessTexture": {"index": 0})");
    expect_color(m, m.sheen_color, {1, 0.5f, 0.25f});
    expect_alpha(m, m.sheen_roughness, 0.5f);
    m = extended("specular", R"("specularFactor": 0.5, "specularTexture": {"index": 0},
        "specularColorFactor": [2, 1, 1], "specularColorTexture": {"index": 0})");
    expect_alpha(m, m.specular, 0.5f);
    expect_color(m, m.specular_color, {2, 1, 1});
    m = extended("ior", R"("ior": 1.25)");
    EXPECT_EQ(m.ior.value, 1.25f);
}

TEST(GltfPrincipled, Anisotropy) {
    Principled m = extended("anisotropy", R"("anisotropyStrength": 0.5, "anisotropyRotation": 2)");
    EXPECT_EQ(m.anisotropy.value, 0.5f);
    EXPECT_EQ(m.anisotropy_rotation.value, 2);
    m = extended("anisotropy", R"("anisotropyStrength": 0.5, "anisotropyTexture": {"index": 0})");
    expect_channel(m, m.anisotropy, ImageChannels::blue, 0.5f);
    expect_channel(m, m.anisotropy_rotation, ImageChannels::angle, 1);
    // With a rotation, the sum.
    m = extended("anisotropy", R"("anisotropyRotation": 2, "anisotropyTexture": {"index": 0})");
    const auto& twice =
        std::get<ScaleTexture<FloatParameter>>(m.scene.float_textures.at(m.anisotropy_rotation.texture));
    EXPECT_EQ(twice.scale.value, 2);
    const auto& mean = std::get<MixTexture<FloatParameter>>(m.scene.float_textures.at(twice.texture.texture));
    EXPECT_EQ(mean.first.value, 2);
    EXPECT_EQ(mean.amount.value, 0.5f);
    expect_channel(m, mean.second, ImageChannels::angle, 1);
}

TEST(GltfPrincipled, Iridescence) {
    Principled m = extended("iridescence", R"("iridescenceFactor": 0.5, "iridescenceIor": 1.6,
        "iridescenceThicknessMinimum": 200, "iridescenceThicknessMaximum": 600)");
    EXPECT_EQ(m.iridescence.value, 0.5f);
    EXPECT_EQ(m.iridescence_ior.value, 1.6f);
    EXPECT_EQ(m.iridescence_thickness.value, 600);
    m = extended("iridescence",
                 R"("iridescenceThicknessMinimum": 200, "iridescenceThicknessTexture": {"index": 0})");
    const auto& mix =
        std::get<MixTexture<FloatParameter>>(m.scene.float_textures.at(m.iridescence_thickness.texture));
    EXPECT_EQ(mix.first.value, 200);
    EXPECT_EQ(mix.second.value, 400);
    expect_channel(m, mix.amount, ImageChannels::green, 1);
}

TEST(GltfPrincipled, SheetsAndBodies) {
    Principled m =
        extended("transmission", R"("transmissionFactor": 0.5, "transmissionTexture": {"index": 0})");
    expect_channel(m, m.transmission, ImageChannels::red, 0.5f);
    EXPECT_TRUE(m.thin_walled);
    m = principled(R"("extensions": {"KHR_materials_transmission": {"transmissionFactor": 1},
        "KHR_materials_volume": {"thicknessFactor": 0.1}, "KHR_materials_dispersion": {"dispersion": 0.3}})");
    EXPECT_FALSE(m.thin_walled);
    EXPECT_EQ(m.dispersion.value, 0.3f);
    m = extended("diffuse_transmission",
                 R"("diffuseTransmissionFactor": 0.5, "diffuseTransmissionTexture": {"index": 0},
        "diffuseTransmissionColorFactor": [0.5, 1, 1], "diffuseTransmissionColorTexture": {"index": 0})");
    expect_alpha(m, m.diffuse_transmission, 0.5f);
    expect_color(m, m.diffuse_transmission_color, {0.5f, 1, 1});
    EXPECT_TRUE(m.thin_walled);
}

} // namespace
} // namespace montelux
