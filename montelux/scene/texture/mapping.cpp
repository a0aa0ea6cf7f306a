#include "montelux/scene/texture/mapping.h"

#include <algorithm>

namespace montelux {

namespace {

Vec2f spherical(Vec3f p) {
    Vec3f d = normalize(p);
    float phi = std::atan2(d.y, d.x);
    if (phi < 0) phi += two_pi_f;
    return {std::acos(std::clamp(d.z, -1.0f, 1.0f)) * inv_pi_f, phi * inv_two_pi_f};
}

Vec2f cylindrical(Vec3f p) { return {(pi_f + std::atan2(p.y, p.x)) * inv_two_pi_f, p.z}; }

// Angle differences are wrapped across the seam.
Vec2f wrapped_difference(Vec2f a, Vec2f b, int angle) {
    Vec2f d = a - b;
    d[angle] -= std::round(d[angle]);
    return d;
}

} // namespace

TextureCoordinates TextureMapping::operator()(const TextureContext& c) const {
    const Point2f uv = second_uv ? c.second_uv : c.uv;
    const Vec2f duvdx = second_uv ? c.second_duvdx : c.duvdx, duvdy = second_uv ? c.second_duvdy : c.duvdy;
    if (kind == Kind::uv)
        return {{su * uv.x + du, sv * uv.y + dv}, {su * duvdx.x, sv * duvdx.y}, {su * duvdy.x, sv * duvdy.y}};
    if (kind == Kind::affine) {
        const auto linear = [&](Vec2f v) { return Vec2f{vs.x * v.x + vs.y * v.y, vt.x * v.x + vt.y * v.y}; };
        return {linear(uv) + Vec2f{du, dv}, linear(duvdx), linear(duvdy)};
    }
    Vec3f p = texture_from_world.point(c.p);
    Vec3f px = texture_from_world.vector(c.dpdx), py = texture_from_world.vector(c.dpdy);
    switch (kind) {
    case Kind::spherical: {
        Vec2f st = spherical(p);
        return {st, wrapped_difference(spherical(p + px), st, 1),
                wrapped_difference(spherical(p + py), st, 1)};
    }
    case Kind::cylindrical: {
        Vec2f st = cylindrical(p);
        return {st, wrapped_difference(cylindrical(p + px), st, 0),
                wrapped_difference(cylindrical(p + py), st, 0)};
    }
    default:
        return {{du + dot(p, vs), dv + dot(p, vt)}, {dot(px, vs), dot(px, vt)}, {dot(py, vs), dot(py, vt)}};
    }
}

} // namespace montelux
