// EnvironmentGrid: the texels of an environment map on the sphere: directions, positions, solid angles.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/vec.h"

namespace montelux {

enum class EnvironmentLayout : std::uint8_t {
    equal_area,      // square, octahedral (Clarberg 2008): mc/warp/equal_area_square.h
    equirectangular, // latitude-longitude: rows from +z (theta = 0) to -z, columns phi from +x towards +y
};

constexpr std::string_view name_of(EnvironmentLayout layout) {
    return layout == EnvironmentLayout::equal_area ? "equal-area" : "equirectangular";
}

// The layout of maps of this size: square ones are equal-area, those twice as wide as high
// latitude-longitude; empty for others.
constexpr std::optional<EnvironmentLayout> layout_of_size(int width, int height) {
    if (width == height) return EnvironmentLayout::equal_area;
    if (width == 2 * height) return EnvironmentLayout::equirectangular;
    return std::nullopt;
}

// Positions on the map are grid points: texel (x, y) is [x, x + 1) x [y, y + 1), and within a texel equal
// areas are equal solid angles (rows of a latitude-longitude map are linear in cos(theta) inside each texel,
// not in theta). So a density that is constant over texels is constant over solid angle there, and matches
// radiance of the nearest texel exactly.
class EnvironmentGrid {
  public:
    // The texels with centres around a position, and their bilinear weights; a texel may occur several times.
    struct Blend {
        std::array<std::size_t, 4> texel;
        std::array<float, 4> share;
    };

    // Width and height at least 1.
    EnvironmentGrid(EnvironmentLayout layout, int width, int height);

    EnvironmentLayout layout() const { return layout_; }
    int width() const { return width_; }
    int height() const { return height_; }
    std::size_t texel_count() const {
        return static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
    }

    // Unit vector in the space of the map. For float and double.
    template <std::floating_point T = float>
    Vec3f direction(Vec2<T> grid) const;
    // Within [0, width) x [0, height). `w` has unit length.
    Vec2f locate(Vec3f w) const;
    std::size_t texel(Vec2f grid) const {
        return static_cast<std::size_t>(grid.y) * static_cast<std::size_t>(width_) +
               static_cast<std::size_t>(grid.x);
    }

    // Within [0, width] x [0, height]. Beyond an edge the map continues as on the sphere: on the other side
    // of the seam or the pole, or at the same edge of an octahedral map, mirrored.
    Blend blend(Vec2f grid) const;
    // The texel at a position up to one texel beyond an edge.
    std::size_t texel_around(int x, int y) const;

    // Solid angle of each texel of a row, in steradians.
    double solid_angle(int row) const {
        return layout_ == EnvironmentLayout::equal_area ? texel_solid_angle_
                                                        : solid_angles_[static_cast<std::size_t>(row)];
    }
    // Angle across the largest texel.
    double texel_angle() const;
    // Share of the map's solid angle above the line y of the grid, and the inverse. Rectangles of the grid
    // are uniform in solid angle over (x, share).
    double share_above(double y) const;
    double line_below(double share) const;

  private:
    std::size_t row_at(double theta) const;
    double in_row(std::size_t row, double share) const;

    EnvironmentLayout layout_;
    int width_, height_;
    double texel_solid_angle_ = 0; // equal-area maps
    // Latitude-longitude maps: share of the sphere above each row, height + 1 entries; solid angles of
    // texels.
    std::vector<double> edges_, solid_angles_;
};

} // namespace montelux
