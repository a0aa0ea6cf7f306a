#include "montelux/image/texel_format.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <limits>

#include "montelux/image/half.h"
#include "montelux/mc/math/error.h"

namespace montelux {

namespace {

struct FormatName {
    TexelFormat format;
    std::string_view name;
    std::size_t bytes;
};
constexpr std::array<FormatName, 7> format_names{{{TexelFormat::rgba16f, "rgba16f", 8},
                                                  {TexelFormat::rgba32f, "rgba32f", 16},
                                                  {TexelFormat::rg16f, "rg16f", 4},
                                                  {TexelFormat::rg32f, "rg32f", 8},
                                                  {TexelFormat::rgb9e5, "rgb9e5", 4},
                                                  {TexelFormat::r11g11b10f, "r11g11b10f", 4},
                                                  {TexelFormat::rgbm8, "rgbm8", 4}}};

const FormatName& entry_of(TexelFormat format) { return format_names[static_cast<std::size_t>(format)]; }

void count_too_large(float v, TexelLosses& losses) {
    ++losses.too_large;
    losses.largest = std::max(losses.largest, std::abs(v));
}

float without_nan(float v, TexelLosses& losses) {
    if (!std::isnan(v)) return v;
    ++losses.not_number;
    return 0;
}

float not_negative(float v, TexelLosses& losses) {
    v = without_nan(v, losses);
    if (v >= 0) return v;
    ++losses.negative;
    return 0;
}

void put16(std::vector<std::uint8_t>& bytes, std::uint32_t v) {
    bytes.push_back(static_cast<std::uint8_t>(v));
    bytes.push_back(static_cast<std::uint8_t>(v >> 8));
}
void put32(std::vector<std::uint8_t>& bytes, std::uint32_t v) {
    put16(bytes, v & 0xffffu);
    put16(bytes, v >> 16);
}

void put_half(std::vector<std::uint8_t>& bytes, float v, TexelLosses& losses) {
    std::uint16_t h = float_to_half(without_nan(v, losses));
    if ((h & 0x7fffu) == 0x7c00u) {
        count_too_large(v, losses);
        --h; // the largest finite half of this sign
    }
    put16(bytes, h);
}

void put_float(std::vector<std::uint8_t>& bytes, float v, TexelLosses& losses) {
    v = without_nan(v, losses);
    if (std::isinf(v)) {
        count_too_large(v, losses);
        v = std::copysign(std::numeric_limits<float>::max(), v);
    }
    put32(bytes, std::bit_cast<std::uint32_t>(v));
}

// Five bits of exponent with bias 15, `mantissa` bits below them, no sign (OpenGL 4.6 core, 2.3.4.3-4).
std::uint32_t small_float(float v, int mantissa, TexelLosses& losses) {
    v = not_negative(v, losses);
    const std::uint32_t infinity = 31u << mantissa;
    std::uint32_t code = infinity;
    if (v < 0x1p-14f) {
        code = static_cast<std::uint32_t>(std::nearbyint(std::ldexp(v, 14 + mantissa)));
    } else if (v < 65536) {
        const int shift = 23 - mantissa;
        const auto bits = std::bit_cast<std::uint32_t>(v);
        const std::uint32_t rounded = bits + (1u << (shift - 1)) - 1 + ((bits >> shift) & 1u);
        code = (rounded - (112u << 23)) >> shift;
    }
    if (code < infinity) return code;
    count_too_large(v, losses);
    return infinity - 1;
}

// OpenGL 4.6 core, 8.5.2: N = 9, B = 15, E_max = 31.
std::uint32_t shared_exponent(const std::array<float, 3>& light, TexelLosses& losses) {
    constexpr float largest = 65408;
    std::array<float, 3> v;
    for (std::size_t c = 0; c < 3; ++c) {
        v[c] = not_negative(light[c], losses);
        if (v[c] <= largest) continue;
        count_too_large(v[c], losses);
        v[c] = largest;
    }
    const float most = std::max({v[0], v[1], v[2]});
    int exponent = 0;
    if (most >= 0x1p-16f) exponent = std::ilogb(most) + 16;
    // Rounding may carry the largest over to 512.
    if (std::floor(std::ldexp(most, 24 - exponent) + 0.5f) >= 512) ++exponent;
    std::uint32_t code = static_cast<std::uint32_t>(exponent) << 27;
    for (int c = 0; c < 3; ++c) {
        const auto m = static_cast<std::uint32_t>(std::floor(std::ldexp(v[c], 24 - exponent) + 0.5f));
        code |= m << (9 * c);
    }
    return code;
}

std::array<std::uint8_t, 4> rgbm(const std::array<float, 3>& light, const RgbmScale& scale,
                                 TexelLosses& losses) {
    std::array<double, 3> v;
    for (std::size_t c = 0; c < 3; ++c) {
        double x = not_negative(light[c], losses);
        if (scale.power == 2) x = std::sqrt(x);
        v[c] = x / scale.range;
        if (v[c] <= 1) continue;
        count_too_large(light[c], losses);
        v[c] = 1;
    }
    const double most = std::max({v[0], v[1], v[2]});
    // The margin keeps a product of two bytes from needing the next M by a rounding error.
    const double m = std::clamp(std::ceil(most * 255 - 1e-6), 1.0, 255.0);
    std::array<std::uint8_t, 4> texel;
    for (std::size_t c = 0; c < 3; ++c)
        texel[c] = static_cast<std::uint8_t>(std::min(std::lround(v[c] * 255 * 255 / m), 255L));
    texel[3] = static_cast<std::uint8_t>(m);
    return texel;
}

std::array<int, 3> light_channels(std::string_view where, const Image& image) {
    const std::vector<int> colors = image.color_channels();
    if (colors.size() == 3) return {colors[0], colors[1], colors[2]};
    if (colors.size() == 1) return {colors[0], colors[0], colors[0]};
    throw Error(where, "the picture has neither the channels R, G, B nor Y");
}

std::array<float, 3> light_at(const Image& image, int x, int y, const std::array<int, 3>& channels) {
    return {image.linear(x, y, channels[0]), image.linear(x, y, channels[1]),
            image.linear(x, y, channels[2])};
}

} // namespace

std::string_view name_of(TexelFormat format) { return entry_of(format).name; }
std::size_t bytes_per_texel(TexelFormat format) { return entry_of(format).bytes; }

std::optional<TexelFormat> texel_format_named(std::string_view name) {
    for (const FormatName& entry : format_names)
        if (entry.name == name) return entry.format;
    return {};
}

void check_rgbm_scale(std::string_view where, const RgbmScale& scale) {
    if (!(scale.range >= 1 && scale.range <= 65536)) {
        char text[80];
        std::snprintf(text, sizeof text, "the range of RGBM is %g; expected 1 to 65536", scale.range);
        throw Error(where, text);
    }
    if (scale.power != 1 && scale.power != 2)
        throw Error(where, "the power of RGBM is " + std::to_string(scale.power) + "; expected 1 or 2");
}

TexelLosses& TexelLosses::operator+=(const TexelLosses& other) {
    too_large += other.too_large;
    negative += other.negative;
    not_number += other.not_number;
    largest = std::max(largest, other.largest);
    return *this;
}

std::string TexelLosses::sentence(TexelFormat format) const {
    std::string text;
    const std::string name(name_of(format));
    auto say = [&](std::uint64_t count, const std::string& what) {
        if (count == 0) return;
        if (!text.empty()) text += "; ";
        text += std::to_string(count) + (count == 1 ? " value was " : " values were ") + what;
    };
    char most[32];
    std::snprintf(most, sizeof most, "%.4g", static_cast<double>(largest));
    say(too_large, "larger than " + name + " can hold (up to " + most + ") and became its largest number");
    say(negative, "negative and became 0, for " + name + " has no sign");
    say(not_number, "not a number and became 0");
    return text;
}

void append_texels(std::vector<std::uint8_t>& bytes, std::string_view where, const Image& image,
                   TexelFormat format, const RgbmScale& scale, TexelLosses& losses) {
    bytes.reserve(bytes.size() + image.pixel_count() * bytes_per_texel(format));
    auto each_pixel = [&](auto&& put) {
        for (int y = 0; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x) put(x, y);
    };
    if (format == TexelFormat::rg16f || format == TexelFormat::rg32f) {
        const auto r = image.find_channel("R"), g = image.find_channel("G");
        if (!r || !g) throw Error(where, "the picture lacks the channels R and G");
        const auto put = format == TexelFormat::rg16f ? put_half : put_float;
        each_pixel([&](int x, int y) {
            put(bytes, image.linear(x, y, *r), losses);
            put(bytes, image.linear(x, y, *g), losses);
        });
        return;
    }
    const std::array<int, 3> colors = light_channels(where, image);
    if (format == TexelFormat::rgba16f || format == TexelFormat::rgba32f) {
        const auto alpha = image.find_channel("A");
        const auto put = format == TexelFormat::rgba16f ? put_half : put_float;
        each_pixel([&](int x, int y) {
            for (int c : colors) put(bytes, image.linear(x, y, c), losses);
            put(bytes, alpha ? image.linear(x, y, *alpha) : 1.0f, losses);
        });
        return;
    }
    each_pixel([&](int x, int y) {
        const std::array<float, 3> light = light_at(image, x, y, colors);
        if (format == TexelFormat::rgb9e5) {
            put32(bytes, shared_exponent(light, losses));
        } else if (format == TexelFormat::r11g11b10f) {
            const std::uint32_t r = small_float(light[0], 6, losses), g = small_float(light[1], 6, losses),
                                b = small_float(light[2], 5, losses);
            put32(bytes, r | g << 11 | b << 22);
        } else {
            const std::array<std::uint8_t, 4> texel = rgbm(light, scale, losses);
            bytes.insert(bytes.end(), texel.begin(), texel.end());
        }
    });
}

Image rgbm_picture(const Image& image, const RgbmScale& scale, TexelLosses& losses) {
    check_rgbm_scale("RGBM", scale);
    std::vector<std::uint8_t> bytes;
    append_texels(bytes, "RGBM", image, TexelFormat::rgbm8, scale, losses);
    Image picture(image.width(), image.height(), {"R", "G", "B", "A"}, PixelFormat::u8,
                  ColorEncoding::srgb());
    std::copy(bytes.begin(), bytes.end(), picture.u8().begin());
    return picture;
}

} // namespace montelux
