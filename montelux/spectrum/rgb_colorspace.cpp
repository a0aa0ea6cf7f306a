#include "montelux/spectrum/rgb_colorspace.h"

#include <algorithm>
#include <array>

#include "montelux/spectrum/illuminants.h"

namespace montelux {

namespace {

constexpr std::array<std::string_view, 4> names{"srgb", "dci-p3", "rec2020", "aces2065-1"};

char to_lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool equal_ignoring_case(std::string_view a, std::string_view b) {
    return std::ranges::equal(a, b, {}, to_lower, to_lower);
}

SpectrumTable unit_luminance(SpectrumTable t) {
    t.scale(static_cast<float>(cie_y_integral / integrate_luminance(t)));
    return t;
}

} // namespace

RgbColorSpace::RgbColorSpace(std::string_view name, Vec2d red, Vec2d green, Vec2d blue,
                             const SpectrumTable& illuminant)
    : name_(name), red_(red), green_(green), blue_(blue), illuminant_(unit_luminance(illuminant)) {
    Vec3d w = integrate_xyz(illuminant_);
    white_ = chromaticity(w);
    // The columns are the primaries, scaled so that they add up to the white.
    Matrix3 primaries =
        Matrix3{{{xyz_from_chromaticity(red), xyz_from_chromaticity(green), xyz_from_chromaticity(blue)}}}
            .transposed();
    xyz_from_rgb_ = primaries * Matrix3::diagonal(primaries.inverse() * w);
    rgb_from_xyz_ = xyz_from_rgb_.inverse();
}

const RgbColorSpace& RgbColorSpace::srgb() {
    static const RgbColorSpace space("srgb", {0.64, 0.33}, {0.3, 0.6}, {0.15, 0.06}, illuminant_d65());
    return space;
}
const RgbColorSpace& RgbColorSpace::dci_p3() {
    static const RgbColorSpace space("dci-p3", {0.68, 0.32}, {0.265, 0.69}, {0.15, 0.06}, illuminant_d65());
    return space;
}
const RgbColorSpace& RgbColorSpace::rec2020() {
    static const RgbColorSpace space("rec2020", {0.708, 0.292}, {0.17, 0.797}, {0.131, 0.046},
                                     illuminant_d65());
    return space;
}
const RgbColorSpace& RgbColorSpace::aces2065_1() {
    static const RgbColorSpace space("aces2065-1", {0.7347, 0.2653}, {0, 1}, {0.0001, -0.077},
                                     illuminant_aces_d60());
    return space;
}

std::span<const std::string_view> rgb_color_space_names() { return names; }

const RgbColorSpace* find_rgb_color_space(std::string_view name) {
    if (equal_ignoring_case(name, "srgb")) return &RgbColorSpace::srgb();
    if (equal_ignoring_case(name, "dci-p3")) return &RgbColorSpace::dci_p3();
    if (equal_ignoring_case(name, "rec2020")) return &RgbColorSpace::rec2020();
    if (equal_ignoring_case(name, "aces2065-1")) return &RgbColorSpace::aces2065_1();
    return nullptr;
}

Matrix3 convert_rgb(const RgbColorSpace& from, const RgbColorSpace& to) {
    return to.rgb_from_xyz() * from.xyz_from_rgb();
}

} // namespace montelux
