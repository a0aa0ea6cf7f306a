// Pixel filters and their importance sampling.
#pragma once

#include <optional>
#include <vector>

#include "montelux/mc/dist/inverse_table_1d.h"
#include "montelux/scene/film/film_settings.h"

namespace montelux {

// The filter's value at an offset from the pixel's centre, in pixels; not normalised. Zero outside the
// radius.
float filter_value(const PixelFilter& filter, Vec2f offset);
Vec2f filter_radius(const PixelFilter& filter);

struct FilterSample {
    Vec2f offset;     // from the centre of the pixel
    float weight = 1; // filter over density, scaled to mean 1; negative in negative lobes
};

// Draws film points in proportion to the filter's magnitude, so each sample belongs to one pixel and samples
// of different pixels are independent. Ernst, Stamminger, Greiner 2006, "Filter Importance Sampling".
class PixelFilterSampler {
  public:
    // Throws Error on radii that are not positive and finite.
    explicit PixelFilterSampler(const PixelFilter& filter);

    FilterSample sample(Vec2f u) const;

    // The filter over its integral, per pixel area, at an offset from the centre: as `sample` means it. Half open at
    // the radius, so that the boxes of neighbouring pixels do not overlap.
    float normalized(Vec2f offset) const {
        return normalized(axes_[0], offset.x) * normalized(axes_[1], offset.y);
    }
    Vec2f radius() const { return {axes_[0].radius, axes_[1].radius}; }

  private:
    // Every filter is a product of one factor per axis.
    struct Axis {
        std::optional<InverseTable1D> density; // absent for box and triangle, which invert in closed form
        std::vector<float> weight;             // the factor over its integral, at equal steps from -radius
        float radius = 0.5f;
        float steps_per_unit = 0;
    };
    float sample_axis(const Axis& axis, float u, float& weight) const;
    float normalized(const Axis& axis, float x) const;

    bool is_box_ = false;
    Axis axes_[2];
};

} // namespace montelux
