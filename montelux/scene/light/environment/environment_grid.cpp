#include "montelux/scene/light/environment/environment_grid.h"

#include <algorithm>
#include <cmath>

#include "montelux/mc/warp/disk.h"
#include "montelux/mc/warp/equal_area_square.h"

namespace montelux {

namespace {

// The largest float below n.
float below(int n) { return std::nextafter(static_cast<float>(n), 0.0f); }

} // namespace

EnvironmentGrid::EnvironmentGrid(EnvironmentLayout layout, int width, int height)
    : layout_(layout), width_(width), height_(height) {
    if (layout == EnvironmentLayout::equal_area) {
        texel_solid_angle_ = 4 * pi / (static_cast<double>(width) * height);
        return;
    }
    for (int y = 0; y <= height; ++y) {
        // (1 - cos(theta)) / 2, exact at both poles.
        double s = std::sin(0.5 * pi * y / height), c = std::sin(0.5 * pi * (height - y) / height);
        edges_.push_back(2 * y <= height ? s * s : 1 - c * c);
    }
    for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y) {
        // cos(a) - cos(b) = 2 sin((a + b) / 2) sin((b - a) / 2) without cancellation.
        double middle = pi * (static_cast<double>(y) + 0.5) / height;
        solid_angles_.push_back(2 * pi / width * 2 * std::sin(middle) * std::sin(0.5 * pi / height));
    }
}

double EnvironmentGrid::texel_angle() const {
    return layout_ == EnvironmentLayout::equirectangular ? pi / height_ : std::sqrt(texel_solid_angle_);
}

std::size_t EnvironmentGrid::row_at(double theta) const {
    // NaN maps to the last row.
    return static_cast<std::size_t>(std::min(static_cast<double>(height_ - 1), theta * inv_pi * height_));
}

double EnvironmentGrid::in_row(std::size_t row, double share) const {
    double within = (share - edges_[row]) / (edges_[row + 1] - edges_[row]);
    return static_cast<double>(row) + std::clamp(within, 0.0, 1.0);
}

double EnvironmentGrid::share_above(double y) const {
    if (layout_ == EnvironmentLayout::equal_area) return y / height_;
    auto row = std::min(static_cast<std::size_t>(std::max(y, 0.0)), static_cast<std::size_t>(height_ - 1));
    return edges_[row] + (y - static_cast<double>(row)) * (edges_[row + 1] - edges_[row]);
}

double EnvironmentGrid::line_below(double share) const {
    if (layout_ == EnvironmentLayout::equal_area) return share * height_;
    share = std::clamp(share, 0.0, 1.0);
    double theta = 2 * std::atan2(std::sqrt(share), std::sqrt(1 - share));
    return in_row(row_at(theta), share);
}

std::size_t EnvironmentGrid::texel_around(int x, int y) const {
    if (layout_ == EnvironmentLayout::equal_area) {
        if (x < 0 || x >= width_) {
            x = x < 0 ? -1 - x : 2 * width_ - 1 - x;
            y = height_ - 1 - y;
        }
        if (y < 0 || y >= height_) {
            y = y < 0 ? -1 - y : 2 * height_ - 1 - y;
            x = width_ - 1 - x;
        }
    } else {
        if (y < 0 || y >= height_) {
            y = y < 0 ? -1 - y : 2 * height_ - 1 - y;
            x += width_ / 2;
        }
        x = (x + width_) % width_;
    }
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
}

EnvironmentGrid::Blend EnvironmentGrid::blend(Vec2f grid) const {
    const float left = std::floor(grid.x - 0.5f), top = std::floor(grid.y - 0.5f);
    const float u = grid.x - 0.5f - left, v = grid.y - 0.5f - top;
    const int x = static_cast<int>(left), y = static_cast<int>(top);
    return {{texel_around(x, y), texel_around(x + 1, y), texel_around(x, y + 1), texel_around(x + 1, y + 1)},
            {(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v}};
}

template <std::floating_point T>
Vec3f EnvironmentGrid::direction(Vec2<T> grid) const {
    if (layout_ == EnvironmentLayout::equal_area)
        return Vec3f(equal_area_square_to_sphere(
            Vec2<T>{grid.x / static_cast<T>(width_), grid.y / static_cast<T>(height_)}));
    double share = share_above(static_cast<double>(grid.y));
    auto sin_theta = static_cast<float>(2 * std::sqrt(std::max(0.0, share * (1 - share))));
    auto phi = static_cast<float>(static_cast<T>(2 * pi) * grid.x / static_cast<T>(width_));
    return {sin_theta * std::cos(phi), sin_theta * std::sin(phi), static_cast<float>(1 - 2 * share)};
}
template Vec3f EnvironmentGrid::direction(Vec2f grid) const;
template Vec3f EnvironmentGrid::direction(Vec2d grid) const;

Vec2f EnvironmentGrid::locate(Vec3f w) const {
    const float right = below(width_), bottom = below(height_);
    if (layout_ == EnvironmentLayout::equal_area) {
        Vec2f p = equal_area_sphere_to_square(w);
        return {std::min(right, p.x * static_cast<float>(width_)),
                std::min(bottom, p.y * static_cast<float>(height_))};
    }
    double x = double(w.x), y = double(w.y), z = double(w.z), r2 = x * x + y * y;
    // (1 - z) / 2 keeps its digits near both poles.
    double share = z > 0 ? r2 / (2 * (1 + z)) : 1 - r2 / (2 * (1 - z));
    // Floats locate the angle to about one row; shares decide which.
    std::size_t row = row_at(static_cast<double>(std::atan2(std::sqrt(static_cast<float>(r2)), w.z)));
    while (row > 0 && share < edges_[row]) --row;
    while (row + 2 < edges_.size() && share >= edges_[row + 1]) ++row;
    auto line = static_cast<float>(in_row(row, share));
    return {std::min(right, turn_fraction(w.x, w.y) * static_cast<float>(width_)),
            std::min(std::nextafter(static_cast<float>(row + 1), 0.0f), line)};
}

} // namespace montelux
