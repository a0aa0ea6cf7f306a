// Cube maps: six square faces, the directions of their texels, and mip chains of them.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "montelux/image/image.h"
#include "montelux/mc/math/vec.h"

namespace montelux {

// Faces have the order and orientation of OpenGL (4.6 core, table 8.19) and KTX2: +X, -X, +Y, -Y, +Z, -Z,
// seen from inside a left-handed cube. Row 0 of a face is the first one in memory; on the four sides it is
// the edge towards +Y.
enum class CubeFace { positive_x, negative_x, positive_y, negative_y, positive_z, negative_z };
inline constexpr int cube_faces = 6;
// "px", "nx", "py", "ny", "pz", "nz"
std::string_view name_of(CubeFace face);

// A position on the cube: (u, v) in [0, 1]^2 on a face, u to the right and v down.
struct CubePoint {
    int face = 0;
    double u = 0, v = 0;
};

// Unit vector from the middle of the cube.
Vec3d cube_direction(const CubePoint& p);
// Where a direction, of any length but 0, meets the cube. On an edge the face of x takes precedence over y,
// and y over z.
CubePoint cube_point(Vec3d direction);

struct CubeTexel {
    int face = 0, x = 0, y = 0;
    bool operator==(const CubeTexel&) const = default;
};

// Of the texel's centre on faces of size x size texels; a unit vector.
Vec3d cube_texel_direction(const CubeTexel& texel, int size);
CubeTexel cube_texel(Vec3d direction, int size);
// Exact, in steradians: those of a cube's texels sum to 4 pi.
double cube_texel_solid_angle(int x, int y, int size);

// Six images of size x size in linear RGB, 32-bit float.
struct CubeMap {
    int size = 0;
    std::array<Image, cube_faces> faces;
};

// All texels black. Throws Error when the size is not in [1, Image::max_dimension].
CubeMap make_cube_map(int size);

// Level 0 first; each level has half the size of the one before, rounded down and at least 1, and the last
// one need not have size 1.
struct CubeMapChain {
    std::vector<CubeMap> levels;
};

// floor(size / 2^level), at least 1.
constexpr int level_size(int size, int level) {
    return level < 31 && (size >> level) > 1 ? size >> level : 1;
}
// Of a chain down to size 1.
constexpr int level_count(int size) {
    int levels = 1;
    for (; size > 1; size >>= 1) ++levels;
    return levels;
}
// Throws Error, which begins with `where`, unless the chain has at least one level and all satisfy the above.
void check_cube_map_chain(std::string_view where, const CubeMapChain& chain);

} // namespace montelux
