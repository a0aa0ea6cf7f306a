#include "montelux/image/cube_map.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

// Area on the unit sphere above [0, x] x [0, y] of the plane z = 1.
double corner_solid_angle(double x, double y) { return std::atan2(x * y, std::sqrt(x * x + y * y + 1)); }

int texel_of(double u, int size) { return std::clamp(static_cast<int>(u * size), 0, size - 1); }

const std::vector<std::string>& cube_channels() {
    static const std::vector<std::string> names{"R", "G", "B"};
    return names;
}

} // namespace

std::string_view name_of(CubeFace face) {
    constexpr std::array<std::string_view, cube_faces> names{"px", "nx", "py", "ny", "pz", "nz"};
    return names[static_cast<std::size_t>(face)];
}

Vec3d cube_direction(const CubePoint& p) {
    const double a = 2 * p.u - 1, b = 2 * p.v - 1;
    Vec3d d;
    switch (static_cast<CubeFace>(p.face)) {
    case CubeFace::positive_x:
        d = {1, -b, -a};
        break;
    case CubeFace::negative_x:
        d = {-1, -b, a};
        break;
    case CubeFace::positive_y:
        d = {a, 1, b};
        break;
    case CubeFace::negative_y:
        d = {a, -1, -b};
        break;
    case CubeFace::positive_z:
        d = {a, -b, 1};
        break;
    case CubeFace::negative_z:
        d = {-a, -b, -1};
        break;
    }
    return normalize(d);
}

CubePoint cube_point(Vec3d d) {
    const Vec3d size = abs(d);
    auto at = [](CubeFace face, double a, double b, double depth) {
        return CubePoint{static_cast<int>(face), (a / depth + 1) / 2, (b / depth + 1) / 2};
    };
    if (size.x >= size.y && size.x >= size.z)
        return d.x > 0 ? at(CubeFace::positive_x, -d.z, -d.y, size.x)
                       : at(CubeFace::negative_x, d.z, -d.y, size.x);
    if (size.y >= size.z)
        return d.y > 0 ? at(CubeFace::positive_y, d.x, d.z, size.y)
                       : at(CubeFace::negative_y, d.x, -d.z, size.y);
    return d.z > 0 ? at(CubeFace::positive_z, d.x, -d.y, size.z)
                   : at(CubeFace::negative_z, -d.x, -d.y, size.z);
}

Vec3d cube_texel_direction(const CubeTexel& texel, int size) {
    return cube_direction({texel.face, (texel.x + 0.5) / size, (texel.y + 0.5) / size});
}

CubeTexel cube_texel(Vec3d direction, int size) {
    const CubePoint p = cube_point(direction);
    return {p.face, texel_of(p.u, size), texel_of(p.v, size)};
}

double cube_texel_solid_angle(int x, int y, int size) {
    // Symmetric in sign, so that mirrored texels are bit-identical.
    auto edge = [size](int i) { return static_cast<double>(2 * i - size) / size; };
    const double x0 = edge(x), x1 = edge(x + 1), y0 = edge(y), y1 = edge(y + 1);
    return corner_solid_angle(x0, y0) - corner_solid_angle(x0, y1) - corner_solid_angle(x1, y0) +
           corner_solid_angle(x1, y1);
}

CubeMap make_cube_map(int size) {
    CubeMap map;
    map.size = size;
    for (Image& face : map.faces) face = Image(size, size, cube_channels());
    return map;
}

void check_cube_map_chain(std::string_view where, const CubeMapChain& chain) {
    if (chain.levels.empty()) throw Error(where, "the chain of cube maps has no level");
    for (std::size_t level = 0; level < chain.levels.size(); ++level) {
        const CubeMap& map = chain.levels[level];
        const std::string name = "level " + std::to_string(level);
        const int expected =
            level == 0 ? std::max(1, map.size) : level_size(chain.levels[0].size, static_cast<int>(level));
        if (map.size != expected)
            throw Error(where, name + " has size " + std::to_string(map.size) + "; expected " +
                                   std::to_string(expected));
        if (level > 0 && chain.levels[level - 1].size == 1)
            throw Error(where, name + " comes after one of size 1, which is the last there can be");
        for (const Image& face : map.faces)
            if (face.width() != map.size || face.height() != map.size || face.format() != PixelFormat::f32 ||
                face.channel_names() != cube_channels())
                throw Error(where, name + " has a face that is not " + std::to_string(map.size) + " x " +
                                       std::to_string(map.size) + " texels of R, G, B in 32-bit float");
    }
}

} // namespace montelux
