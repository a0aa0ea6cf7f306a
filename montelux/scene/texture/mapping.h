// Mappings from a point on a surface to the (s, t) of a 2-D texture.
#pragma once

#include <cmath>
#include <cstdint>

#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/transform.h"

namespace montelux {

// The inputs of a texture. The footprint (duvdx, duvdy: one pixel step to the right and down) selects the
// level of detail; zero means "no filtering".
struct TextureContext {
    Point3f p; // world space
    Vec3f n;
    Point2f uv;
    Vec3f dpdx, dpdy;
    Vec2f duvdx, duvdy;
    Vec3f vertex_color{1, 1, 1}; // SurfacePoint::vertex_color
    float vertex_opacity = 1;
    Point2f second_uv{}; // SurfacePoint::second_uv, with its footprint
    Vec2f second_duvdx{}, second_duvdy{};
};

struct TextureCoordinates {
    Point2f st;
    Vec2f dstdx, dstdy;
};

// uv: (s, t) = (su u + du, sv v + dv). affine: (s, t) = (vs.x u + vs.y v + du, vt.x u + vt.y v + dv). The others start from the point in texture space:
// spherical (theta/pi, phi/2pi), cylindrical (phi/2pi, z), planar (ds + p.vs, dt + p.vt), where du and dv
// are the offsets of the planar map.
struct TextureMapping {
    enum class Kind : std::uint8_t { uv, spherical, cylindrical, planar, affine };
    Kind kind = Kind::uv;
    float su = 1, sv = 1, du = 0, dv = 0;
    Vec3f vs{1, 0, 0}, vt{0, 1, 0};
    Transform texture_from_world;
    bool second_uv = false; // uv and affine: of the mesh's second set of texture coordinates

    TextureCoordinates operator()(const TextureContext& c) const;
};

} // namespace montelux
