// Sensors of digital cameras by the names that pbrt-v4 scene files use: measured responses, and their colours.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "montelux/spectrum/matrix3.h"
#include "montelux/spectrum/rgb_colorspace.h"
#include "montelux/spectrum/spectrum_table.h"

namespace montelux {

// The CIE 1931 observer, the sensor of films without another.
inline constexpr std::string_view cie_sensor = "cie1931";

// cie1931, then the cameras in alphabetical order.
const std::vector<std::string_view>& sensor_names();

// Relative response of the three channels at each nanometre.
struct CameraSensor {
    SpectrumTable r, g, b;

    // Linear RGB of a spectrum, by the sum over 1 nm samples.
    template <typename F>
    Vec3d integrate(F&& f) const {
        Vec3d rgb;
        for (int i = 0; i < visible_samples; ++i)
            rgb += response(i) * static_cast<double>(f(lambda_min + static_cast<float>(i)));
        return rgb;
    }
    // At 360 + i nm.
    Vec3d response(int i) const { return Vec3d(Vec3f(r.values()[i], g.values()[i], b.values()[i])); }
};

// Empty for other names, and for cie1931.
std::optional<CameraSensor> find_camera_sensor(std::string_view name);

// The matrix from `integrate` to XYZ that a camera's software would use for scenes lit by `light`: the least squares of
// the 24 patches of the ColorChecker chart between RGB under `light` and XYZ under `white`, the white of the picture
// (Pharr, Jakob, Humphreys 2023, "Physically Based Rendering", section 5.4.2). So `light` is balanced to `white`. A
// perfect reflector under `light` has the luminance of the CIE's observer.
Matrix3 xyz_from_camera(const CameraSensor& sensor, const SpectrumTable& light, const SpectrumTable& white);

// Reflectances of the patches; 0 outside 380 to 730 nm.
const std::vector<SpectrumTable>& color_checker_patches();

} // namespace montelux
