#include "montelux/accel/geometry_callbacks.h"

#include <cmath>
#include <limits>

#include "montelux/accel/alpha.h"

namespace montelux {

namespace {

constexpr int present = -1; // of Embree's masks of valid rays

std::optional<double> hit_quadric(const GeometryData& data, const Ray& ray, double t_min) {
    if (data.sphere) return intersect(*data.sphere, ray, t_min);
    return intersect(*data.quadric, ray, t_min);
}

Ray ray_of(RTCRayN* rays, unsigned n, unsigned i) {
    return {{RTCRayN_org_x(rays, n, i), RTCRayN_org_y(rays, n, i), RTCRayN_org_z(rays, n, i)},
            {RTCRayN_dir_x(rays, n, i), RTCRayN_dir_y(rays, n, i), RTCRayN_dir_z(rays, n, i)},
            RTCRayN_tfar(rays, n, i),
            RTCRayN_time(rays, n, i)};
}

// The first hit that is not in a hole.
std::optional<float> solid_hit(const GeometryData& data, const Ray& ray, double t_min) {
    while (const auto t = hit_quadric(data, ray, t_min)) {
        const Hit hit{.t = static_cast<float>(*t), .shape = data.shape};
        if (!data.cut_out || is_opaque(*data.scene, ray, hit)) return hit.t;
        t_min = *t;
    }
    return std::nullopt;
}

} // namespace

void fill_quadric_bounds(const RTCBoundsFunctionArguments* args) {
    const auto* data = static_cast<const GeometryData*>(args->geometryUserPtr);
    Bounds3 b = world_bounds(*data->quadric);
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

void intersect_quadric(const RTCIntersectFunctionNArguments* args) {
    const auto& data = *static_cast<const GeometryData*>(args->geometryUserPtr);
    const unsigned n = args->N;
    RTCRayN* rays = RTCRayHitN_RayN(args->rayhit, n);
    RTCHitN* hits = RTCRayHitN_HitN(args->rayhit, n);
    for (unsigned i = 0; i < n; ++i) {
        if (args->valid[i] != present) continue;
        const auto t = solid_hit(data, ray_of(rays, n, i), double(RTCRayN_tnear(rays, n, i)));
        if (!t) continue;
        RTCRayN_tfar(rays, n, i) = *t;
        RTCHitN_u(hits, n, i) = RTCHitN_v(hits, n, i) = 0;
        RTCHitN_geomID(hits, n, i) = args->geomID;
        RTCHitN_primID(hits, n, i) = 0;
        RTCHitN_instID(hits, n, i, 0) = args->context->instID[0];
    }
}

void occlude_quadric(const RTCOccludedFunctionNArguments* args) {
    const auto& data = *static_cast<const GeometryData*>(args->geometryUserPtr);
    const unsigned n = args->N;
    for (unsigned i = 0; i < n; ++i)
        if (args->valid[i] == present &&
            solid_hit(data, ray_of(args->ray, n, i), double(RTCRayN_tnear(args->ray, n, i))))
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
