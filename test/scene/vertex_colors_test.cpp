// Colours and opacities of a mesh's vertices, and the textures that read them: channels, factors, steps, wraps per axis.
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "montelux/scene/build/scene_builder.h"
#include "montelux/scene/scene_tables.h"
#include "montelux/scene/shape/alpha.h"
#include "montelux/scene/shape/surface_point.h"
#include "montelux/scene/texture/evaluate.h"

namespace montelux {
namespace {

// A triangle whose vertices are red, green and blue, and 1, 0 and 0.5 opaque.
TriangleMesh colored_triangle() {
    TriangleMesh m{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}, {{0, 0}, {1, 0}, {0, 1}}, {0, 1, 2}};
    m.colors = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    m.opacities = {1, 0, 0.5f};
    return m;
}

Hit hit_in_the_middle() {
    Hit h;
    h.t = 1;
    h.b1 = 0.5f;
    h.b2 = 0.25f;
    h.shape = 0;
    return h;
}

const Ray ray_down{{0.5f, 0.25f, 1}, {0, 0, -1}};

Scene scene_of_texture(const ImageTexture& t, Image image) {
    Scene s;
    s.meshes.push_back(colored_triangle());
    s.materials = {DiffuseMaterial{}};
    s.shapes = {{.geometry = MeshIndex{0}, .material = 0}};
    s.world_shapes = {0};
    s.images.push_back(std::move(image));
    s.float_textures = {t};
    s.spectrum_textures = {t};
    return s;
}

Image one_texel(std::array<float, 4> rgba) {
    Image image(1, 1, {"R", "G", "B", "A"});
    std::copy(rgba.begin(), rgba.end(), image.f32().begin());
    return image;
}

TEST(VertexColors, AreInterpolated) {
    Scene s = scene_of_texture({.image = 0, .mapping = {}}, one_texel({1, 1, 1, 1}));
    const SurfacePoint p = surface_point(SceneView(s), ray_down, hit_in_the_middle(), true);
    EXPECT_EQ(p.vertex_color, Vec3f(0.25f, 0.5f, 0.25f));
    EXPECT_EQ(p.vertex_opacity, 0.375f);
    s.meshes[0].colors = {};
    s.meshes[0].opacities = {};
    const SurfacePoint plain = surface_point(SceneView(s), ray_down, hit_in_the_middle(), true);
    EXPECT_EQ(plain.vertex_color, Vec3f(1, 1, 1));
    EXPECT_EQ(plain.vertex_opacity, 1);
}

TextureContext colored(Vec3f color, float opacity) {
    return {.p = {},
            .n = {0, 0, 1},
            .uv = {0.5f, 0.5f},
            .dpdx = {},
            .dpdy = {},
            .duvdx = {},
            .duvdy = {},
            .vertex_color = color,
            .vertex_opacity = opacity};
}

void expect_same(SampledSpectrum a, const RgbAlbedoSpectrum& b, const SampledWavelengths& lambda) {
    const SampledSpectrum expected = b.sample(lambda);
    for (int i = 0; i < spectrum_samples; ++i) EXPECT_FLOAT_EQ(a[i], expected[i]);
}

// Products are taken in RGB, before the conversion to a spectrum.
TEST(VertexColors, MultiplyTextures) {
    const SampledWavelengths lambda = SampledWavelengths::sample_visible(0.3f);
    const RgbColorSpace& srgb = RgbColorSpace::srgb();
    ImageTexture t{.image = 0, .mapping = {}};
    t.factor = {0.5f, 1, 0.25f};
    t.vertex_colors = true;
    const Scene s = scene_of_texture(t, one_texel({0.8f, 0.6f, 0.4f, 1}));
    const SceneTables tables(s);
    expect_same(evaluate_texture(tables.view(), s.spectrum_textures[0], colored({0.5f, 0.5f, 1}, 1), lambda),
                RgbAlbedoSpectrum(srgb, {0.2f, 0.3f, 0.1f}), lambda);
    // As a number: the mean of the channels, times the opacity.
    EXPECT_FLOAT_EQ(evaluate_texture(tables.view(), s.float_textures[0], colored({0, 0, 0}, 0.5f)),
                    (0.4f + 0.6f + 0.1f) / 3 * 0.5f);
    const SpectrumTexture alone = VertexColorTexture{{0.5f, 1, 1}};
    expect_same(evaluate_texture(tables.view(), alone, colored({0.4f, 0.3f, 0.2f}, 1), lambda),
                RgbAlbedoSpectrum(srgb, {0.2f, 0.3f, 0.2f}), lambda);
    const FloatTexture opacity = VertexColorTexture{{0.5f, 0, 0}};
    EXPECT_FLOAT_EQ(evaluate_texture(tables.view(), opacity, colored({0, 0, 0}, 0.6f)), 0.3f);
}

TEST(VertexColors, CutOut) {
    Scene s = scene_of_texture({.image = 0, .mapping = {}}, one_texel({1, 1, 1, 1}));
    s.float_textures = {VertexColorTexture{}, StepTexture{{0, 0}, 0.375f}, StepTexture{{0, 0}, 0.376f}};
    const SceneTables tables(s);
    const auto alpha = [&](Index texture) {
        s.shapes[0].alpha = {0, texture};
        return alpha_at(tables.view(), ray_down, hit_in_the_middle());
    };
    EXPECT_FLOAT_EQ(alpha(0), 0.375f);
    EXPECT_EQ(alpha(1), 1);
    EXPECT_EQ(alpha(2), 0);
}

TEST(ImageTexture, OneChannel) {
    const auto value = [](ImageChannels channels) {
        ImageTexture t{.image = 0, .mapping = {}};
        t.channels = channels;
        const Scene s = scene_of_texture(t, one_texel({0.5f, 0.75f, 1, 0.125f}));
        const SceneTables tables(s);
        return evaluate_texture(tables.view(), s.float_textures[0], colored({1, 1, 1}, 1));
    };
    EXPECT_EQ(value(ImageChannels::red), 0.5f);
    EXPECT_EQ(value(ImageChannels::green), 0.75f);
    EXPECT_EQ(value(ImageChannels::blue), 1);
    EXPECT_EQ(value(ImageChannels::alpha), 0.125f);
    EXPECT_EQ(value(ImageChannels::color), 0.75f);
    EXPECT_FLOAT_EQ(value(ImageChannels::angle), static_cast<float>(std::numbers::pi / 2)); // of (0, 0.5)
}

TEST(TextureMapping, Affine) {
    TextureMapping m;
    m.kind = TextureMapping::Kind::affine;
    m.vs = {2, 3, 0};
    m.vt = {-1, 4, 0};
    m.du = 0.5f;
    m.dv = 7;
    TextureContext at = colored({1, 1, 1}, 1);
    at.uv = {10, 100};
    at.duvdx = {1, 0};
    at.duvdy = {0, 1};
    const TextureCoordinates c = m(at);
    EXPECT_EQ(c.st, Point2f(320.5f, 397));
    EXPECT_EQ(c.dstdx, Vec2f(2, -1));
    EXPECT_EQ(c.dstdy, Vec2f(3, 4));
}

// Four texels in a row, repeated along s in one way, the top and bottom rows along t in another.
TEST(MipMap, WrapsOfTheirOwnAlongBothAxes) {
    Image image(4, 2, {"Y"});
    for (int i = 0; i < 8; ++i) image.set(i % 4, i / 4, 0, static_cast<float>(i));
    const MipMap map(image);
    const auto at = [&](int x, int y, TextureWraps wrap) {
        return map
            .lookup({(static_cast<float>(x) + 0.5f) / 4, 1 - (static_cast<float>(y) + 0.5f) / 2}, {}, {},
                    TextureFilter::point, wrap, 8)
            .x;
    };
    constexpr TextureWrap mirror = TextureWrap::mirror, repeat = TextureWrap::repeat,
                          clamp = TextureWrap::clamp;
    const std::array<float, 12> mirrored{3, 2, 1, 0, 0, 1, 2, 3, 3, 2, 1, 0};
    for (int x = -4; x < 8; ++x) {
        EXPECT_EQ(at(x, 0, mirror), mirrored[static_cast<std::size_t>(x + 4)]) << x;
        EXPECT_EQ(at(x - 8, 0, mirror), at(x, 0, mirror)) << x;
    }
    EXPECT_EQ(at(5, 3, {repeat, clamp}), 5);
    EXPECT_EQ(at(5, -1, {clamp, repeat}), 7);
    EXPECT_EQ(at(5, 2, {clamp, mirror}), 7);
}

TEST(VertexColors, AreChecked) {
    const auto error = [](const TriangleMesh& mesh) -> std::string {
        try {
            check_geometry(mesh);
        } catch (const Error& e) {
            return e.what();
        }
        return {};
    };
    EXPECT_EQ(error(colored_triangle()), "");
    TriangleMesh m = colored_triangle();
    m.colors.pop_back();
    EXPECT_EQ(error(m), "the mesh has 2 colours for 3 vertices; expected one per vertex");
    m = colored_triangle();
    m.opacities.push_back(0);
    EXPECT_EQ(error(m), "the mesh has 4 opacities for 3 vertices; expected one per vertex");
    m = colored_triangle();
    m.colors[1].y = -1;
    EXPECT_EQ(error(m), "the colour of a vertex is negative or not finite");
    m = colored_triangle();
    m.opacities[1] = 1.5f;
    EXPECT_EQ(error(m), "the opacity of a vertex is not between 0 and 1");
}

} // namespace
} // namespace montelux
