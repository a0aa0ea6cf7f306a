// Triangulator: splits the polygons of mesh files into triangles.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "montelux/mc/math/vec.h"

namespace montelux {

// Convex polygons become a fan around corner 0, concave ones are split by clipping ears (Meisters 1975, "Polygons
// Have Ears") in the plane of Newell's normal. Where no ear is left (edges that cross, corners that coincide) and
// beyond `most_clipped` corners, the rest becomes a fan.
class Triangulator {
  public:
    static constexpr std::size_t most_clipped = 256;
    using Triangle = std::array<std::uint32_t, 3>; // numbers of corners

    // At least 3 corners. Always two triangles fewer than corners, with the polygon's orientation. Valid until the
    // next call.
    std::span<const Triangle> split(std::span<const Point3f> corners);
    // Concave polygons so far that became a fan, wholly or in part: their shape is not kept.
    std::size_t fans() const { return fans_; }

  private:
    bool is_ear(std::size_t previous, std::size_t ear, std::size_t next) const;
    void clip();

    std::vector<Triangle> triangles_;
    std::vector<Vec2d> plane_;        // the corners in the plane
    std::vector<std::uint32_t> open_; // corners that are not yet clipped, in order
    std::size_t fans_ = 0;
    std::size_t tests_ = 0; // of ears, over all polygons: a file cannot ask for more than `most_tests`
};

} // namespace montelux
