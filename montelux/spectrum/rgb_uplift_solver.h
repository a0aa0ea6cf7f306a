// Finds the smooth reflectance whose colour under a colour space's white is a given RGB.
#pragma once

#include <array>

#include "montelux/spectrum/rgb_colorspace.h"

namespace montelux {

// Jakob and Hanika 2019, "A Low-Dimensional Function Space for Efficient Spectral Upsampling", section 4: the
// coefficients of the sigmoid polynomial minimise the CIELAB difference by the Gauss-Newton method.
class RgbUpliftSolver {
  public:
    // Coefficients of SigmoidPolynomial in double precision.
    using Coefficients = std::array<double, 3>;

    explicit RgbUpliftSolver(const RgbColorSpace& space);

    // Starts from `c`, which should belong to a colour nearby; {0, 0, 0} is grey 1/2. rgb in [0, 1].
    Coefficients solve(Vec3d rgb, Coefficients c) const;
    // CIELAB difference between the reflectance with the coefficients `c` and a colour.
    double difference(Vec3d rgb, const Coefficients& c) const;
    // Colour of the reflectance with the coefficients `c` under the white of the space.
    Vec3d rgb(const Coefficients& c) const;

  private:
    struct Residual {
        Vec3d lab;                       // CIELAB of the reflectance minus that of the target
        std::array<Vec3d, 3> derivative; // of lab with respect to each coefficient
    };
    Vec3d lab(Vec3d xyz) const;
    Vec3d lab_derivative_scale(Vec3d xyz) const;
    Residual evaluate(const Coefficients& c, Vec3d target_lab) const;

    // Matching functions times the white's power, so that the reflectance 1 has the white's XYZ.
    std::array<std::array<double, visible_samples>, 3> weights_;
    Vec3d white_;
    Matrix3 xyz_from_rgb_, rgb_from_xyz_;
};

} // namespace montelux
