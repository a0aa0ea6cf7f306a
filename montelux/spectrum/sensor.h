// From spectral radiance to linear RGB: the camera's sensor, with exposure and white balance.
#pragma once

#include <array>
#include <string>

#include "montelux/spectrum/camera_sensors.h"
#include "montelux/spectrum/rgb_colorspace.h"
#include "montelux/spectrum/wavelengths.h"

namespace montelux {

// Exposure of a sensor. The defaults do not change values.
struct SensorSettings {
    float exposure_time = 1; // seconds the shutter is open
    float iso = 100;         // sensitivity
    // Colour temperature (K) of the light that appears white; 0: no white balance.
    float white_balance = 0;
    // One of sensor_names().
    std::string name{cie_sensor};
};

// The CIE 1931 observer as a sensor, or that of a camera, whose white balance is 6500 K where none is given. Lights are
// divided by their integral against the CIE's Y
// (to_photometric), so an RGB light of (1, 1, 1) gives RGB (1, 1, 1).
class Sensor {
  public:
    // Throws Error for an unknown sensor.
    explicit Sensor(const RgbColorSpace& space = RgbColorSpace::srgb(), const SensorSettings& settings = {});

    // Unbiased estimate of linear RGB from radiance at sampled wavelengths: the mean of
    // imaging_ratio M rgbbar(lambda_i) L_i / pdf_i over the four wavelengths. Terminated wavelengths count 0.
    Vec3f to_rgb(SampledSpectrum radiance, const SampledWavelengths& w) const;

    // exposure_time iso / 100.
    float imaging_ratio() const { return imaging_ratio_; }
    // Linear RGB of a spectrum by quadrature, as the expectation of to_rgb.
    template <typename F>
    Vec3d integrate_rgb(F&& radiance) const {
        if (camera_) return rgb_from_sensor_ * camera_->integrate(radiance);
        return rgb_from_sensor_ * (integrate_xyz(radiance) * cie_y_integral);
    }

  private:
    std::optional<CameraSensor> camera_; // empty: the CIE's observer
    Matrix3 rgb_from_sensor_;            // with white balance and imaging ratio
    float imaging_ratio_;
    // One quarter of the response of R, G and B at each nanometre, ready to be summed over four wavelengths.
    std::array<Float4, visible_samples> response_;
};

// The map of XYZ that sends one white to another: Bradford's method (Lam 1985; CIE 159:2004, CIECAM97s).
Matrix3 chromatic_adaptation(Vec2d from_white, Vec2d to_white);

} // namespace montelux
