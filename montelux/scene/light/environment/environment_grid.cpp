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

std::size_t EnvironmentGrid::row_at(double theta) const {
    // What is no number goes to the last row.
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

Vec3f EnvironmentGrid::direction(Vec2f grid) const {
    if (layout_ == EnvironmentLayout::equal_area)
        return equal_area_square_to_sphere(
            Vec2f{grid.x / static_cast<float>(width_), grid.y / static_cast<float>(height_)});
    double share = share_above(static_cast<double>(grid.y));
    auto sin_theta = static_cast<float>(2 * std::sqrt(std::max(0.0, share * (1 - share))));
    float phi = two_pi_f * grid.x / static_cast<float>(width_);
    return {sin_theta * std::cos(phi), sin_theta * std::sin(phi), static_cast<float>(1 - 2 * share)};
}

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
    double theta = std::atan2(std::sqrt(r2), z);
    std::size_t row = row_at(theta);
    auto line = static_cast<float>(in_row(row, share));
    return {std::min(right, turn_fraction(w.x, w.y) * static_cast<float>(width_)),
            std::min(std::nextafter(static_cast<float>(row + 1), 0.0f), line)};
}

} // namespace montelux
