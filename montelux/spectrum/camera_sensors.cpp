#include "montelux/spectrum/camera_sensors.h"

#include <span>

#include "montelux/spectrum/camera_data.h"
#include "montelux/spectrum/cie.h"

namespace montelux {
namespace {

// Values in steps of 10 nm from 380 nm on, joined by straight lines.
SpectrumTable table_of(std::span<const float> values) {
    return SpectrumTable::from([&](float lambda) {
        const float position = (lambda - 380) / 10;
        const auto last = static_cast<float>(values.size() - 1);
        if (!(position >= 0 && position <= last)) return 0.0f;
        const std::size_t i = std::min(static_cast<std::size_t>(position), values.size() - 2);
        const float f = position - static_cast<float>(i);
        return (1 - f) * values[i] + f * values[i + 1];
    });
}

Matrix3 outer(Vec3d a, Vec3d b) { return {{{a.x * b, a.y * b, a.z * b}}}; }

Matrix3 sum(const Matrix3& a, const Matrix3& b) {
    return {{{a.rows[0] + b.rows[0], a.rows[1] + b.rows[1], a.rows[2] + b.rows[2]}}};
}

} // namespace

const std::vector<std::string_view>& sensor_names() {
    static const std::vector<std::string_view> names = [] {
        std::vector<std::string_view> all{cie_sensor};
        for (const measured::CameraResponse& camera : measured::camera_responses) all.push_back(camera.name);
        return all;
    }();
    return names;
}

std::optional<CameraSensor> find_camera_sensor(std::string_view name) {
    for (const measured::CameraResponse& camera : measured::camera_responses)
        if (camera.name == name)
            return CameraSensor{table_of(camera.r), table_of(camera.g), table_of(camera.b)};
    return std::nullopt;
}

const std::vector<SpectrumTable>& color_checker_patches() {
    static const std::vector<SpectrumTable> patches = [] {
        std::vector<SpectrumTable> all;
        all.reserve(measured::color_checker.size());
        for (const auto& patch : measured::color_checker) all.push_back(table_of(patch));
        return all;
    }();
    return patches;
}

Matrix3 xyz_from_camera(const CameraSensor& sensor, const SpectrumTable& light, const SpectrumTable& white) {
    const double light_luminance = integrate_luminance(light), white_luminance = integrate_luminance(white);
    // Normal equations of min sum |M rgb - xyz|^2, with the unknown rows of M in common.
    Matrix3 xyz_rgb = Matrix3::diagonal({}), rgb_rgb = Matrix3::diagonal({});
    for (const SpectrumTable& patch : color_checker_patches()) {
        const Vec3d rgb = sensor.integrate([&](float l) { return patch(l) * light(l); }) / light_luminance;
        const Vec3d xyz =
            integrate_xyz([&](float l) { return patch(l) * white(l); }) * cie_y_integral / white_luminance;
        xyz_rgb = sum(xyz_rgb, outer(xyz, rgb));
        rgb_rgb = sum(rgb_rgb, outer(rgb, rgb));
    }
    return xyz_rgb * rgb_rgb.inverse();
}

} // namespace montelux
