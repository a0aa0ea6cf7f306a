// An environment map as baking sees it: radiance constant over each texel, with exact integrals over blocks
// of texels.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "montelux/image/image.h"
#include "montelux/mc/math/vec.h"
#include "montelux/scene/light/environment/environment_grid.h"

namespace montelux {

// Corrections to the texels of a map.
struct MapRepairs {
    std::uint64_t negative = 0, nan = 0, infinite = 0; // samples that were set to 0
    int halvings = 0;                                  // how often 2 x 2 texels were averaged
};

// A block of 2^level x 2^level texels, cut off at the edge of the map; or, for a level below 0, one of
// 2^-level x 2^-level parts of a texel that have equal solid angles.
struct MapCell {
    int level = 0;
    std::int32_t x = 0, y = 0;
};

// Directions are in the frame of the map, left-handed with z up, as in pbrt-v4: the middle of the top of an
// equirectangular map's first column is (1, 0, 0), its columns run towards +y; the centre of an equal-area
// map is +z.
class EnvironmentMap {
  public:
    // Larger maps are averaged by halves until they are below.
    static constexpr std::int64_t most_texels = std::int64_t{1} << 26;

    // Sums over larger ones might not fit into floats.
    static constexpr float largest_radiance = 1e36f;

    // Colour channels R, G, B or Y of the image as linear light; NaN, infinite and negative samples become 0.
    // Throws Error when there are none, a sample is above `largest_radiance`, or an equal-area map is not
    // square.
    EnvironmentMap(const Image& image, EnvironmentLayout layout);

    const EnvironmentGrid& grid() const { return grid_; }
    const MapRepairs& repairs() const { return repairs_; }
    // The level of the one block that is the whole map.
    int top_level() const { return static_cast<int>(levels_.size()) - 1; }
    // Level of the smallest parts of a cell: their positions fit into 30 bits.
    int lowest_level() const { return top_level() - 30; }
    // Mean over the sphere.
    Vec3d mean_radiance() const;

    // Of the texel that a unit direction meets; at a level above 0, mean of the block that it lies in.
    Vec3f radiance(Vec3f direction, int level = 0) const;
    Vec3f radiance(const MapCell& block) const;

    // Integral of radiance over a block of level 0 or more in units of `unit`, a power of two that keeps it
    // clear of overflow; and the sum of the three channels.
    float unit() const { return unit_; }
    const Vec3f& energy(const MapCell& block) const {
        return levels_[static_cast<std::size_t>(block.level)].energy[index(block.level, block.x, block.y)];
    }
    float energy_sum(const MapCell& block) const {
        return levels_[static_cast<std::size_t>(block.level)]
            .energy_sum[index(block.level, block.x, block.y)];
    }
    // Of the four blocks that a block of level 1 or more consists of: (2 x, 2 y), (2 x + 1, 2 y), (2 x, 2 y +
    // 1) and (2 x + 1, 2 y + 1). Those beyond the edge of the map have no energy.
    std::span<const float, 4> children_sums(const MapCell& block) const {
        const Level& level = levels_[static_cast<std::size_t>(block.level - 1)];
        return std::span<const float, 4>(
            level.energy_sum.data() + index(block.level - 1, 2 * block.x, 2 * block.y), 4);
    }
    double solid_angle(const MapCell& block) const;

    // A texel of a block that has energy, in proportion to the sum of channels; u in [0, 1).
    MapCell draw_texel(const MapCell& block, double u) const;
    // Of a direction drawn by draw_texel from the whole map and then `direction`, per steradian. A map
    // without light has none: 0.
    double density(Vec3f direction) const;

    // A ball about the middle of the cell, a unit vector, that holds all of its directions.
    struct Ball {
        Vec3f centre;
        float radius = 2;
    };
    Ball ball(const MapCell& cell) const;

    // A direction uniform over the solid angle of a texel or a part of one; s and t in [0, 1].
    Vec3f direction(const MapCell& cell, float s, float t) const;

  private:
    struct Level {
        int width = 0, height = 0;
        // Four sibling blocks are contiguous, in one cache line.
        std::vector<Vec3f> energy;
        std::vector<float> energy_sum;
        // Equirectangular: of the columns' and rows' middles, and of the rows' extents.
        std::vector<Vec2f> azimuth; // cosine, sine
        std::vector<Vec2f> polar;   // cosine, sine
        std::vector<float> radius;
        std::vector<Ball> balls; // equal-area; as `energy`
    };
    std::size_t index(int level, int x, int y) const {
        const int pairs = (levels_[static_cast<std::size_t>(level)].width + 1) / 2;
        return ((static_cast<std::size_t>(y / 2) * pairs + x / 2) << 2) | ((y & 1) << 1) | (x & 1);
    }
    static void allocate(Level& level);
    MapCell texel_at(Vec3f direction) const;
    std::vector<float> texels_of(const Image& image);
    void add_level();
    void add_geometry(Level& level, int l) const;
    Ball ball_of_block(int x, int y, int size) const;
    Ball ball_of_range(double x0, double x1, double y0, double y1) const;

    MapRepairs repairs_;
    EnvironmentGrid grid_;
    float unit_ = 1;
    std::vector<Level> levels_;
};

} // namespace montelux
