// RGB colour spaces: primaries, white, and the matrices that follow.
#pragma once

#include <span>
#include <string_view>

#include "montelux/spectrum/cie.h"
#include "montelux/spectrum/matrix3.h"
#include "montelux/spectrum/spectrum_table.h"

namespace montelux {

class RgbColorSpace {
  public:
    // `illuminant` is the relative power of the white light; it is scaled so that its luminance
    // (integral against cie_y over cie_y_integral) is 1.
    RgbColorSpace(std::string_view name, Vec2d red, Vec2d green, Vec2d blue, const SpectrumTable& illuminant);

    static const RgbColorSpace& srgb();       // IEC 61966-2-1, linear; also ITU-R BT.709
    static const RgbColorSpace& dci_p3();     // P3 primaries with the white D65 (SMPTE EG 432-1)
    static const RgbColorSpace& rec2020();    // ITU-R BT.2020
    static const RgbColorSpace& aces2065_1(); // SMPTE ST 2065-1

    std::string_view name() const { return name_; }
    Vec2d red() const { return red_; }
    Vec2d green() const { return green_; }
    Vec2d blue() const { return blue_; }
    Vec2d white() const { return white_; }
    // RGB (1, 1, 1) has this spectrum.
    const SpectrumTable& illuminant() const { return illuminant_; }
    const Matrix3& xyz_from_rgb() const { return xyz_from_rgb_; }
    const Matrix3& rgb_from_xyz() const { return rgb_from_xyz_; }
    // Weights of R, G and B in the luminance Y; their sum is 1.
    Vec3d luminance_weights() const { return xyz_from_rgb_.rows[1]; }

  private:
    std::string_view name_;
    Vec2d red_, green_, blue_, white_;
    SpectrumTable illuminant_;
    Matrix3 xyz_from_rgb_, rgb_from_xyz_;
};

// The names of the four spaces above.
std::span<const std::string_view> rgb_color_space_names();
// Null when there is no such space; case does not matter.
const RgbColorSpace* find_rgb_color_space(std::string_view name);

// Linear RGB of one space to linear RGB of another, without chromatic adaptation.
Matrix3 convert_rgb(const RgbColorSpace& from, const RgbColorSpace& to);

} // namespace montelux
