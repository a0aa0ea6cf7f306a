// The CIE 1931 standard observer: colour matching functions and integrals against them.
#pragma once

#include <array>

#include "montelux/spectrum/wavelengths.h"

namespace montelux {

// Colour matching functions at 360, 361, ... 830 nm.
extern const std::array<float, visible_samples> cie_x, cie_y, cie_z;

// The three matching functions at 360 + i nm.
inline Vec3d cie_xyz(int i) { return Vec3d(Vec3f(cie_x[i], cie_y[i], cie_z[i])); }

// Integral of cie_y by the sum over its 1 nm samples (nm).
inline constexpr double cie_y_integral = 106.856917101;

// Maximum luminous efficacy of radiation, lm/W.
inline constexpr double luminous_efficacy = 683.0;

// Integral of f(lambda) cie_y(lambda) over the visible range by the sum over 1 nm samples (nm). `f` takes a
// float wavelength in nm.
template <typename F>
double integrate_luminance(F&& f) {
    double y = 0;
    for (int i = 0; i < visible_samples; ++i)
        y += static_cast<double>(cie_y[i]) * static_cast<double>(f(lambda_min + static_cast<float>(i)));
    return y;
}

// Tristimulus values XYZ of f(lambda), scaled so that the equal-energy spectrum 1 has Y = 1.
template <typename F>
Vec3d integrate_xyz(F&& f) {
    Vec3d xyz;
    for (int i = 0; i < visible_samples; ++i)
        xyz += cie_xyz(i) * static_cast<double>(f(lambda_min + static_cast<float>(i)));
    return xyz / cie_y_integral;
}

// Chromaticity (x, y) of tristimulus values whose sum is not 0.
inline Vec2d chromaticity(Vec3d xyz) {
    double s = xyz.x + xyz.y + xyz.z;
    return {xyz.x / s, xyz.y / s};
}
// Tristimulus values of a chromaticity with y > 0 at luminance Y.
inline Vec3d xyz_from_chromaticity(Vec2d xy, double luminance = 1) {
    return {xy.x * luminance / xy.y, luminance, (1 - xy.x - xy.y) * luminance / xy.y};
}

} // namespace montelux
