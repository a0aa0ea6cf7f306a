// Textures from formulas, and those that mix others by position or direction, at known points.
#include <cmath>
#include <gtest/gtest.h>

#include "montelux/mc/math/gradient_noise.h"
#include "montelux/scene/scene_tables.h"
#include "montelux/scene/texture/evaluate.h"
#include "montelux/scene/texture/procedural.h"

namespace montelux {
namespace {

float value_of(const FloatTexture& t, const TextureContext& c) {
    Scene scene;
    scene.float_textures = {t};
    SceneTables tables(scene);
    return evaluate(tables.view(), FloatParameter{0, 0}, c);
}

TextureContext context_at(Vec2f uv, Point3f p = {}) {
    TextureContext c{};
    c.uv = uv;
    c.p = p;
    return c;
}

TEST(BilerpTexture, CornersAndBetween) {
    BilerpTexture<FloatParameter> t{{}, {{{1}, {2}, {4}, {8}}}};
    EXPECT_FLOAT_EQ(value_of(t, context_at({0, 0})), 1);
    EXPECT_FLOAT_EQ(value_of(t, context_at({1, 0})), 2);
    EXPECT_FLOAT_EQ(value_of(t, context_at({0, 1})), 4);
    EXPECT_FLOAT_EQ(value_of(t, context_at({1, 1})), 8);
    EXPECT_FLOAT_EQ(value_of(t, context_at({0.25f, 0.5f})),
                    (0.75f * 1 + 0.25f * 2 + 0.75f * 4 + 0.25f * 8) / 2);
    t.mapping.su = 0.5f;
    EXPECT_FLOAT_EQ(value_of(t, context_at({1, 0})), 1.5f);
}

TEST(DotsTexture, DiscsInSomeCells) {
    const DotsTexture<FloatParameter> t{{}, {1}, {3}};
    int inside = 0;
    constexpr int n = 1000;
    for (int x = 0; x < n; ++x)
        for (int y = 0; y < n; ++y) {
            const Vec2f st{(static_cast<float>(x) + 0.5f) * 0.064f, (static_cast<float>(y) + 0.5f) * 0.064f};
            const bool in = inside_dot(st);
            inside += in;
            if (x % 100 == 0 && y % 100 == 0) {
                EXPECT_EQ(value_of(t, context_at(st)), in ? 3 : 1);
            }
        }
    // A disc of radius 0.35 where the noise at the cell's corner is positive.
    int cells = 0;
    for (int x = 0; x < 64; ++x)
        for (int y = 0; y < 64; ++y)
            cells += gradient_noise({static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, 0.5f}) > 0;
    EXPECT_GT(cells, 1000);
    EXPECT_NEAR(static_cast<double>(inside) / (n * n), pi * 0.35 * 0.35 * cells / (64 * 64), 0.003);
    // A disc lies within its cell: the edges between cells are empty.
    for (int i = 0; i < n; ++i)
        EXPECT_FALSE(inside_dot({static_cast<float>(i % 30) + 0.5f, static_cast<float>(i) * 0.0317f}));
}

TEST(DirectionMixTexture, CosinesOfTheNormal) {
    const DirectionMixTexture<FloatParameter> t{{2}, {10}, {0, 0, 1}};
    TextureContext c = context_at({});
    for (const float cosine : {1.0f, 0.6f, 0.0f, -0.6f, -1.0f}) {
        c.n = {std::sqrt(1 - cosine * cosine), 0, cosine};
        EXPECT_FLOAT_EQ(value_of(t, c), std::abs(cosine) * 2 + (1 - std::abs(cosine)) * 10);
    }
}

TEST(NoiseTexture, KindsInTextureSpace) {
    NoiseTexture t;
    t.octaves = {.octaves = 5, .roughness = 0.6f};
    t.texture_from_world = Transform::scale({2, 2, 2});
    TextureContext c = context_at({}, {0.37f, 1.21f, -0.4f});
    const Point3f p = c.p * 2;
    EXPECT_FLOAT_EQ(value_of(t, c), fractal_noise(p, t.octaves));
    t.kind = NoiseTexture::Kind::wrinkled;
    EXPECT_FLOAT_EQ(value_of(t, c), turbulence(p, t.octaves));
    t.kind = NoiseTexture::Kind::windy;
    EXPECT_FLOAT_EQ(value_of(t, c), std::abs(fractal_noise(p * 0.1f, {.octaves = 3, .roughness = 0.5f})) *
                                        fractal_noise(p, {.octaves = 6, .roughness = 0.5f}));
    // The footprint, in texture space, takes octaves away: 1/8 of the world is 1/4 of the texture.
    c.dpdx = {0.125f, 0, 0};
    t.kind = NoiseTexture::Kind::fbm;
    EXPECT_FLOAT_EQ(value_of(t, c), gradient_noise(p));
    t.kind = NoiseTexture::Kind::wrinkled;
    EXPECT_FLOAT_EQ(value_of(t, c), turbulence(p, t.octaves, {0.25f, 0, 0}));
}

TEST(MarbleTexture, ColoursOfLayers) {
    MarbleTexture t;
    t.variation = 0; // layers of constant y
    t.scale = 2;
    const auto color_at = [&](float y) { return marble_color(t, context_at({}, {0.3f, y, 0.9f})); };
    // sin = -1: the first control point; sin = 1: the last; 0: where the fourth segment begins.
    const float quarter = 1.57079633f / t.scale;
    const auto expect_near = [](Vec3f c, Vec3f expected) {
        for (int i = 0; i < 3; ++i) EXPECT_NEAR(c[i], expected[i], 1e-4);
    };
    expect_near(color_at(-quarter), Vec3f(0.58f, 0.58f, 0.6f) * 1.5f);
    expect_near(color_at(quarter), Vec3f(0.58f, 0.58f, 0.6f) * 1.5f);
    expect_near(color_at(1e-6f), Vec3f(0.5f, 0.5f, 0.5f) * 1.5f);
    // Two thirds through the last segment: weights 1, 6, 12, 8 over 27.
    const float last = std::asin(2 * (5 + 2.0f / 3) / 6 - 1) / t.scale;
    expect_near(color_at(last),
                (Vec3f(0.58f, 0.58f, 0.6f) * 15 + Vec3f(0.2f, 0.2f, 0.33f) * 12) * (1.5f / 27));
    // Noise bends the layers.
    t.variation = 0.7f;
    const Point3f p{0.3f, 0.1f, 0.9f};
    const float bent = p.y + 0.7f * fractal_noise(p * 2, t.octaves) / 2;
    const Vec3f here = marble_color(t, context_at({}, p));
    t.variation = 0;
    expect_near(here, color_at(bent));

    Scene scene;
    scene.spectrum_textures = {t};
    SceneTables tables(scene);
    const auto lambda = SampledWavelengths::sample_visible(0.4f);
    const SampledSpectrum s = evaluate(tables.view(), SpectrumParameter{{}, 0}, context_at({}, p), lambda);
    const SampledSpectrum expected =
        RgbAlbedoSpectrum(RgbColorSpace::srgb(), marble_color(t, context_at({}, p))).sample(lambda);
    for (int i = 0; i < 4; ++i) EXPECT_FLOAT_EQ(s[i], expected[i]);
}

} // namespace
} // namespace montelux
