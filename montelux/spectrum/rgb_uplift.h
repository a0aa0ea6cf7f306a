// From RGB colours in [0, 1] to smooth reflectance spectra, by a table computed when Montelux is built.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "montelux/spectrum/rgb_colorspace.h"
#include "montelux/spectrum/sigmoid_polynomial.h"

namespace montelux {

// Coefficients of sigmoid polynomials on a grid of colours, interpolated between its nodes. The first axis is
// which component is largest, then the value of that component, then the ratios of the other two to it
// (Jakob and Hanika 2019, section 4.2). Three things keep the interpolation error below 1e-3 in RGB:
// - The coefficients are stored times sqrt(Y (1 - Y)), Y the luminance. They grow like 1/sqrt(Y) towards
//   black and like 1/sqrt(1 - Y) towards white; the products stay bounded.
// - Nodes are denser towards 0 and 1 on all three axes (smoothstep).
// - Every node is solved to about 1e-6, without a bound on the coefficients.
class RgbUpliftTable {
  public:
    // A table for a space: resolution^3 x 3 nodes of four floats, the last unused.
    static std::vector<Float4> compute(const RgbColorSpace& space, int resolution);

    // `nodes` comes from `compute` with the same space and resolution, and must outlive the table.
    RgbUpliftTable(const RgbColorSpace& space, int resolution, const Float4* nodes);

    // Components are clamped to [0, 1]; equal components give a constant spectrum.
    SigmoidPolynomial operator()(Vec3f rgb) const;
    int resolution() const { return resolution_; }

  private:
    struct Position {
        int cell;
        float fraction;
    };
    Position locate(float v) const;

    static constexpr int bin_count = 1024;

    int resolution_;
    Vec3f luminance_weights_;
    const Float4* nodes_;
    std::vector<float> grid_, inverse_widths_;
    // For each of bin_count equal parts of [0, 1], the cell that holds its start.
    std::array<std::uint8_t, bin_count + 1> cell_of_bin_{};
};

// The table of a space by its name; throws Error for a space that is not one of the four named ones.
const RgbUpliftTable& rgb_uplift_table(const RgbColorSpace& space);

} // namespace montelux
