#include "montelux/bake/environment_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/mc/warp/equal_area_square.h"

namespace montelux {
namespace {

// cos(a) - cos(b) without cancellation.
double cosine_difference(double a, double b) { return 2 * std::sin((a + b) / 2) * std::sin((b - a) / 2); }

// Middle of a run of `size` texels that begins at x * size and ends at the edge of the map at the latest.
double middle(int x, int size, int map_size) {
    const double begin = static_cast<double>(x) * size;
    return (begin + std::min<double>(begin + size, map_size)) / 2;
}

} // namespace

std::string_view name_of(MapLayout layout) {
    return layout == MapLayout::equirectangular ? "equirectangular" : "equal-area";
}

EnvironmentMap::EnvironmentMap(const Image& image, MapLayout layout) : layout_(layout) {
    std::vector<float> texels;
    fill_texels(image, texels);
    for (int row = 0; row <= height_; ++row) row_z_.push_back(std::cos(pi * row / height_));
    for (int row = 0; row < height_; ++row)
        texel_solid_angle_.push_back(layout_ == MapLayout::equirectangular
                                         ? 2 * pi / width_ *
                                               cosine_difference(pi * row / height_, pi * (row + 1) / height_)
                                         : 4 * pi / (static_cast<double>(width_) * height_));

    // The largest power of two that is not above the largest sample.
    const float largest = *std::max_element(texels.begin(), texels.end());
    if (largest > 0) unit_ = std::ldexp(1.0f, std::max(std::ilogb(largest), -126));

    Level base;
    base.width = width_;
    base.height = height_;
    levels_.push_back(std::move(base));
    allocate(levels_[0]);
    parallel_for(height_, [&](std::int64_t y) {
        const double scale = texel_solid_angle_[static_cast<std::size_t>(y)] / static_cast<double>(unit_);
        for (int x = 0; x < width_; ++x) {
            const float* rgb = texels.data() + 3 * (static_cast<std::size_t>(y) * width_ + x);
            const Vec3f energy(Vec3d(Vec3f{rgb[0], rgb[1], rgb[2]}) * scale);
            levels_[0].energy[index(0, x, static_cast<int>(y))] = energy;
            levels_[0].energy_sum[index(0, x, static_cast<int>(y))] = energy.x + energy.y + energy.z;
        }
    });
    add_geometry(levels_[0], 0);
    while (levels_.back().width > 1 || levels_.back().height > 1) add_level();
}

void EnvironmentMap::fill_texels(const Image& image, std::vector<float>& texels) {
    const std::vector<int> channels = image.color_channels();
    if (image.empty() || channels.empty())
        throw Error("environment map", "the picture has no channels R, G and B, and no channel Y");
    if (layout_ == MapLayout::equal_area && image.width() != image.height())
        throw Error("environment map", "an equal-area map is square; this picture has " +
                                           std::to_string(image.width()) + " x " +
                                           std::to_string(image.height()) + " pixels");
    while ((static_cast<std::int64_t>(image.width()) >> repairs_.halvings) *
               (image.height() >> repairs_.halvings) >
           most_texels)
        ++repairs_.halvings;
    const int block = 1 << repairs_.halvings;
    width_ = (image.width() + block - 1) / block;
    height_ = (image.height() + block - 1) / block;
    texels.resize(3 * static_cast<std::size_t>(width_) * height_);
    for (int y = 0; y < height_; ++y)
        for (int x = 0; x < width_; ++x) {
            std::array<double, 3> sum{};
            double weight = 0;
            for (int sy = y * block; sy < std::min((y + 1) * block, image.height()); ++sy) {
                const double share =
                    layout_ == MapLayout::equirectangular ? std::sin(pi * (sy + 0.5) / image.height()) : 1.0;
                for (int sx = x * block; sx < std::min((x + 1) * block, image.width()); ++sx) {
                    for (std::size_t c = 0; c < 3; ++c) {
                        const float v = image.linear(sx, sy, channels[channels.size() == 3 ? c : 0]);
                        if (v > 0 && std::isfinite(v))
                            sum[c] += share * static_cast<double>(v);
                        else if (c < channels.size() && v != 0)
                            ++(std::isnan(v) ? repairs_.nan : v > 0 ? repairs_.infinite : repairs_.negative);
                    }
                    weight += share;
                }
            }
            for (std::size_t c = 0; c < 3; ++c)
                texels[3 * (static_cast<std::size_t>(y) * width_ + x) + c] =
                    static_cast<float>(sum[c] / weight);
        }
}

void EnvironmentMap::allocate(Level& level) {
    const auto pairs_x = static_cast<std::size_t>((level.width + 1) / 2);
    const auto pairs_y = static_cast<std::size_t>((level.height + 1) / 2);
    level.energy.resize(pairs_x * pairs_y * 4);
    level.energy_sum.resize(pairs_x * pairs_y * 4);
}

void EnvironmentMap::add_level() {
    const int l = static_cast<int>(levels_.size());
    Level level;
    level.width = (levels_.back().width + 1) / 2;
    level.height = (levels_.back().height + 1) / 2;
    levels_.push_back(std::move(level));
    Level& parents = levels_.back();
    allocate(parents);
    const Level& children = levels_[static_cast<std::size_t>(l - 1)];
    parallel_for(parents.height, [&](std::int64_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < parents.width; ++x) {
            Vec3d energy;
            double sum = 0;
            for (int k = 0; k < 4; ++k) {
                const std::size_t child = index(l - 1, 2 * x, 2 * y) + static_cast<std::size_t>(k);
                energy += Vec3d(children.energy[child]);
                sum += static_cast<double>(children.energy_sum[child]);
            }
            parents.energy[index(l, x, y)] = Vec3f(energy);
            parents.energy_sum[index(l, x, y)] = static_cast<float>(sum);
        }
    });
    add_geometry(parents, l);
}

void EnvironmentMap::add_geometry(Level& level, int l) const {
    const int size = 1 << l;
    if (layout_ == MapLayout::equirectangular) {
        for (int x = 0; x < level.width; ++x) {
            const double phi = 2 * pi * middle(x, size, width_) / width_;
            level.azimuth.push_back({static_cast<float>(std::cos(phi)), static_cast<float>(std::sin(phi))});
        }
        for (int y = 0; y < level.height; ++y) {
            const Ball widest = ball_of_block(0, y, size);
            const Vec3f c = widest.centre;
            level.polar.push_back({c.z, std::sqrt(c.x * c.x + c.y * c.y)});
            level.radius.push_back(widest.radius);
        }
        return;
    }
    level.balls.resize(level.energy.size());
    parallel_for(level.height, [&](std::int64_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < level.width; ++x) level.balls[index(l, x, y)] = ball_of_block(x, y, size);
    });
}

EnvironmentMap::Ball EnvironmentMap::ball_of_block(int x, int y, int size) const {
    const double x0 = static_cast<double>(x) * size, y0 = static_cast<double>(y) * size;
    return ball_of_range(x0, std::min<double>(x0 + size, width_), y0, std::min<double>(y0 + size, height_));
}

EnvironmentMap::Ball EnvironmentMap::ball_of_range(double x0, double x1, double y0, double y1) const {
    Ball ball;
    ball.centre = direction_at((x0 + x1) / 2, (y0 + y1) / 2);
    // More than a quarter of a map turns about its poles and corners in ways that the edges do not tell.
    if ((x1 - x0) * 4 > width_ || (y1 - y0) * 4 > height_) return ball;
    float farthest = 0;
    for (double x : {x0, (x0 + x1) / 2, x1})
        for (double y : {y0, (y0 + y1) / 2, y1})
            farthest = std::max(farthest, length_squared(direction_at(x, y) - ball.centre));
    ball.radius = 1.01f * std::sqrt(farthest); // for rounding
    return ball;
}

EnvironmentMap::Ball EnvironmentMap::ball(const MapCell& cell) const {
    if (cell.level < 0) {
        const int parts = 1 << -cell.level;
        return ball_of_range(static_cast<double>(cell.x) / parts, static_cast<double>(cell.x + 1) / parts,
                             static_cast<double>(cell.y) / parts, static_cast<double>(cell.y + 1) / parts);
    }
    const Level& level = levels_[static_cast<std::size_t>(cell.level)];
    if (layout_ == MapLayout::equal_area) return level.balls[index(cell.level, cell.x, cell.y)];
    const auto column = static_cast<std::size_t>(cell.x), row = static_cast<std::size_t>(cell.y);
    const Vec2f azimuth = level.azimuth[column], polar = level.polar[row];
    return {{polar.y * azimuth.x, polar.y * azimuth.y, polar.x}, level.radius[row]};
}

Vec3f EnvironmentMap::direction_at(double x, double y) const {
    if (layout_ == MapLayout::equal_area)
        return Vec3f(equal_area_square_to_sphere(Vec2d{x / width_, y / height_}));
    const int row = std::clamp(static_cast<int>(y), 0, height_ - 1);
    const double within = y - row, z0 = row_z_[static_cast<std::size_t>(row)];
    const double z = z0 + within * (row_z_[static_cast<std::size_t>(row) + 1] - z0);
    const auto r = static_cast<float>(std::sqrt(std::max(0.0, (1 - z) * (1 + z))));
    const auto phi = static_cast<float>(2 * pi * x / width_);
    return {r * std::cos(phi), r * std::sin(phi), static_cast<float>(z)};
}

Vec3f EnvironmentMap::direction(const MapCell& cell, float s, float t) const {
    const double part = cell.level < 0 ? 1.0 / (1 << -cell.level) : 1.0;
    return direction_at((cell.x + static_cast<double>(s)) * part, (cell.y + static_cast<double>(t)) * part);
}

Vec2i EnvironmentMap::texel_at(Vec3f d) const {
    Vec2f p;
    if (layout_ == MapLayout::equal_area) {
        p = equal_area_sphere_to_square(d);
    } else {
        const float turn = std::atan2(d.y, d.x) * inv_two_pi_f;
        p.x = turn < 0 ? turn + 1 : turn;
        p.y = std::atan2(std::sqrt(d.x * d.x + d.y * d.y), d.z) * inv_pi_f;
    }
    return {std::clamp(static_cast<int>(p.x * static_cast<float>(width_)), 0, width_ - 1),
            std::clamp(static_cast<int>(p.y * static_cast<float>(height_)), 0, height_ - 1)};
}

MapCell EnvironmentMap::draw_texel(const MapCell& block, double u) const {
    MapCell at = block;
    double left = u * static_cast<double>(energy_sum(block));
    while (at.level > 0) {
        const auto sums = children_sums(at);
        const auto s0 = static_cast<double>(sums[0]), s1 = s0 + static_cast<double>(sums[1]),
                   s2 = s1 + static_cast<double>(sums[2]);
        int k = (left >= s0) + (left >= s1) + (left >= s2);
        // Rounding may lead past the last block that has any energy.
        while (!(sums[static_cast<std::size_t>(k)] > 0)) --k;
        left -= k == 0 ? 0 : k == 1 ? s0 : k == 2 ? s1 : s2;
        at = {at.level - 1, 2 * at.x + (k & 1), 2 * at.y + (k >> 1)};
    }
    return at;
}

double EnvironmentMap::density(Vec3f direction) const {
    const auto total = static_cast<double>(levels_.back().energy_sum[0]);
    if (!(total > 0)) return 0;
    const Vec2i texel = texel_at(direction);
    return static_cast<double>(energy_sum({0, texel.x, texel.y})) /
           (total * texel_solid_angle_[static_cast<std::size_t>(texel.y)]);
}

double EnvironmentMap::solid_angle(const MapCell& block) const {
    const int size = 1 << block.level;
    const int x0 = block.x * size, y0 = block.y * size;
    const int columns = std::min(size, width_ - x0), end = std::min(y0 + size, height_);
    if (layout_ == MapLayout::equal_area) return texel_solid_angle_[0] * columns * (end - y0);
    return 2 * pi / width_ * columns * cosine_difference(pi * y0 / height_, pi * end / height_);
}

Vec3f EnvironmentMap::radiance(Vec3f direction, int level) const {
    const Vec2i texel = texel_at(direction);
    const MapCell block{level, texel.x >> level, texel.y >> level};
    const double omega =
        level == 0 ? texel_solid_angle_[static_cast<std::size_t>(texel.y)] : solid_angle(block);
    return energy(block) * static_cast<float>(static_cast<double>(unit_) / omega);
}

Vec3d EnvironmentMap::mean_radiance() const {
    return Vec3d(levels_.back().energy[0]) * (static_cast<double>(unit_) * inv_four_pi);
}

} // namespace montelux
