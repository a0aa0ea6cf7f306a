#include "montelux/scene/material/shading_frame.h"

#include <algorithm>
#include <cmath>

#include "montelux/scene/texture/evaluate.h"

namespace montelux {

namespace {

// Shading normal, and the derivatives of position projected onto its plane.
struct Tangents {
    Normal3f n;
    Vec3f u, v;
};

// Bound on the relative rounding error of a filtered look-up: constant maps give no slope.
constexpr float lookup_rounding = 1e-6f;

Vec3f across(Vec3f a, Normal3f n) { return a - n * dot(n, a); }

// Slope of the height along one coordinate by a forward difference over half a pixel's footprint, as
// pbrt-v4's BumpMap; without a footprint, and of a `shadowed` detail, over less than the texel of a map of width 8192.
float slope(const SceneView& scene, const SurfaceDetail& detail, float here, const TextureContext& context,
            int axis, Vec3f dp) {
    const float footprint =
        detail.shadowed ? 0 : 0.5f * (std::abs(context.duvdx[axis]) + std::abs(context.duvdy[axis]));
    TextureContext shifted = context;
    shifted.uv[axis] += std::max(footprint, 1.0f / 8192);
    // The actual step after rounding to float.
    const float step = shifted.uv[axis] - context.uv[axis];
    shifted.p += dp * step;
    const float rise = evaluate(scene, detail.displacement, shifted) - here;
    const float s = rise / step;
    return std::abs(rise) > lookup_rounding * std::abs(here) && std::isfinite(s) ? s : 0;
}

// Returns false where the height is constant. Omits the term height * dn/du of the tangents, which flattens
// slopes by 1 + height / radius of curvature.
bool add_bumps(const SceneView& scene, const SurfaceDetail& detail, const SurfacePoint& surface,
               const TextureContext& context, Tangents& t) {
    if (detail.displacement.is_constant()) return false;
    const float here = evaluate(scene, detail.displacement, context);
    const float slope_u = slope(scene, detail, here, context, 0, surface.dpdu);
    const float slope_v = slope(scene, detail, here, context, 1, surface.dpdv);
    if (slope_u == 0 && slope_v == 0) return false;
    const Vec3f u = t.u + t.n * slope_u, v = t.v + t.n * slope_v;
    Vec3f n = cross(u, v);
    const float len = length(n);
    if (!(len > 0 && std::isfinite(len))) return false;
    n = n / len;
    t = {dot(n, t.n) < 0 ? -n : n, u, v};
    return true;
}

// Returns false where the map leaves the normal unchanged. The second axis of most maps points to the side
// of dp/dv, so mirrored instances and coordinates show mirrored dents.
bool add_map(const SceneView& scene, const NormalMapParameter& map, const SurfacePoint& surface,
             const TextureContext& context, Tangents& t) {
    if (!map.is_given()) return false;
    const ImageTexture& texture = scene.normal_maps[map.map];
    Vec3f u = t.u, v = t.v;
    if (texture.mapping.second_uv) {
        if (!(length_squared(surface.vertex_tangent) > 0)) u = across(surface.second_dpdu, t.n);
        v = across(surface.second_dpdv, t.n);
    }
    const TextureCoordinates c = texture.mapping(context);
    const Vec3f rgb =
        scene.mipmap(texture.image, texture.channels)
            .lookup(c.st, c.dstdx, c.dstdy, texture.filter, texture.wrap, texture.max_anisotropy);
    const Vec3f m = multiply(2 * rgb - Vec3f{1, 1, 1}, texture.factor);
    if (std::abs(m.x) < lookup_rounding && std::abs(m.y) < lookup_rounding) return false;
    const Frame frame = Frame::from_normal_and_tangent(t.n, u);
    const float side = !texture.right_handed && dot(frame.t, v) < 0 ? -1.0f : 1.0f;
    const Vec3f n = frame.to_world({m.x, side * m.y, m.z});
    const float len = length(n);
    if (!(len > 0 && std::isfinite(len))) return false;
    t.n = n / len;
    return true;
}

// Keller et al. 2017, "The Iray Light Transport Simulation and Rendering System", appendix A.3: a normal that
// mirrors wo below the surface is replaced by one that mirrors it just above.
Normal3f facing(Normal3f n, Normal3f geometric, Vec3f wo) {
    constexpr float least = 1e-3f; // sine of the least angle above the surface
    const float side = dot(wo, geometric) < 0 ? -1.0f : 1.0f;
    const Vec3f g = geometric * side;
    Vec3f m = n * side;
    if (const float above = dot(m, g); above < least) m = normalize(m + g * (least - above));
    const Vec3f mirrored = m * (2 * dot(m, wo)) - wo;
    if (const float above = dot(mirrored, g); above < least)
        m = normalize(wo + normalize(mirrored + g * (least - above)));
    return m * side;
}

} // namespace

std::optional<Frame> tilted_frame(const SceneView& scene, const SurfaceDetail& detail,
                                  const SurfacePoint& surface, Vec3f wo, const TextureContext& context) {
    Tangents t{surface.ns, across(surface.dpdu, surface.ns), across(surface.dpdv, surface.ns)};
    const bool bumpy = add_bumps(scene, detail, surface, context, t);
    // Heights vary with the coordinates, maps of normals refer to the mesh's own tangents.
    if (length_squared(surface.vertex_tangent) > 0) t.u = across(surface.vertex_tangent, t.n);
    const bool mapped = add_map(scene, detail.normal_map, surface, context, t);
    if (!bumpy && !mapped) return std::nullopt;
    if (!detail.shadowed) return Frame::from_normal_and_tangent(facing(t.n, surface.ng, wo), t.u);
    const Normal3f n = surface.ns;
    const bool faces = dot(wo, n) * dot(wo, t.n) > 0;
    return Frame::from_normal_and_tangent(faces ? t.n : n * (2 * dot(n, t.n)) - t.n, t.u);
}

} // namespace montelux
