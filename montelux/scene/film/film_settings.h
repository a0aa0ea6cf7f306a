// FilmSettings: resolution, crop, pixel filter and sensor of the film.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <variant>

#include "montelux/mc/math/vec.h"
#include "montelux/scene/film/layer_set.h"

namespace montelux {

// Radii are half widths in pixels. Defaults follow pbrt-v4.
struct BoxFilter {
    Vec2f radius{0.5f, 0.5f};
};
struct TriangleFilter {
    Vec2f radius{2, 2};
};
struct GaussianFilter {
    Vec2f radius{1.5f, 1.5f};
    float sigma = 0.5f;
};
struct MitchellFilter {
    Vec2f radius{2, 2};
    float b = 1.0f / 3, c = 1.0f / 3;
};
struct LanczosFilter {
    Vec2f radius{4, 4};
    float tau = 3;
};
using PixelFilter = std::variant<BoxFilter, TriangleFilter, GaussianFilter, MitchellFilter, LanczosFilter>;

// Half-open rectangle of pixels.
struct PixelBounds {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;

    int width() const { return x1 - x0; }
    int height() const { return y1 - y0; }
    bool operator==(const PixelBounds&) const = default;
};

// Radiance in equal buckets of wavelengths (nm) beside RGB (film/spectral_buckets.h).
struct SpectralSettings {
    static constexpr int most_buckets = 512;

    float lambda_min = 360, lambda_max = 830; // within the range of the visible wavelengths
    int buckets = 16;
};

struct FilmSettings {
    int width = 1280, height = 720;
    PixelBounds crop{0, 0, 1280, 720}; // the rendered pixels
    PixelFilter filter = GaussianFilter{};
    float iso = 100, exposure_time = 1;
    float diagonal = 0.035f;        // metres; realistic cameras alone use it
    float white_balance = 0;        // kelvin; 0: none
    std::string sensor = "cie1931"; // see SensorSettings
    std::optional<SpectralSettings> spectral{};
    float max_component_value = std::numeric_limits<float>::infinity();
    LayerSettings layers{};
};

} // namespace montelux
