#include "montelux/image/tone_curve.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "montelux/mc/math/error.h"

namespace montelux {

namespace {

// Rows.
using Rows = std::array<Vec3f, 3>;

Vec3f times(const Rows& m, Vec3f v) { return {dot(m[0], v), dot(m[1], v), dot(m[2], v)}; }

template <typename F>
Vec3f each(Vec3f v, F f) {
    return {f(v.x), f(v.y), f(v.z)};
}

// NaN becomes 0.
float clipped(float v) { return !(v > 0) ? 0.0f : std::min(v, 1.0f); }

Vec3f encoded(Vec3f light) {
    return each(light, [](float v) {
        const float c = clipped(v);
        return c < 1 ? linear_to_srgb(c) : 1.0f;
    });
}

// "ACES fitted" of S. Hill in M. Pettineo and D. Neubelt, "BakingLab" (2016), ACES.hlsl: sRGB to AP1 with the
// reference rendering transform's desaturation, a rational fit of RRT and ODT, and back to sRGB. Without BakingLab's
// factor 1.8 and three.js' 1 / 0.6, which are exposures.
Vec3f aces(Vec3f light) {
    static constexpr Rows in = {
        {{0.59719f, 0.35458f, 0.04823f}, {0.07600f, 0.90834f, 0.01566f}, {0.02840f, 0.13383f, 0.83777f}}};
    static constexpr Rows out = {{{1.60475f, -0.53108f, -0.07367f},
                                  {-0.10208f, 1.10813f, -0.00605f},
                                  {-0.00327f, -0.07276f, 1.07602f}}};
    const Vec3f fit = each(times(in, light), [](float v) {
        return (v * (v + 0.0245786f) - 0.000090537f) / (v * (0.983729f * v + 0.4329510f) + 0.238081f);
    });
    return encoded(times(out, fit));
}

// B. Wrensch, "Minimal AgX Implementation" (2023): T. Sobotka's AgX without looks, whose contrast curve is a polynomial
// of degree 6. It ends in a display of gamma 2.2, which becomes light and then sRGB, as on an sRGB render target.
Vec3f agx(Vec3f light) {
    static constexpr Rows in = {{{0.842479062253094f, 0.0784335999999992f, 0.0792237451477643f},
                                 {0.0423282422610123f, 0.878468636469772f, 0.0791661274605434f},
                                 {0.0423756549057051f, 0.0784336f, 0.879142973793104f}}};
    static constexpr Rows out = {{{1.19687900512017f, -0.0980208811401368f, -0.0990297440797205f},
                                  {-0.0528968517574562f, 1.15190312990417f, -0.0989611768448433f},
                                  {-0.0529716355144438f, -0.0980434501171241f, 1.15107367264116f}}};
    static constexpr float least = -12.47393f, most = 4.026069f; // log2 of light
    const Vec3f contrast = each(times(in, light), [](float v) {
        const float x = (std::clamp(std::log2(v), least, most) - least) / (most - least);
        return -0.00232f +
               x * (0.1191f + x * (0.4298f + x * (-6.868f + x * (31.96f + x * (-40.14f + x * 15.5f)))));
    });
    return encoded(each(times(out, contrast), [](float v) { return std::pow(clipped(v), 2.2f); }));
}

// J. Hable, "Filmic Tonemapping Operators" (2010): shoulder strength A, linear strength B and angle C, toe strength D,
// numerator E and denominator F, linear white W; light is doubled first, as there.
Vec3f filmic(Vec3f light) {
    constexpr float a = 0.15f, b = 0.50f, c = 0.10f, d = 0.20f, e = 0.02f, f = 0.30f, white = 11.2f, bias = 2;
    constexpr auto curve = [](float x) {
        // At x = 0 the quotient rounds to d e / (d f), not to e / f.
        return (x * (a * x + c * b) + d * e) / (x * (a * x + b) + d * f) - d * e / (d * f);
    };
    return encoded(each(light, [&](float v) { return curve(bias * v) / curve(white); }));
}

} // namespace

const std::vector<std::string_view>& tone_names() {
    static const std::vector<std::string_view> names = {"linear", "srgb", "aces", "agx", "filmic"};
    return names;
}

std::optional<ToneKind> tone_named(std::string_view name) {
    const std::vector<std::string_view>& names = tone_names();
    for (std::size_t i = 0; i < names.size(); ++i)
        if (names[i] == name) return static_cast<ToneKind>(i);
    return {};
}

Vec3f ToneCurve::operator()(Vec3f rgb) const {
    const float scale = std::exp2(exposure);
    // Beyond the bound all curves have ended; it keeps their squares finite.
    const Vec3f light = each(rgb, [scale](float v) { return v > 0 ? std::min(v * scale, 1e9f) : 0.0f; });
    switch (kind) {
    case ToneKind::linear:
        return each(light, clipped);
    case ToneKind::aces:
        return aces(light);
    case ToneKind::agx:
        return agx(light);
    case ToneKind::filmic:
        return filmic(light);
    case ToneKind::srgb:
        break;
    }
    return encoded(light);
}

float ToneCurve::operator()(float light) const {
    const Vec3f grey = (*this)(Vec3f{light, light, light});
    return 0.2126f * grey.x + 0.7152f * grey.y + 0.0722f * grey.z;
}

namespace {

std::uint16_t code_of(float encoded, int bits) {
    return static_cast<std::uint16_t>(std::lround(encoded * (bits == 8 ? 255.0f : 65535.0f)));
}

} // namespace

Image apply_tone_curve(const Image& image, const ToneCurve& curve, int bits) {
    if (bits != 8 && bits != 16)
        throw Error("tone curve", "a picture can have 8 or 16 bits, not " + std::to_string(bits));
    const std::vector<int> colors = image.color_channels();
    if (colors.empty()) throw Error("tone curve", "the image has neither the channels R, G, B nor Y");
    std::vector<std::string> names;
    names.reserve(colors.size() + 1);
    for (int c : colors) names.push_back(image.channel_names()[c]);
    const std::optional<int> alpha = image.find_channel("A");
    if (alpha) names.emplace_back("A");
    Image out(image.width(), image.height(), names, bits == 8 ? PixelFormat::u8 : PixelFormat::u16,
              curve.encoding());
    const std::span<std::uint8_t> bytes = out.u8();
    const std::span<std::uint16_t> words = out.u16();
    std::size_t i = 0;
    const auto put = [&](std::uint16_t code) {
        if (bits == 8)
            bytes[i++] = static_cast<std::uint8_t>(code);
        else
            words[i++] = code;
    };
    const float scale = std::exp2(curve.exposure);
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            if (bits == 8 && curve.kind == ToneKind::srgb) { // a table in place of powers
                for (int c : colors) put(linear_to_srgb8(image.linear(x, y, c) * scale));
            } else if (colors.size() == 1) {
                put(code_of(curve(image.linear(x, y, colors[0])), bits));
            } else {
                const Vec3f code = curve(Vec3f{image.linear(x, y, colors[0]), image.linear(x, y, colors[1]),
                                               image.linear(x, y, colors[2])});
                for (int c = 0; c < 3; ++c) put(code_of(code[c], bits));
            }
            if (alpha) put(code_of(clipped(image.linear(x, y, *alpha)), bits));
        }
    return out;
}

} // namespace montelux
