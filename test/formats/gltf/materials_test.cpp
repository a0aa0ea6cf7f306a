// Materials and textures of glTF: what is read from factors, pictures, samplers and extensions.
#include "test/formats/gltf/model.h"
#include <cmath>
#include <gtest/gtest.h>
#include <zlib.h>

namespace montelux {
namespace {

using test::load_model;
using test::Model;

// A PNG file with 8 bits, 4 channels and no filter.
std::vector<std::uint8_t> png(std::uint32_t width, std::uint32_t height,
                              const std::vector<std::uint8_t>& rgba) {
    std::vector<std::uint8_t> file{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    const auto word = [](std::vector<std::uint8_t>& to, std::uint32_t w) {
        for (int shift = 24; shift >= 0; shift -= 8) to.push_back(static_cast<std::uint8_t>(w >> shift));
    };
    const auto chunk = [&](const std::string& type, const std::vector<std::uint8_t>& data) {
        word(file, static_cast<std::uint32_t>(data.size()));
        std::vector<std::uint8_t> body(type.begin(), type.end());
        body.insert(body.end(), data.begin(), data.end());
        file.insert(file.end(), body.begin(), body.end());
        word(file, static_cast<std::uint32_t>(crc32(0, body.data(), static_cast<uInt>(body.size()))));
    };
    std::vector<std::uint8_t> header, rows;
    word(header, width);
    word(header, height);
    header.insert(header.end(), {8, 6, 0, 0, 0});
    for (std::size_t y = 0; y < height; ++y) {
        rows.push_back(0);
        rows.insert(rows.end(), rgba.begin() + static_cast<std::ptrdiff_t>(4 * width * y),
                    rgba.begin() + static_cast<std::ptrdiff_t>(4 * width * (y + 1)));
    }
    std::vector<std::uint8_t> packed(compressBound(static_cast<uLong>(rows.size())));
    uLongf size = static_cast<uLongf>(packed.size());
    compress(packed.data(), &size, rows.data(), static_cast<uLong>(rows.size()));
    packed.resize(size);
    chunk("IHDR", header);
    chunk("IDAT", packed);
    chunk("IEND", {});
    return file;
}

// Two by two texels in RGBA, as a PNG file beside the model.
void add_picture(test::MemoryFiles& files) {
    std::vector<std::uint8_t> rgba;
    for (int i = 0; i < 16; ++i) rgba.push_back(static_cast<std::uint8_t>(16 * i));
    files.files["folder/a b.png"] = png(2, 2, rgba);
}

const std::string pictures = R"(, "images": [{"uri": "a%20b.png"}], "textures": [{"source": 0}],
    "samplers": [{"magFilter": 9728, "wrapS": 33071, "wrapT": 33648}])";

// A triangle with texture coordinates and that material. `colors`: of its vertices, too.
SceneDescription with_material(const std::string& material, bool colors = false,
                               const std::string& more = pictures, Warnings* warnings = nullptr,
                               const LoadOptions& options = {}) {
    Model m;
    m.add_triangle();
    m.add<float>({0, 0, 1, 0, 0, 1}, "VEC2");
    m.add<float>({1, 0, 0, 0.5f, 0, 1, 0, 0.5f, 0, 0, 1, 1}, "VEC4");
    test::MemoryFiles files;
    add_picture(files);
    return load_model(m.text(R"("meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1)" +
                             std::string(colors ? R"(, "COLOR_0": 2)" : "") +
                             R"(}, "material": 0}]}], "nodes": [{"mesh": 0}], "materials": [{)" + material +
                             "}]" + more),
                      warnings, options, &files);
}

const ImageTexture& picture_of(const SceneDescription& d, Index spectrum_texture) {
    return std::get<ImageTexture>(d.scene.spectrum_textures.at(spectrum_texture));
}

TEST(GltfMaterials, AlphaModes) {
    const std::string half = R"("pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.25]})";
    const auto alpha = [](const std::string& material) {
        return with_material(material).scene.shapes.at(0).alpha;
    };
    EXPECT_EQ(alpha(half).value, 1);
    EXPECT_EQ(alpha(half + R"(, "alphaMode": "BLEND")").value, 0.25f);
    EXPECT_EQ(alpha(half + R"(, "alphaMode": "MASK")").value, 0);
    EXPECT_EQ(alpha(half + R"(, "alphaMode": "MASK", "alphaCutoff": 0.25)").value, 1);
}

TEST(GltfMaterials, AlphaOfPictures) {
    const SceneDescription d =
        with_material(R"("alphaMode": "MASK", "alphaCutoff": 0.3, "pbrMetallicRoughness": {
        "baseColorTexture": {"index": 0}, "baseColorFactor": [1, 1, 1, 0.5]})",
                      true);
    const auto& step = std::get<StepTexture>(d.scene.float_textures.at(d.scene.shapes.at(0).alpha.texture));
    EXPECT_EQ(step.edge, 0.3f);
    const auto& alpha = std::get<ImageTexture>(d.scene.float_textures.at(step.input.texture));
    EXPECT_EQ(alpha.scale, 0.5f);
    EXPECT_TRUE(alpha.vertex_colors);
    // The picture's own alpha, without a decoding.
    const Image& image = d.scene.images.at(alpha.image);
    EXPECT_EQ(image.channels(), 1);
    EXPECT_EQ(image.encoding(), ColorEncoding::linear());
    EXPECT_EQ(image.u8()[1], 16 * 7);
}

TEST(GltfMaterials, MissingPicturesHaveStandIns) {
    for (const std::string uri : {"gone.png", "../outside.png"}) {
        Warnings warnings;
        const SceneDescription d = with_material(
            R"("pbrMetallicRoughness": {"baseColorTexture": {"index": 0},
                "metallicRoughnessTexture": {"index": 0}}, "normalTexture": {"index": 0})",
            false, R"(, "images": [{"uri": ")" + uri + R"("}], "textures": [{"source": 0}])", &warnings);
        ASSERT_GE(warnings.messages().size(), 2u);
        EXPECT_NE(warnings.messages()[0].find("/images/0/uri: "), std::string::npos)
            << warnings.messages()[0];
        EXPECT_NE(warnings.messages()[0].find("; magenta stands for the picture"), std::string::npos);
        const auto& m = std::get<PrincipledMaterial>(d.scene.materials.at(0));
        const auto texel = [&](const ImageTexture& t, std::size_t channel) {
            return int{d.scene.images.at(t.image).u8()[channel]};
        };
        const ImageTexture& color = picture_of(d, m.base_color.texture);
        EXPECT_EQ(texel(color, 0), 255);
        EXPECT_EQ(texel(color, 1), 0);
        EXPECT_EQ(texel(color, 2), 255);
        EXPECT_EQ(texel(std::get<ImageTexture>(d.scene.float_textures.at(m.roughness.texture)), 1), 255);
        EXPECT_EQ(texel(d.scene.normal_maps.at(m.detail.normal_map.map), 2), 255);
        EXPECT_EQ(texel(d.scene.normal_maps.at(m.detail.normal_map.map), 0), 128);
    }
}

TEST(GltfMaterials, EmissionIsInCandelaPerSquareMetre) {
    const SceneDescription d = with_material(R"("emissiveFactor": [0.5, 0.25, 1], "doubleSided": true,
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 8}})");
    const auto& light = std::get<AreaLight>(d.scene.lights.at(0));
    EXPECT_TRUE(light.two_sided);
    const Spectrum s = spectrum_of(light.spectrum, d.scene.spectra);
    EXPECT_NEAR(to_photometric(s) * double(light.scale), 1, 1e-5);
    const auto& rgb = std::get<RgbIlluminantSpectrum>(s.kind());
    const RgbIlluminantSpectrum expected(RgbColorSpace::srgb(), {4, 2, 8});
    for (const float lambda : {450.0f, 550.0f, 650.0f}) EXPECT_FLOAT_EQ(rgb(lambda), expected(lambda));
    EXPECT_TRUE(with_material("").scene.lights.empty());
}

TEST(GltfMaterials, EmissivePicturesAreMultiplied) {
    const SceneDescription d =
        with_material(R"("emissiveTexture": {"index": 0}, "emissiveFactor": [1, 0.5, 0])");
    const auto& light = std::get<AreaLight>(d.scene.lights.at(0));
    EXPECT_FALSE(light.two_sided);
    const Image& map = d.scene.environments.at(light.picture);
    EXPECT_FLOAT_EQ(map.value(1, 1, 0), srgb_to_linear(192 / 255.0f));
    EXPECT_FLOAT_EQ(map.value(1, 1, 1), 0.5f * srgb_to_linear(208 / 255.0f));
    EXPECT_EQ(map.value(1, 1, 2), 0);
}

TEST(GltfMaterials, UnlitSurfacesEmitTheirColour) {
    const SceneDescription d = with_material(
        R"("extensions": {"KHR_materials_unlit": {}}, "pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0, 1]})");
    EXPECT_EQ(d.scene.lights.size(), 1u);
    EXPECT_EQ(std::get<DiffuseMaterial>(d.scene.materials.at(0)).reflectance.value.constant, 0);
}

// A tenth of red is left after 2 m, all of green and blue.
TEST(GltfMaterials, VolumesAbsorb) {
    const SceneDescription d =
        with_material(R"("extensions": {"KHR_materials_transmission": {"transmissionFactor": 1},
        "KHR_materials_volume": {"thicknessFactor": 1, "attenuationDistance": 2, "attenuationColor": [0.1, 0.1, 0.1]}})");
    const Index inside = d.scene.shapes.at(0).media.inside;
    const auto& medium = std::get<HomogeneousMedium>(d.scene.media.at(inside));
    const Spectrum sigma = spectrum_of(medium.sigma_a, d.scene.spectra);
    EXPECT_NEAR(std::exp(-2 * double(medium.scale) * double(sigma(550.0f))), 0.1, 1e-3);
    EXPECT_EQ(medium.sigma_s.constant, 0);
    EXPECT_EQ(d.scene.shapes.at(0).media.outside, no_index);
    // Without thickness there is no inside.
    EXPECT_EQ(with_material(R"("extensions": {"KHR_materials_volume": {"attenuationDistance": 2,
        "attenuationColor": [0.1, 0.1, 0.1]}})")
                  .scene.shapes.at(0)
                  .media.inside,
              no_index);
}

TEST(GltfMaterials, Variants) {
    Model m;
    m.add_triangle();
    const std::string text = m.text(R"("materials": [{"name": "oak"}, {"name": "red paint"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0, "extensions": {
        "KHR_materials_variants": {"mappings": [{"material": 1, "variants": [1]}]}}}]}], "nodes": [{"mesh": 0}],
        "extensions": {"KHR_materials_variants": {"variants": [{"name": "plain"}, {"name": "red"}]}})");
    EXPECT_EQ(load_model(text).scene.material_names.at(0), "oak");
    EXPECT_EQ(load_model(text, nullptr, {.variant = "plain"}).scene.material_names.at(0), "oak");
    EXPECT_EQ(load_model(text, nullptr, {.variant = "red"}).scene.material_names.at(0), "red paint");
}

TEST(GltfMaterials, CoatsHaveTheirOwnNormalMap) {
    Warnings warnings;
    const SceneDescription d = with_material(R"("normalTexture": {"index": 0}, "extensions": {
        "KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatNormalTexture": {"index": 0, "scale": 0.5}}})",
                                             false, pictures, &warnings);
    const auto& m = std::get<PrincipledMaterial>(d.scene.materials.at(0));
    EXPECT_EQ(d.scene.normal_maps.at(m.detail.normal_map.map).factor, Vec3f(1, 1, 1));
    EXPECT_EQ(d.scene.normal_maps.at(m.clearcoat_normal_map.map).factor, Vec3f(0.5f, 0.5f, 1));
    EXPECT_TRUE(warnings.messages().empty());
}

TEST(GltfMaterials, NormalMaps) {
    const SceneDescription d = with_material(R"("normalTexture": {"index": 0, "scale": 0.5})");
    const ImageTexture& map = d.scene.normal_maps.at(0);
    EXPECT_EQ(map.factor, Vec3f(0.5f, 0.5f, 1));
    EXPECT_EQ(d.scene.images.at(map.image).encoding(), ColorEncoding::linear());
}

TEST(GltfMaterials, Samplers) {
    const auto wraps = [](const std::string& sampler) {
        const SceneDescription d = with_material(
            R"("pbrMetallicRoughness": {"baseColorTexture": {"index": 0}})", false,
            R"(, "images": [{"uri": "a%20b.png"}], "textures": [{"source": 0)" + sampler +
                R"(}], "samplers": [{"magFilter": 9728, "wrapS": 33071, "wrapT": 33648}, {"magFilter": 9729}])");
        return picture_of(d, 0);
    };
    EXPECT_EQ(wraps("").wrap, TextureWraps(TextureWrap::repeat));
    EXPECT_EQ(wraps(R"(, "sampler": 0)").wrap, TextureWraps(TextureWrap::clamp, TextureWrap::mirror));
    EXPECT_EQ(wraps(R"(, "sampler": 0)").filter, TextureFilter::point);
    EXPECT_EQ(wraps(R"(, "sampler": 1)").filter, TextureFilter::trilinear);
}

// At the file's (0.25, 0.5): its v grows downwards.
TEST(GltfMaterials, TextureTransforms) {
    const auto place = [](const std::string& transform) {
        const SceneDescription d = with_material(R"("pbrMetallicRoughness": {"baseColorTexture": {"index": 0,
            "extensions": {"KHR_texture_transform": {)" +
                                                 transform + "}}}}");
        const TextureContext at{
            .p = {}, .n = {}, .uv = {0.25f, 0.5f}, .dpdx = {}, .dpdy = {}, .duvdx = {}, .duvdy = {}};
        const Point2f st = picture_of(d, 0).mapping(at).st;
        return Vec2f(st.x, 1 - st.y); // as the file counts
    };
    const auto expect = [](Vec2f found, Vec2f expected) { EXPECT_LT(length(found - expected), 1e-6f); };
    expect(place(""), {0.25f, 0.5f});
    expect(place(R"("offset": [0.1, 0.2], "scale": [2, 3])"), {0.6f, 1.7f});
    const float c = std::cos(0.5f), s = std::sin(0.5f);
    expect(place(R"("offset": [0.1, 0.2], "scale": [2, 3], "rotation": 0.5)"),
           {0.1f + c * 0.5f + s * 1.5f, 0.2f - s * 0.5f + c * 1.5f});
}

// The picture that emits, or else the base colour's, is mapped by the first set.
TEST(GltfMaterials, TwoSetsOfTextureCoordinates) {
    Model m;
    m.add_triangle();
    m.add<float>({0, 0, 1, 0, 0, 1}, "VEC2");
    m.add<float>({5, 5, 6, 5, 5, 6}, "VEC2");
    test::MemoryFiles files;
    add_picture(files);
    Warnings warnings;
    const auto load = [&](const std::string& material) {
        warnings = {};
        return load_model(
            m.text(
                R"("meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1, "TEXCOORD_1": 2},
                "material": 0}]}], "nodes": [{"mesh": 0}], "materials": [{)" +
                material + "}]" + pictures),
            &warnings, {}, &files);
    };
    const std::string base_1 = R"("pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "texCoord": 1}})";
    SceneDescription d =
        load(base_1 + R"(, "normalTexture": {"index": 0}, "occlusionTexture": {"index": 0, "texCoord": 2})");
    EXPECT_EQ(d.scene.meshes.at(0).uvs.at(0), Point2f(5, -4));
    EXPECT_EQ(d.scene.meshes.at(0).second_uvs.at(0), Point2f(0, 1));
    EXPECT_TRUE(d.scene.normal_maps.at(0).mapping.second_uv);
    EXPECT_FALSE(picture_of(d, 0).mapping.second_uv);
    EXPECT_TRUE(warnings.messages().empty());

    d = load(base_1 + R"(, "emissiveTexture": {"index": 0}, "emissiveFactor": [1, 1, 1])");
    EXPECT_EQ(d.scene.meshes.at(0).uvs.at(0), Point2f(0, 1));
    EXPECT_EQ(d.scene.meshes.at(0).second_uvs.at(0), Point2f(5, -4));
    EXPECT_TRUE(picture_of(d, 0).mapping.second_uv);

    d = load(base_1);
    EXPECT_TRUE(d.scene.meshes.at(0).second_uvs.empty());
    EXPECT_FALSE(picture_of(d, 0).mapping.second_uv);

    d = load(base_1 + R"(, "normalTexture": {"index": 0},
        "extensions": {"KHR_materials_clearcoat": {"clearcoatTexture": {"index": 0, "texCoord": 3}}})");
    EXPECT_EQ(warnings.messages().at(0),
              "folder/model.gltf: /materials/0/extensions/KHR_materials_clearcoat/clearcoatTexture: uses "
              "TEXCOORD_3, the third set of the material; it gets TEXCOORD_1");
}

} // namespace
} // namespace montelux
