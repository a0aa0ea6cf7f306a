#include "montelux/spectrum/sensor.h"

#include "montelux/mc/math/error.h"
#include "montelux/mc/math/nearest_name.h"
#include "montelux/spectrum/illuminants.h"
#include "montelux/spectrum/spectrum_table.h"

namespace montelux {

Matrix3 chromatic_adaptation(Vec2d from_white, Vec2d to_white) {
    const Matrix3 lms_from_xyz{
        {{{0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}}}};
    Vec3d from = lms_from_xyz * xyz_from_chromaticity(from_white);
    Vec3d to = lms_from_xyz * xyz_from_chromaticity(to_white);
    return lms_from_xyz.inverse() * Matrix3::diagonal({to.x / from.x, to.y / from.y, to.z / from.z}) *
           lms_from_xyz;
}

Sensor::Sensor(const RgbColorSpace& space, const SensorSettings& settings)
    : imaging_ratio_(settings.exposure_time * settings.iso / 100) {
    Matrix3 balance;
    if (settings.name != cie_sensor) {
        camera_ = find_camera_sensor(settings.name);
        if (!camera_)
            throw Error("sensor", "unknown sensor '" + settings.name + "'" +
                                      did_you_mean(settings.name, sensor_names()));
        const float temperature = settings.white_balance > 0 ? settings.white_balance : 6500;
        balance = xyz_from_camera(*camera_, daylight(temperature), space.illuminant());
    } else if (settings.white_balance > 0) {
        Vec2d source = chromaticity(integrate_xyz(daylight(settings.white_balance)));
        balance = chromatic_adaptation(source, space.white());
    }
    double ratio = static_cast<double>(imaging_ratio_);
    rgb_from_sensor_ = Matrix3::diagonal({ratio, ratio, ratio}) * space.rgb_from_xyz() * balance;
    for (int i = 0; i < visible_samples; ++i) {
        Vec3d rgb = rgb_from_sensor_ * (camera_ ? camera_->response(i) : cie_xyz(i)) * 0.25;
        response_[i] =
            Float4{static_cast<float>(rgb.x), static_cast<float>(rgb.y), static_cast<float>(rgb.z), 0};
    }
}

Vec3f Sensor::to_rgb(SampledSpectrum radiance, const SampledWavelengths& w) const {
    Int4 i = nearest_samples(w.lambda);
    SampledSpectrum weighted = safe_div(radiance, w.pdf);
    Float4 rgb = weighted[0] * response_[i[0]] + weighted[1] * response_[i[1]] +
                 weighted[2] * response_[i[2]] + weighted[3] * response_[i[3]];
    return {rgb[0], rgb[1], rgb[2]};
}

} // namespace montelux
