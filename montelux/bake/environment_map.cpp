#include "montelux/bake/environment_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/parallel/parallel_for.h"

namespace montelux {
namespace {

// Middle of a run of `size` texels that begins at x * size and ends at the edge of the map at the latest.
double middle(int x, int size, int map_size) {
    const double begin = static_cast<double>(x) * size;
    return (begin + std::min<double>(begin + size, map_size)) / 2;
}

int halvings_of(const Image& image) {
    int halvings = 0;
    while ((static_cast<std::int64_t>(image.width()) >> halvings) * (image.height() >> halvings) >
           EnvironmentMap::most_texels)
        ++halvings;
    return halvings;
}

EnvironmentGrid grid_of(const Image& image, EnvironmentLayout layout, int halvings) {
    if (image.empty() || image.color_channels().empty())
        throw Error("environment map", "the picture has no channels R, G and B, and no channel Y");
    if (layout == EnvironmentLayout::equal_area && image.width() != image.height())
        throw Error("environment map", "an equal-area map is square; this picture has " +
                                           std::to_string(image.width()) + " x " +
                                           std::to_string(image.height()) + " pixels");
    const int block = 1 << halvings;
    return {layout, (image.width() + block - 1) / block, (image.height() + block - 1) / block};
}

} // namespace

EnvironmentMap::EnvironmentMap(const Image& image, EnvironmentLayout layout)
    : repairs_{.halvings = halvings_of(image)}, grid_(grid_of(image, layout, repairs_.halvings)) {
    const int width = grid_.width(), height = grid_.height();
    const std::vector<float> texels = texels_of(image);

    const float largest = *std::max_element(texels.begin(), texels.end());
    if (largest > largest_radiance) {
        char text[96];
        std::snprintf(text, sizeof text,
                      "a sample is %.3g; at most %.0e is expected, so that sums are finite",
                      static_cast<double>(largest), static_cast<double>(largest_radiance));
        throw Error("environment map", text);
    }
    // The largest power of two that is not above the largest sample.
    if (largest > 0) unit_ = std::ldexp(1.0f, std::max(std::ilogb(largest), -126));

    Level base;
    base.width = width;
    base.height = height;
    levels_.push_back(std::move(base));
    allocate(levels_[0]);
    parallel_for(height, [&](std::int64_t row) {
        const int y = static_cast<int>(row);
        const double scale = grid_.solid_angle(y) / static_cast<double>(unit_);
        for (int x = 0; x < width; ++x) {
            const float* rgb = texels.data() + 3 * (static_cast<std::size_t>(y) * width + x);
            const Vec3f energy(Vec3d(Vec3f{rgb[0], rgb[1], rgb[2]}) * scale);
            levels_[0].energy[index(0, x, y)] = energy;
            levels_[0].energy_sum[index(0, x, y)] = energy.x + energy.y + energy.z;
        }
    });
    add_geometry(levels_[0], 0);
    while (levels_.back().width > 1 || levels_.back().height > 1) add_level();
}

std::vector<float> EnvironmentMap::texels_of(const Image& image) {
    const std::vector<int> channels = image.color_channels();
    const int width = grid_.width(), height = grid_.height(), block = 1 << repairs_.halvings;
    std::vector<float> texels(3 * grid_.texel_count());
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            std::array<double, 3> sum{};
            double weight = 0;
            for (int sy = y * block; sy < std::min((y + 1) * block, image.height()); ++sy) {
                const double share = grid_.layout() == EnvironmentLayout::equirectangular
                                         ? std::sin(pi * (sy + 0.5) / image.height())
                                         : 1.0;
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
                texels[3 * (static_cast<std::size_t>(y) * width + x) + c] =
                    static_cast<float>(sum[c] / weight);
        }
    return texels;
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
    if (grid_.layout() == EnvironmentLayout::equirectangular) {
        for (int x = 0; x < level.width; ++x) {
            const double phi = 2 * pi * middle(x, size, grid_.width()) / grid_.width();
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
    return ball_of_range(x0, std::min<double>(x0 + size, grid_.width()), y0,
                         std::min<double>(y0 + size, grid_.height()));
}

EnvironmentMap::Ball EnvironmentMap::ball_of_range(double x0, double x1, double y0, double y1) const {
    Ball ball;
    ball.centre = grid_.direction(Vec2d{(x0 + x1) / 2, (y0 + y1) / 2});
    // A block of more than a quarter of a map may contain poles and corners that its edges do not show.
    if ((x1 - x0) * 4 > grid_.width() || (y1 - y0) * 4 > grid_.height()) return ball;
    float farthest = 0;
    for (double x : {x0, (x0 + x1) / 2, x1})
        for (double y : {y0, (y0 + y1) / 2, y1})
            farthest = std::max(farthest, length_squared(grid_.direction(Vec2d{x, y}) - ball.centre));
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
    if (grid_.layout() == EnvironmentLayout::equal_area)
        return level.balls[index(cell.level, cell.x, cell.y)];
    const auto column = static_cast<std::size_t>(cell.x), row = static_cast<std::size_t>(cell.y);
    const Vec2f azimuth = level.azimuth[column], polar = level.polar[row];
    return {{polar.y * azimuth.x, polar.y * azimuth.y, polar.x}, level.radius[row]};
}

Vec3f EnvironmentMap::direction(const MapCell& cell, float s, float t) const {
    const double part = cell.level < 0 ? 1.0 / (1 << -cell.level) : 1.0;
    return grid_.direction(
        Vec2d{(cell.x + static_cast<double>(s)) * part, (cell.y + static_cast<double>(t)) * part});
}

MapCell EnvironmentMap::texel_at(Vec3f direction) const {
    const Vec2f at = grid_.locate(direction);
    return {0, static_cast<std::int32_t>(at.x), static_cast<std::int32_t>(at.y)};
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
    const MapCell texel = texel_at(direction);
    return static_cast<double>(energy_sum(texel)) / (total * grid_.solid_angle(texel.y));
}

double EnvironmentMap::solid_angle(const MapCell& block) const {
    const int size = 1 << block.level;
    const int x0 = block.x * size, y0 = block.y * size;
    const int columns = std::min(size, grid_.width() - x0), end = std::min(y0 + size, grid_.height());
    return 4 * pi * (grid_.share_above(end) - grid_.share_above(y0)) * columns / grid_.width();
}

Vec3f EnvironmentMap::radiance(Vec3f direction, int level) const {
    const MapCell texel = texel_at(direction);
    return radiance(MapCell{level, texel.x >> level, texel.y >> level});
}

Vec3f EnvironmentMap::radiance(const MapCell& block) const {
    const double omega = block.level == 0 ? grid_.solid_angle(block.y) : solid_angle(block);
    return Vec3f(Vec3d(energy(block)) * (static_cast<double>(unit_) / omega)); // small texels: a large factor
}

Vec3d EnvironmentMap::mean_radiance() const {
    return Vec3d(levels_.back().energy[0]) * (static_cast<double>(unit_) * inv_four_pi);
}

} // namespace montelux
