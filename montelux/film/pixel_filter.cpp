#include "montelux/film/pixel_filter.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/warp/tent.h"

namespace montelux {

namespace {

float sinc(float x) {
    x *= pi_f;
    return std::abs(x) < 1e-4f ? 1 - x * x / 6 : std::sin(x) / x;
}

float factor(const BoxFilter&, float, float) { return 1; }
float factor(const TriangleFilter&, float x, float radius) { return radius - std::abs(x); }
// Lowered so that it meets zero at the radius.
float factor(const GaussianFilter& f, float x, float radius) {
    auto g = [&](float v) { return std::exp(-v * v / (2 * f.sigma * f.sigma)); };
    return std::max(0.0f, g(x) - g(radius));
}
// Mitchell and Netravali 1988, "Reconstruction Filters in Computer Graphics", stretched to the radius.
float factor(const MitchellFilter& f, float x, float radius) {
    x = std::abs(2 * x / radius);
    float b = f.b, c = f.c;
    if (x <= 1) return ((12 - 9 * b - 6 * c) * x * x * x + (-18 + 12 * b + 6 * c) * x * x + (6 - 2 * b)) / 6;
    return ((-b - 6 * c) * x * x * x + (6 * b + 30 * c) * x * x + (-12 * b - 48 * c) * x + (8 * b + 24 * c)) /
           6;
}
// Sinc windowed by the central lobe of a wider sinc, which ends at tau; the radius cuts both off.
float factor(const LanczosFilter& f, float x, float radius) {
    (void)radius;
    return sinc(x) * sinc(x / f.tau);
}

float axis_factor(const PixelFilter& filter, int axis, float x) {
    return std::visit(
        [&](const auto& f) {
            float r = f.radius[axis];
            return std::abs(x) <= r ? factor(f, x, r) : 0.0f;
        },
        filter);
}

} // namespace

Vec2f filter_radius(const PixelFilter& filter) {
    return std::visit([](const auto& f) { return f.radius; }, filter);
}

float filter_value(const PixelFilter& filter, Vec2f offset) {
    return axis_factor(filter, 0, offset.x) * axis_factor(filter, 1, offset.y);
}

PixelFilterSampler::PixelFilterSampler(const PixelFilter& filter)
    : is_box_(std::holds_alternative<BoxFilter>(filter)) {
    Vec2f radius = filter_radius(filter);
    for (int a = 0; a < 2; ++a) {
        Axis& axis = axes_[a];
        axis.radius = radius[a];
        if (!(axis.radius > 0 && axis.radius < 1000))
            throw Error("pixel filter", "the radius must be positive and at most 1000 pixels");
        if (is_box_ || std::holds_alternative<TriangleFilter>(filter)) continue;
        // The factor is taken as linear between these nodes, so that its integral is known exactly.
        const int n = std::max(64, static_cast<int>(std::ceil(axis.radius * 128)) * 2);
        std::vector<double> value, magnitude;
        double integral = 0;
        for (int i = 0; i <= n; ++i) {
            double x = double(axis.radius) * (2.0 * i / n - 1);
            value.push_back(double(axis_factor(filter, a, static_cast<float>(x))));
            integral += i == 0 || i == n ? 0.5 * value.back() : value.back();
        }
        integral *= 2 * double(axis.radius) / n;
        if (!(integral > 0)) throw Error("pixel filter", "the filter's integral is not positive");
        for (double v : value) {
            magnitude.push_back(std::abs(v));
            axis.weight.push_back(static_cast<float>(v / integral));
        }
        // A floor keeps the density from zero where the filter crosses it, and the weights bounded.
        double largest = *std::max_element(magnitude.begin(), magnitude.end());
        for (double& v : magnitude) v = std::max(v, 1e-3 * largest);
        axis.density.emplace(PiecewiseLinear1D(magnitude, -double(axis.radius), double(axis.radius)));
        axis.steps_per_unit = static_cast<float>(n) / (2 * axis.radius);
    }
}

float PixelFilterSampler::sample_axis(const Axis& axis, float u, float& weight) const {
    if (!axis.density) return is_box_ ? (2 * u - 1) * axis.radius : sample_tent(u, axis.radius);
    InverseTable1D::Sample s = axis.density->sample(u);
    float step = std::max(0.0f, (s.x + axis.radius) * axis.steps_per_unit);
    std::size_t i = std::min(static_cast<std::size_t>(step), axis.weight.size() - 2);
    float t = step - static_cast<float>(i);
    weight *= ((1 - t) * axis.weight[i] + t * axis.weight[i + 1]) * s.inverse_pdf;
    return s.x;
}

float PixelFilterSampler::normalized(const Axis& axis, float x) const {
    if (!(x >= -axis.radius && x < axis.radius)) return 0;
    if (is_box_) return 1 / (2 * axis.radius);
    if (!axis.density) return (axis.radius - std::abs(x)) / (axis.radius * axis.radius);
    const float step = std::max(0.0f, (x + axis.radius) * axis.steps_per_unit);
    const std::size_t i = std::min(static_cast<std::size_t>(step), axis.weight.size() - 2);
    const float t = step - static_cast<float>(i);
    return (1 - t) * axis.weight[i] + t * axis.weight[i + 1];
}

FilterSample PixelFilterSampler::sample(Vec2f u) const {
    FilterSample s;
    s.offset.x = sample_axis(axes_[0], u.x, s.weight);
    s.offset.y = sample_axis(axes_[1], u.y, s.weight);
    return s;
}

} // namespace montelux
