#include "montelux/accel/geometry_callbacks.h"

#include <cmath>
#include <limits>

#include "montelux/accel/alpha.h"

namespace montelux {

namespace {

constexpr int present = -1; // of Embree's masks of valid rays

struct PrimitiveHit {
    double t;
    double u = 0, v = 0;       // of a curve or a patch
    std::size_t primitive = 0; // of the shape
};

std::optional<PrimitiveHit> first_hit(const GeometryData& data, unsigned primitive, const Ray& ray,
                                      double t_min) {
    std::optional<double> t;
    if (data.curves != nullptr) {
        const std::size_t segment = data.pieces.segment(primitive);
        const auto hit = intersect(data.curves->segment(segment), Vec3d(ray.o), Vec3d(ray.d), t_min,
                                   double(ray.t_max), data.pieces.range(primitive));
        return hit ? std::optional(PrimitiveHit{hit->t, hit->u, hit->v, segment}) : std::nullopt;
    }
    if (data.patches != nullptr) {
        const auto hit =
            intersect(data.patches->patch(primitive), Vec3d(ray.o), Vec3d(ray.d), t_min, double(ray.t_max));
        return hit ? std::optional(PrimitiveHit{hit->t, hit->u, hit->v, primitive}) : std::nullopt;
    }
    if (data.sphere)
        t = intersect(*data.sphere, ray, t_min);
    else
        t = intersect(*data.quadric, ray, t_min);
    return t ? std::optional(PrimitiveHit{*t}) : std::nullopt;
}

Bounds3 primitive_bounds(const GeometryData& data, unsigned primitive) {
    if (data.curves != nullptr)
        return bounds_of(data.curves->segment(data.pieces.segment(primitive)), data.pieces.range(primitive));
    if (data.patches != nullptr) return data.patches->patch_bounds(primitive);
    return world_bounds(*data.quadric);
}

Ray ray_of(RTCRayN* rays, unsigned n, unsigned i) {
    return {{RTCRayN_org_x(rays, n, i), RTCRayN_org_y(rays, n, i), RTCRayN_org_z(rays, n, i)},
            {RTCRayN_dir_x(rays, n, i), RTCRayN_dir_y(rays, n, i), RTCRayN_dir_z(rays, n, i)},
            RTCRayN_tfar(rays, n, i),
            RTCRayN_time(rays, n, i)};
}

// The first hit that is not in a hole.
std::optional<Hit> solid_hit(const GeometryData& data, unsigned primitive, const Ray& ray, double t_min) {
    while (const auto found = first_hit(data, primitive, ray, t_min)) {
        const Hit hit{.t = static_cast<float>(found->t),
                      .b1 = static_cast<float>(found->u),
                      .b2 = static_cast<float>(found->v),
                      .shape = data.shape,
                      .primitive = static_cast<Index>(found->primitive)};
        if (!data.cut_out || is_opaque(*data.scene, ray, hit)) return hit;
        t_min = found->t;
    }
    return std::nullopt;
}

} // namespace

void fill_bounds(const RTCBoundsFunctionArguments* args) {
    const auto& data = *static_cast<const GeometryData*>(args->geometryUserPtr);
    const Bounds3 b = primitive_bounds(data, args->primID);
    RTCBounds& out = *args->bounds_o;
    auto below = [](double v) { return std::nextafter(static_cast<float>(v), -1e38f); };
    auto above = [](double v) { return std::nextafter(static_cast<float>(v), 1e38f); };
    out.lower_x = below(b.lower.x);
    out.lower_y = below(b.lower.y);
    out.lower_z = below(b.lower.z);
    out.upper_x = above(b.upper.x);
    out.upper_y = above(b.upper.y);
    out.upper_z = above(b.upper.z);
}

void intersect_primitive(const RTCIntersectFunctionNArguments* args) {
    const auto& data = *static_cast<const GeometryData*>(args->geometryUserPtr);
    const unsigned n = args->N;
    RTCRayN* rays = RTCRayHitN_RayN(args->rayhit, n);
    RTCHitN* hits = RTCRayHitN_HitN(args->rayhit, n);
    for (unsigned i = 0; i < n; ++i) {
        if (args->valid[i] != present) continue;
        const auto hit = solid_hit(data, args->primID, ray_of(rays, n, i), double(RTCRayN_tnear(rays, n, i)));
        if (!hit) continue;
        RTCRayN_tfar(rays, n, i) = hit->t;
        RTCHitN_u(hits, n, i) = hit->b1;
        RTCHitN_v(hits, n, i) = hit->b2;
        RTCHitN_geomID(hits, n, i) = args->geomID;
        RTCHitN_primID(hits, n, i) = hit->primitive;
        RTCHitN_instID(hits, n, i, 0) = args->context->instID[0];
    }
}

void occlude_primitive(const RTCOccludedFunctionNArguments* args) {
    const auto& data = *static_cast<const GeometryData*>(args->geometryUserPtr);
    const unsigned n = args->N;
    for (unsigned i = 0; i < n; ++i)
        if (args->valid[i] == present &&
            solid_hit(data, args->primID, ray_of(args->ray, n, i), double(RTCRayN_tnear(args->ray, n, i))))
            RTCRayN_tfar(args->ray, n, i) = -std::numeric_limits<float>::infinity();
}

void filter_triangle(const RTCFilterFunctionNArguments* args) {
    const auto& data = *static_cast<const GeometryData*>(args->geometryUserPtr);
    const unsigned n = args->N;
    for (unsigned i = 0; i < n; ++i) {
        if (args->valid[i] != present) continue;
        const Hit hit{.t = RTCRayN_tfar(args->ray, n, i),
                      .b1 = RTCHitN_u(args->hit, n, i),
                      .b2 = RTCHitN_v(args->hit, n, i),
                      .shape = data.shape,
                      .primitive = RTCHitN_primID(args->hit, n, i)};
        if (!is_opaque(*data.scene, ray_of(args->ray, n, i), hit)) args->valid[i] = 0;
    }
}

} // namespace montelux
