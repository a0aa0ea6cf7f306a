#include "montelux/image/color_encoding.h"

#include <algorithm>
#include <cmath>

#include "montelux/mc/math/error.h"

namespace montelux {

double srgb_to_linear(double v) {
    double a = std::abs(v);
    double light = a <= 0.04045 ? a / 12.92 : std::pow((a + 0.055) / 1.055, 2.4);
    return std::copysign(light, v);
}

double linear_to_srgb(double v) {
    // The standard's own threshold, 0.0031308, is the image of 0.04045 rounded; using the image itself keeps
    // the two directions inverse to one another.
    double a = std::abs(v);
    double encoded = a <= 0.04045 / 12.92 ? a * 12.92 : 1.055 * std::pow(a, 1 / 2.4) - 0.055;
    return std::copysign(encoded, v);
}

float srgb_to_linear(float v) { return static_cast<float>(srgb_to_linear(static_cast<double>(v))); }
float linear_to_srgb(float v) { return static_cast<float>(linear_to_srgb(static_cast<double>(v))); }

const std::array<float, 256>& srgb8_to_linear_table() {
    static const std::array<float, 256> table = ColorEncoding::srgb().table8();
    return table;
}

namespace {

// thresholds[i] is the largest float whose code is below i + 1.
std::array<float, 255> make_thresholds() {
    std::array<float, 255> t{};
    auto code = [](float x) {
        return static_cast<int>(std::floor(255 * linear_to_srgb(static_cast<double>(x)) + 0.5));
    };
    for (int i = 0; i < 255; ++i) {
        float x = static_cast<float>(srgb_to_linear((i + 0.5) / 255));
        while (code(x) > i) x = std::nextafter(x, -1.0f);
        while (code(std::nextafter(x, 2.0f)) <= i) x = std::nextafter(x, 2.0f);
        t[i] = x;
    }
    return t;
}

} // namespace

std::uint8_t linear_to_srgb8(float linear) {
    static const std::array<float, 255> thresholds = make_thresholds();
    if (!(linear > 0)) return 0;
    auto at = std::lower_bound(thresholds.begin(), thresholds.end(), linear);
    return static_cast<std::uint8_t>(at - thresholds.begin());
}

ColorEncoding ColorEncoding::gamma(float exponent) {
    if (!(exponent > 0) || !std::isfinite(exponent))
        throw Error("colour encoding",
                    "gamma must be a positive finite number, but is " + std::to_string(exponent));
    return {Kind::gamma, exponent};
}

float ColorEncoding::to_linear(float v) const {
    switch (kind_) {
    case Kind::srgb:
        return srgb_to_linear(v);
    case Kind::gamma:
        return std::copysign(std::pow(std::abs(v), exponent_), v);
    case Kind::linear:
        break;
    }
    return v;
}

float ColorEncoding::from_linear(float v) const {
    switch (kind_) {
    case Kind::srgb:
        return linear_to_srgb(v);
    case Kind::gamma:
        return std::copysign(std::pow(std::abs(v), 1 / exponent_), v);
    case Kind::linear:
        break;
    }
    return v;
}

std::array<float, 256> ColorEncoding::table8() const {
    std::array<float, 256> table{};
    for (int i = 0; i < 256; ++i) table[i] = to_linear(static_cast<float>(i) / 255);
    return table;
}

} // namespace montelux
