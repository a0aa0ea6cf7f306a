// Pixel filters and their importance sampling.
#pragma once

#include <optional>

#include "montelux/mc/dist/piecewise_1d.h"
#include "montelux/scene/film/film_settings.h"

namespace montelux {

// The filter's value at an offset from the centre of the pixel, in pixels; not normalised. Zero outside the
// radius.
float filter_value(const PixelFilter& filter, Vec2f offset);
Vec2f filter_radius(const PixelFilter& filter);

struct FilterSample {
    Vec2f offset;     // from the centre of the pixel
    float weight = 1; // filter over density, scaled to mean 1; negative in negative lobes
};

// Draws film points in proportion to the filter's magnitude, so that each sample counts for one pixel alone
// and samples of different pixels are independent. Ernst, Stamminger, Greiner 2006, "Filter Importance
// Sampling".
class PixelFilterSampler {
  public:
    // Throws Error on radii that are not positive and finite.
    explicit PixelFilterSampler(const PixelFilter& filter);

    FilterSample sample(Vec2f u) const;

  private:
    // Every filter is a product of one factor an axis.
    struct Axis {
        std::optional<PiecewiseLinear1D> density; // absent for box and triangle, which invert in closed form
        float radius = 0.5f;
        float inverse_integral = 1; // of the signed factor
    };
    float sample_axis(const Axis& axis, int which, float u, float& weight) const;

    PixelFilter filter_;
    Axis axes_[2];
};

} // namespace montelux
