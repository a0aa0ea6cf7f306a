// Textures against values computed by hand. Nothing here is random except fixed draws.
#include <cmath>
#include <gtest/gtest.h>

#include "montelux/mc/stats/chi_squared.h"
#include "montelux/scene/scene_tables.h"
#include "montelux/scene/texture/evaluate.h"

namespace montelux {
namespace {

// Texel (x, y) of a gray picture, row 0 on top.
float texel(int x, int y) { return static_cast<float>((x * 37 + y * 11) % 17) / 17; }

Image gray_image(int width, int height) {
    Image image(width, height, {"Y"});
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) image.set(x, y, 0, texel(x, y));
    return image;
}

constexpr Vec2f no_step{0, 0};
constexpr TextureFilter all_filters[] = {TextureFilter::point, TextureFilter::bilinear,
                                         TextureFilter::trilinear, TextureFilter::ewa};

// The centre of texel (x, y).
Vec2f center(const Image& image, int x, int y) {
    return {(static_cast<float>(x) + 0.5f) / static_cast<float>(image.width()),
            1 - (static_cast<float>(y) + 0.5f) / static_cast<float>(image.height())};
}

TEST(MipMap, TexelsStandUpright) {
    Image image = gray_image(6, 4);
    MipMap map(image);
    for (TextureFilter filter : all_filters)
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 6; ++x)
                EXPECT_NEAR(
                    map.lookup(center(image, x, y), no_step, no_step, filter, TextureWrap::repeat, 8).x,
                    texel(x, y), 1e-5)
                    << int(filter);
}

TEST(MipMap, WrapModes) {
    Image image = gray_image(6, 4);
    MipMap map(image);
    auto at = [&](int x, int y, TextureWrap wrap, TextureFilter filter) {
        return map.lookup(center(image, x, y), no_step, no_step, filter, wrap, 8).x;
    };
    for (TextureFilter filter : {TextureFilter::point, TextureFilter::bilinear}) {
        for (auto [x, y] : {std::pair{-1, 2}, {6, 0}, {13, -9}, {-20, 5}}) {
            EXPECT_NEAR(at(x, y, TextureWrap::repeat, filter), texel(((x % 6) + 6) % 6, ((y % 4) + 4) % 4),
                        1e-5);
            EXPECT_NEAR(at(x, y, TextureWrap::clamp, filter), texel(std::clamp(x, 0, 5), std::clamp(y, 0, 3)),
                        1e-5);
        }
        EXPECT_EQ(at(-2, 2, TextureWrap::black, filter), 0);
        EXPECT_EQ(at(2, 5, TextureWrap::black, filter), 0);
        EXPECT_NEAR(at(2, 3, TextureWrap::black, filter), texel(2, 3), 1e-5);
    }
    // Half a texel beyond the edge of a black border.
    EXPECT_NEAR(map.lookup({0, center(image, 0, 2).y}, no_step, no_step, TextureFilter::bilinear,
                           TextureWrap::black, 8)
                    .x,
                0.5 * texel(0, 2), 1e-5);
    // A step over an octahedral edge comes back mirrored.
    Image square = gray_image(8, 8);
    MipMap sphere(square);
    EXPECT_NEAR(sphere
                    .lookup(center(square, -1, 2), no_step, no_step, TextureFilter::point,
                            TextureWrap::octahedral_sphere, 8)
                    .x,
                texel(0, 5), 1e-6);
    EXPECT_NEAR(sphere
                    .lookup(center(square, 3, 8), no_step, no_step, TextureFilter::point,
                            TextureWrap::octahedral_sphere, 8)
                    .x,
                texel(4, 7), 1e-6);
}

TEST(MipMap, BilinearIsLinearBetweenTexels) {
    Image image = gray_image(6, 4);
    MipMap map(image);
    Vec2f a = center(image, 2, 1), b = center(image, 3, 2);
    for (float s : {0.0f, 0.25f, 0.8f})
        for (float t : {0.1f, 0.6f}) {
            Vec2f st{a.x + s * (b.x - a.x), a.y + t * (b.y - a.y)};
            float expected = (1 - s) * (1 - t) * texel(2, 1) + s * (1 - t) * texel(3, 1) +
                             (1 - s) * t * texel(2, 2) + s * t * texel(3, 2);
            EXPECT_NEAR(map.lookup(st, no_step, no_step, TextureFilter::bilinear, TextureWrap::repeat, 8).x,
                        expected, 1e-5);
        }
}

// What covers the whole picture sees its mean, whatever the size; every level keeps the mean.
TEST(MipMap, LevelsKeepTheMean) {
    for (int size : {1, 4, 16, 64}) {
        Image image = gray_image(size, size);
        double mean = 0;
        for (float v : image.f32()) mean += double(v) / static_cast<double>(image.pixel_count());
        MipMap map(image);
        for (TextureFilter filter : {TextureFilter::trilinear, TextureFilter::ewa})
            EXPECT_NEAR(map.lookup({0.3f, 0.6f}, {4, 0}, {0, 4}, filter, TextureWrap::repeat, 8).x, mean,
                        1e-5)
                << size;
        // The mean of lookups at the texel centres of a level is the mean of the level.
        for (int cells = size; cells >= 1; cells /= 2) {
            double sum = 0;
            float step = 0.5f / static_cast<float>(cells);
            for (int y = 0; y < cells; ++y)
                for (int x = 0; x < cells; ++x)
                    sum += double(map.lookup({(static_cast<float>(x) + 0.5f) / static_cast<float>(cells),
                                              (static_cast<float>(y) + 0.5f) / static_cast<float>(cells)},
                                             {step, 0}, {0, step}, TextureFilter::trilinear,
                                             TextureWrap::repeat, 8)
                                      .x);
            EXPECT_NEAR(sum / (cells * cells), mean, 1e-5) << size << " at " << cells;
        }
    }
}

// Levels have half as many texels, rounded down: the last ones of odd sizes take three.
TEST(MipMap, CoarserLevelsOfOddSizesUseEveryTexel) {
    // The finest level with 2 x 2 texels; its values are those of the point filter.
    const Image five = gray_image(5, 5);
    const MipMap map(five);
    const auto mean = [&](int x0, int y0, int x1, int y1) {
        double sum = 0;
        for (int y = y0; y < y1; ++y)
            for (int x = x0; x < x1; ++x) sum += double(texel(x, y));
        return sum / ((x1 - x0) * (y1 - y0));
    };
    const auto at = [&](float s, float t) {
        return map.lookup({s, t}, {0.25f, 0}, {0, 0.25f}, TextureFilter::point, TextureWrap::clamp, 8).x;
    };
    EXPECT_NEAR(at(0.25f, 0.75f), mean(0, 0, 2, 2), 1e-6);
    EXPECT_NEAR(at(0.75f, 0.75f), mean(2, 0, 5, 2), 1e-6);
    EXPECT_NEAR(at(0.25f, 0.25f), mean(0, 2, 2, 5), 1e-6);
    EXPECT_NEAR(at(0.75f, 0.25f), mean(2, 2, 5, 5), 1e-6);
    // Each texel of three counts by a third, in rows and in columns.
    for (auto [width, height] : {std::pair{3, 1}, {1, 3}, {3, 3}})
        for (int i = 0; i < width * height; ++i) {
            Image dot(width, height, {"Y"});
            dot.set(i % width, i / width, 0, 1);
            EXPECT_NEAR(
                MipMap(dot)
                    .lookup({0.5f, 0.5f}, {1, 0}, {0, 1}, TextureFilter::trilinear, TextureWrap::clamp, 8)
                    .x,
                1.0 / (width * height), 1e-6)
                << width << " x " << height << ", texel " << i;
        }
}

TEST(MipMap, FiltersKeepConstants) {
    Image image(32, 8, {"R", "G", "B"});
    for (std::size_t i = 0; i < image.pixel_count(); ++i)
        for (std::size_t c = 0; c < 3; ++c) image.f32()[3 * i + c] = 0.2f * static_cast<float>(c + 1);
    MipMap map(image);
    TestUniforms uniforms(3);
    for (int i = 0; i < 2000; ++i) {
        Vec2f st = uniforms.next_2f(), d0 = uniforms.next_2f(), d1 = uniforms.next_2f();
        float scale = std::exp2(-10 * uniforms.next_float());
        for (TextureFilter filter : all_filters)
            for (TextureWrap wrap : {TextureWrap::repeat, TextureWrap::clamp}) {
                Vec3f v = map.lookup(st, d0 * scale, {-d1.x * scale, d1.y * scale}, filter, wrap, 8);
                for (int c = 0; c < 3; ++c) ASSERT_NEAR(v[c], 0.2f * static_cast<float>(c + 1), 2e-5);
            }
    }
}

// A footprint that is long one way blurs that way alone: stripes across it vanish, stripes along it stay.
TEST(MipMap, EwaIsAnisotropic) {
    Image stripes(128, 128, {"Y"});
    for (int y = 0; y < 128; ++y)
        for (int x = 0; x < 128; ++x) stripes.set(x, y, 0, (x / 4) % 2 == 0 ? 1 : 0);
    MipMap map(stripes);
    Vec2f in_a_stripe{66.0f / 128, 0.5f};
    Vec2f shorter{1.0f / 128, 0}, longer{0, 8.0f / 128};
    float along = map.lookup(in_a_stripe, shorter, longer, TextureFilter::ewa, TextureWrap::repeat, 16).x;
    float across =
        map.lookup(in_a_stripe, {longer.y, 0}, {0, shorter.x}, TextureFilter::ewa, TextureWrap::repeat, 16).x;
    float isotropic =
        map.lookup(in_a_stripe, shorter, longer, TextureFilter::trilinear, TextureWrap::repeat, 16).x;
    EXPECT_GT(along, 0.8);
    EXPECT_NEAR(across, 0.5, 0.2);
    EXPECT_NEAR(isotropic, 0.5, 0.2);
}

// Stripes on the diagonal, whichever axis of the footprint is the long one. Rows of a picture run downwards: both axes
// are mirrored.
TEST(MipMap, SlantedFootprintsFollowThePicture) {
    Image stripes(128, 128, {"Y"});
    for (int y = 0; y < 128; ++y)
        for (int x = 0; x < 128; ++x) stripes.set(x, y, 0, ((x - y + 128) / 8) % 2 == 0 ? 1 : 0);
    const MipMap map(stripes);
    const Vec2f in_a_stripe{68.0f / 128, 1 - 64.5f / 128};
    const Vec2f down{1.0f / 128, -1.0f / 128}, up{1.0f / 128, 1.0f / 128}; // along the stripes, and across
    const auto value = [&](Vec2f dst0, Vec2f dst1) {
        return map.lookup(in_a_stripe, dst0, dst1, TextureFilter::ewa, TextureWrap::repeat, 16).x;
    };
    for (float length : {8.0f, 12.0f}) {
        EXPECT_GT(value(down * length, up), 0.9) << length;
        EXPECT_GT(value(up, down * length), 0.9) << length;
        EXPECT_LT(value(up * length, down), 0.7) << length;
        EXPECT_LT(value(down, up * length), 0.7) << length;
    }
}

TEST(MipMap, FarAwayAndNotANumber) {
    Image image = gray_image(4, 4);
    MipMap map(image);
    for (float s : {1e30f, -1e7f, std::nanf(""), std::numeric_limits<float>::infinity()})
        for (TextureFilter filter : all_filters)
            EXPECT_TRUE(
                std::isfinite(map.lookup({s, 0.5f}, {0.1f, 0}, {0, 0.1f}, filter, TextureWrap::repeat, 8).x));
}

TextureContext at(Vec2f uv, Vec3f p = {}, Vec2f duvdx = {}, Vec2f duvdy = {}) {
    return {.p = p, .n = {0, 0, 1}, .uv = uv, .dpdx = {}, .dpdy = {}, .duvdx = duvdx, .duvdy = duvdy};
}

TEST(TextureMapping, Kinds) {
    TextureMapping m;
    m.su = 2;
    m.sv = -3;
    m.du = 0.5f;
    m.dv = 0.25f;
    TextureCoordinates c = m(at({0.2f, 0.4f}, {}, {0.1f, 0}, {0, 0.2f}));
    EXPECT_FLOAT_EQ(c.st.x, 0.9f);
    EXPECT_FLOAT_EQ(c.st.y, -0.95f);
    EXPECT_FLOAT_EQ(c.dstdx.x, 0.2f);
    EXPECT_FLOAT_EQ(c.dstdy.y, -0.6f);
    m.kind = TextureMapping::Kind::planar;
    m.vs = {0, 2, 0};
    m.vt = {0, 0, 1};
    m.texture_from_world = Transform::translate({0, 0, 1});
    c = m(at({}, {9, 1, 2}));
    EXPECT_FLOAT_EQ(c.st.x, 2.5f);
    EXPECT_FLOAT_EQ(c.st.y, 3.25f);
    m.texture_from_world = {};
    m.kind = TextureMapping::Kind::spherical;
    c = m(at({}, {0, 2, 0}));
    EXPECT_FLOAT_EQ(c.st.x, 0.5f);  // theta over pi
    EXPECT_FLOAT_EQ(c.st.y, 0.25f); // phi over 2 pi
    m.kind = TextureMapping::Kind::cylindrical;
    c = m(at({}, {0, 2, 7}));
    EXPECT_FLOAT_EQ(c.st.x, 0.75f);
    EXPECT_FLOAT_EQ(c.st.y, 7);
}

// Steps of the footprint across the seam of the angle are short.
TEST(TextureMapping, NoStepAcrossTheSeam) {
    for (auto kind : {TextureMapping::Kind::spherical, TextureMapping::Kind::cylindrical}) {
        TextureMapping m;
        m.kind = kind;
        for (float x : {1.0f, -1.0f}) {
            TextureContext c = at({}, {x, -1e-4f, 0.2f});
            c.dpdx = {0, 2e-4f, 0};
            c.dpdy = {0, 0, 1e-3f};
            TextureCoordinates st = m(c);
            EXPECT_LT(std::abs(st.dstdx.x) + std::abs(st.dstdx.y), 1e-4f);
            EXPECT_GT(std::abs(st.dstdx.x) + std::abs(st.dstdx.y), 1e-5f);
        }
    }
}

class FloatTextures : public ::testing::Test {
  protected:
    FloatParameter add(FloatTexture t) {
        scene_.float_textures.push_back(std::move(t));
        return {0, static_cast<Index>(scene_.float_textures.size() - 1)};
    }
    float value(const FloatParameter& p, const TextureContext& c) {
        SceneTables tables(scene_);
        return evaluate(tables.view(), p, c);
    }
    FloatParameter checks(int dimension = 2) {
        CheckerboardTexture<FloatParameter> t;
        t.dimension = dimension;
        t.values = {FloatParameter{2}, FloatParameter{6}};
        return add(t);
    }
    Scene scene_;
};

TEST_F(FloatTextures, ConstantScaleAndMix) {
    FloatParameter constant = add(ConstantTexture<FloatParameter>{FloatParameter{3}});
    FloatParameter scaled = add(ScaleTexture<FloatParameter>{constant, FloatParameter{0.5f}});
    FloatParameter mixed = add(MixTexture<FloatParameter>{scaled, FloatParameter{7}, FloatParameter{0.25f}});
    FloatParameter nested = add(
        MixTexture<FloatParameter>{mixed, constant, add(ConstantTexture<FloatParameter>{FloatParameter{1}})});
    TextureContext c = at({0, 0});
    EXPECT_FLOAT_EQ(value(FloatParameter{4}, c), 4);
    EXPECT_FLOAT_EQ(value(scaled, c), 1.5f);
    EXPECT_FLOAT_EQ(value(mixed, c), 0.75f * 1.5f + 0.25f * 7);
    EXPECT_FLOAT_EQ(value(nested, c), 3);
    EXPECT_EQ(value(add(ScaleTexture<FloatParameter>{constant, FloatParameter{0}}), c), 0);
}

TEST_F(FloatTextures, CheckerboardCells) {
    FloatParameter flat = checks(), solid = checks(3);
    for (int x = -3; x < 4; ++x)
        for (int y = -3; y < 4; ++y) {
            float fx = static_cast<float>(x) + 0.3f, fy = static_cast<float>(y) + 0.6f;
            EXPECT_EQ(value(flat, at({fx, fy})), (x + y) % 2 == 0 ? 2 : 6) << x << ' ' << y;
            for (int z : {-1, 0, 1})
                EXPECT_EQ(value(solid, at({}, {fx, fy, static_cast<float>(z) + 0.5f})),
                          (x + y + z) % 2 == 0 ? 2 : 6);
        }
}

TEST_F(FloatTextures, SharpCheckerboardIsNotFiltered) {
    CheckerboardTexture<FloatParameter> t;
    t.values = {FloatParameter{2}, FloatParameter{6}};
    t.sharp = true;
    const FloatParameter sharp = add(t), filtered = checks();
    TextureContext c = at({0.9f, 0.5f});
    c.duvdx = {0.5f, 0};
    EXPECT_EQ(value(sharp, c), 2);
    EXPECT_GT(value(filtered, c), 2);
}

// The value over a footprint is the mean of the cells under it.
TEST_F(FloatTextures, CheckerboardIsFiltered) {
    FloatParameter flat = checks();
    TestUniforms uniforms(8);
    for (int i = 0; i < 30; ++i) {
        Vec2f u = uniforms.next_2f(), size = uniforms.next_2f();
        Vec2f st{6 * u.x - 3, 6 * u.y - 3}, d{0.05f + 2.5f * size.x, 0.05f + 2.5f * size.y};
        double sum = 0;
        constexpr int n = 200;
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x) {
                double s = double(st.x) + double(d.x) * ((x + 0.5) / n - 0.5);
                double t = double(st.y) + double(d.y) * ((y + 0.5) / n - 0.5);
                sum += (static_cast<int>(std::floor(s)) + static_cast<int>(std::floor(t))) % 2 == 0 ? 2 : 6;
            }
        EXPECT_NEAR(value(flat, at(st, {}, {d.x, 0}, {0, d.y})), sum / (n * n), 0.08);
    }
    EXPECT_NEAR(value(flat, at({0.3f, 0.3f}, {}, {1000.3f, 0}, {0, 1000.3f})), 4, 0.01);
}

TEST_F(FloatTextures, ImagesScaleAndInvert) {
    scene_.images.push_back(gray_image(4, 4));
    ImageTexture image;
    image.image = 0;
    image.filter = TextureFilter::point;
    image.scale = 0.5f;
    Vec2f uv = center(scene_.images[0], 1, 2);
    EXPECT_FLOAT_EQ(value(add(image), at(uv)), 0.5f * texel(1, 2));
    image.invert = true;
    EXPECT_FLOAT_EQ(value(add(image), at(uv)), 1 - 0.5f * texel(1, 2));
    // Never below zero.
    image.scale = 100;
    EXPECT_EQ(value(add(image), at(uv)), 0);
    Image color(1, 1, {"R", "G", "B"});
    color.set(0, 0, 0, 0.1f);
    color.set(0, 0, 1, 0.2f);
    color.set(0, 0, 2, 0.6f);
    scene_.images.push_back(color);
    ImageTexture mean;
    mean.image = 1;
    EXPECT_FLOAT_EQ(value(add(mean), at({0.5f, 0.5f})), 0.3f);
}

// pbrt-v4 undoes the encoding for alpha, too.
TEST_F(FloatTextures, TakeTheAlphaIfRequested) {
    for (PixelFormat format : {PixelFormat::u8, PixelFormat::u16}) {
        scene_.images.clear();
        Image& leaf = scene_.images.emplace_back(2, 2, std::vector<std::string>{"R", "G", "B", "A"}, format,
                                                 ColorEncoding::srgb());
        for (int y = 0; y < 2; ++y)
            for (int x = 0; x < 2; ++x) {
                const std::size_t i = leaf.index(x, y, 3);
                const int alpha = x == 0 ? 255 : y == 0 ? 188 : 0;
                if (format == PixelFormat::u8)
                    leaf.u8()[i] = static_cast<std::uint8_t>(alpha);
                else
                    leaf.u16()[i] = static_cast<std::uint16_t>(alpha * 257);
            }
        ImageTexture t;
        t.image = 0;
        t.filter = TextureFilter::point;
        const double gray = srgb_to_linear(188.0 / 255);
        EXPECT_EQ(value(add(t), at(center(leaf, 0, 0))), 0);
        t.channels = ImageChannels::alpha;
        EXPECT_EQ(value(add(t), at(center(leaf, 0, 0))), 1);
        EXPECT_NEAR(value(add(t), at(center(leaf, 1, 0))), gray, 1e-6);
        EXPECT_EQ(value(add(t), at(center(leaf, 1, 1))), 0);
        for (TextureFilter filter : {TextureFilter::bilinear, TextureFilter::trilinear, TextureFilter::ewa}) {
            t.filter = filter;
            TextureContext far = at({0.5f, 0.5f});
            far.duvdx = {4, 0};
            far.duvdy = {0, 4};
            EXPECT_NEAR(value(add(t), far), (2 + gray) / 4, 1e-5) << static_cast<int>(filter);
        }
    }
}

// The largest image that may be read: products of its size and a place pass 2^31.
TEST(MipMap, CoarserLevelsOfTheWidestImage) {
    Image wide(Image::max_dimension, 1, {"Y"}, PixelFormat::u8);
    for (std::uint8_t& v : wide.u8()) v = 255;
    const MipMap pyramid(wide);
    for (float width : {1e-5f, 4e-5f, 1e-3f, 0.1f, 1.0f})
        for (float x : {0.0f, 0.5f, 0.99999f})
            EXPECT_EQ(
                pyramid.lookup({x, 0.5f}, {width, 0}, {0, 0}, TextureFilter::trilinear, TextureWrap::clamp, 8)
                    .x,
                1);
}

TEST(SpectrumTextures, AreReadAsTheyAreMeant) {
    Scene scene;
    Image image(1, 1, {"R", "G", "B"});
    const Vec3f rgb{0.2f, 0.5f, 0.8f};
    for (int c = 0; c < 3; ++c) image.set(0, 0, c, rgb[c]);
    scene.images.push_back(image);
    SampledWavelengths lambda = SampledWavelengths::sample_visible(0.6f);
    const RgbColorSpace& srgb = RgbColorSpace::srgb();
    for (RgbMeaning meaning : {RgbMeaning::albedo, RgbMeaning::unbounded, RgbMeaning::illuminant}) {
        ImageTexture t;
        t.image = 0;
        t.meaning = meaning;
        scene.spectrum_textures.assign(1, t);
        scene.spectrum_textures.push_back(
            ScaleTexture<SpectrumParameter>{SpectrumParameter{{}, 0}, FloatParameter{2}});
        SceneTables tables(scene);
        SampledSpectrum expected = meaning == RgbMeaning::albedo ? RgbAlbedoSpectrum(srgb, rgb).sample(lambda)
                                   : meaning == RgbMeaning::unbounded
                                       ? RgbUnboundedSpectrum(srgb, rgb).sample(lambda)
                                       : RgbIlluminantSpectrum(srgb, rgb).sample(lambda);
        SampledSpectrum v = evaluate(tables.view(), SpectrumParameter{{}, 0}, at({0.5f, 0.5f}), lambda);
        SampledSpectrum twice = evaluate(tables.view(), SpectrumParameter{{}, 1}, at({0.5f, 0.5f}), lambda);
        for (int i = 0; i < 4; ++i) {
            EXPECT_NEAR(v[i], expected[i], 1e-5f * (1 + expected[i]));
            EXPECT_NEAR(twice[i], 2 * expected[i], 2e-5f * (1 + expected[i]));
        }
    }
}

} // namespace
} // namespace montelux
