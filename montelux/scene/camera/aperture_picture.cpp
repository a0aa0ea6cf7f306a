#include "montelux/scene/camera/aperture_picture.h"

#include <algorithm>
#include <cmath>

#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

AperturePicture normalized(AperturePicture picture) {
    double sum = 0;
    for (const float v : picture.values) {
        if (!(v >= 0 && std::isfinite(v)))
            throw Error("aperture", "the picture has values that are negative or not finite");
        sum += static_cast<double>(v);
    }
    const double mean = sum / static_cast<double>(picture.values.size());
    if (!(mean > 0)) throw Error("aperture", "the picture lets no light through");
    for (float& v : picture.values) v = static_cast<float>(static_cast<double>(v) * (pi / 4) / mean);
    return picture;
}

// f(x, y) over [-1, 1]^2, y up; each pixel is the mean of 16 points.
template <typename F>
AperturePicture drawn(const F& f) {
    constexpr int size = 256, sub = 4;
    AperturePicture picture{size, size, {}};
    for (int row = 0; row < size; ++row)
        for (int column = 0; column < size; ++column) {
            double sum = 0;
            for (int j = 0; j < sub; ++j)
                for (int i = 0; i < sub; ++i)
                    sum +=
                        f(2 * (column + (i + 0.5) / sub) / size - 1, 1 - 2 * (row + (j + 0.5) / sub) / size);
            picture.values.push_back(static_cast<float>(sum / (sub * sub)));
        }
    return normalized(std::move(picture));
}

// Whether a polygon contains a point (crossings of a ray to the right).
double contains(std::span<const Vec2d> polygon, double x, double y) {
    bool inside = false;
    for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
        const Vec2d a = polygon[i], b = polygon[j];
        if ((a.y > y) != (b.y > y) && x < a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y)) inside = !inside;
    }
    return inside ? 1 : 0;
}

} // namespace

float AperturePicture::at(double x, double y) const {
    if (!(std::abs(x) <= 1 && std::abs(y) <= 1)) return 0;
    const double column = (x + 1) / 2 * width - 0.5, row = (1 - y) / 2 * height - 0.5;
    const double left = std::floor(column), top = std::floor(row);
    const double fx = column - left, fy = row - top;
    const auto value = [&](int dx, int dy) {
        const int i = static_cast<int>(left) + dx, j = static_cast<int>(top) + dy;
        if (i < 0 || j < 0 || i >= width || j >= height) return 0.0;
        return static_cast<double>(values[static_cast<std::size_t>(j) * static_cast<std::size_t>(width) +
                                          static_cast<std::size_t>(i)]);
    };
    return static_cast<float>((1 - fy) * ((1 - fx) * value(0, 0) + fx * value(1, 0)) +
                              fy * ((1 - fx) * value(0, 1) + fx * value(1, 1)));
}

std::optional<AperturePicture> find_aperture(std::string_view name) {
    if (name == "gaussian")
        return drawn(
            [](double x, double y) { return std::max(0.0, std::exp(-(x * x + y * y)) - std::exp(-1.0)); });
    if (name == "square")
        return drawn([](double x, double y) { return std::abs(x) < 0.5 && std::abs(y) < 0.5 ? 1.0 : 0.0; });
    // Vertices at even steps, alternating between two radii for the star.
    std::vector<Vec2d> polygon;
    if (name == "pentagon") {
        for (int i = 0; i < 5; ++i)
            polygon.push_back({0.8 * std::sin(2 * pi * i / 5), 0.8 * std::cos(2 * pi * i / 5)});
    } else if (name == "star") {
        for (int i = 0; i < 10; ++i) {
            const double r = i % 2 == 1 ? 1 : std::cos(2 * pi / 5) / std::cos(pi / 5);
            polygon.push_back({r * std::cos(pi * i / 5), r * std::sin(pi * i / 5)});
        }
    } else {
        return std::nullopt;
    }
    return drawn([&](double x, double y) { return contains(polygon, x, y); });
}

std::span<const std::string_view> aperture_names() {
    static constexpr std::string_view names[] = {"gaussian", "square", "pentagon", "star"};
    return names;
}

AperturePicture aperture_of(const Image& picture) {
    const std::vector<int> channels = picture.color_channels();
    if (channels.empty()) throw Error("aperture", "the picture has neither colours nor grey");
    AperturePicture result{picture.width(), picture.height(), {}};
    for (int y = 0; y < picture.height(); ++y)
        for (int x = 0; x < picture.width(); ++x) {
            float sum = 0;
            for (const int c : channels) sum += picture.linear(x, y, c);
            result.values.push_back(sum / static_cast<float>(channels.size()));
        }
    return normalized(std::move(result));
}

} // namespace montelux
