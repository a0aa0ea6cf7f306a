// Colour encodings: stored numbers in [0,1] to linear amounts of light, and back.
#pragma once

#include <array>
#include <cstdint>

namespace montelux {

// IEC 61966-2-1, "sRGB": linear light of an encoded value. Negative values go by odd symmetry.
float srgb_to_linear(float encoded);
double srgb_to_linear(double encoded);
// The inverse: srgb_to_linear(linear_to_srgb(x)) == x up to rounding.
float linear_to_srgb(float linear);
double linear_to_srgb(double linear);

// srgb_to_linear(i / 255) for every byte.
const std::array<float, 256>& srgb8_to_linear_table();
// The nearest 8-bit code, clamped; NaN gives 0. Equal to rounding 255 linear_to_srgb(x).
std::uint8_t linear_to_srgb8(float linear);

// What the integers of an image mean. EXR, HDR and PFM hold linear light; integer formats are sRGB unless
// a caller knows better (a scene file may say that a texture is linear, or has a gamma of its own).
class ColorEncoding {
  public:
    enum class Kind { linear, srgb, gamma };

    static constexpr ColorEncoding linear() { return {Kind::linear, 1}; }
    static constexpr ColorEncoding srgb() { return {Kind::srgb, 1}; }
    // light = encoded^gamma; gamma must be positive (2.2 for most pictures). Throws Error otherwise.
    static ColorEncoding gamma(float exponent);

    constexpr Kind kind() const { return kind_; }
    constexpr float exponent() const { return exponent_; }
    float to_linear(float encoded) const;
    float from_linear(float light) const;
    // to_linear(i / 255) for every byte.
    std::array<float, 256> table8() const;
    constexpr bool operator==(const ColorEncoding&) const = default;

  private:
    constexpr ColorEncoding(Kind kind, float exponent) : kind_(kind), exponent_(exponent) {}
    Kind kind_;
    float exponent_;
};

} // namespace montelux
