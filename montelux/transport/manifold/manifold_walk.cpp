#include "montelux/transport/manifold/manifold_walk.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "montelux/mc/math/frame.h"

namespace montelux {

namespace {

constexpr int most_steps = 20;
constexpr double smallest_share = 1.0 / 32; // of a step that leads off the caster
// Of the constraint, in units of the generalised half vector's summands.
constexpr double tolerance = 1e-9;
// Distance of equal solutions over that of the vertex. Those on different triangles differ however close they are: one
// triangle has one solution, or several that are far apart beside the steps of the walk.
constexpr double separation = 1e-5;

struct Matrix2 {
    double uu, uv, vu, vv;
    double determinant() const { return uu * vv - uv * vu; }
};

bool is_finite(Vec3d v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

// The constraint at a point: the part of the generalised half vector across the normal, wi + eta wo, vanishes where
// the laws of reflection and refraction hold (Walter et al. 2007). Of reflection it is divided by the part along the
// normal: above a plane it is then nearly linear, and walks from far away end. Its derivatives by the coordinates are
// those in a plane that does not turn with the normal: at a solution they are the same.
struct Constraint {
    FrameOf<double> frame;
    Vec3d wi, wo;     // to the vertex, to the light
    double ri, ro;    // inverse distances
    double eta = 1;   // on the side of the light over that of the vertex
    double scale = 1; // the divisor
    double x, y;      // in the frame
    Matrix2 gradient; // row: x or y
};

Constraint constraint_at(const CasterPoint& point, const ManifoldEnds& ends, const Caster& caster,
                         bool reflects) {
    Constraint c;
    const Vec3d to_vertex = ends.vertex() - point.p;
    c.ri = 1 / length(to_vertex);
    c.wi = to_vertex * c.ri;
    if (ends.distant) {
        c.ro = 0;
        c.wo = ends.light;
    } else {
        const Vec3d to_light = ends.light - point.p;
        c.ro = 1 / length(to_light);
        c.wo = to_light * c.ro;
    }
    if (!reflects) c.eta = dot(c.wi, point.n) > 0 ? caster.eta : 1 / caster.eta;
    c.frame = FrameOf<double>::from_normal(point.n);
    const Vec3d h = c.wi + c.wo * c.eta;
    const double along = dot(point.n, h);
    if (reflects) c.scale = along;
    const Vec3d across = h - point.n * along;
    c.x = dot(c.frame.s, h) / c.scale;
    c.y = dot(c.frame.t, h) / c.scale;
    const auto derivative = [&](Vec3d dp, Vec3d dn) {
        const Vec3d dh = (c.wi * dot(c.wi, dp) - dp) * c.ri + (c.wo * dot(c.wo, dp) - dp) * (c.ro * c.eta);
        Vec3d d = dh - dn * along;
        if (reflects) d = d - across * ((dot(point.n, dh) + dot(dn, h)) / along);
        return d / c.scale;
    };
    const Vec3d du = derivative(point.dpdu, point.dndu), dv = derivative(point.dpdv, point.dndv);
    c.gradient = {dot(c.frame.s, du), dot(c.frame.s, dv), dot(c.frame.t, du), dot(c.frame.t, dv)};
    return c;
}

// Where a step along the tangents leads: within a triangle, or to the surface that the vertex sees there. Empty if
// that is no point of the caster.
std::optional<CasterPoint> stepped(const SceneView& scene, RayTracer& tracer, const Caster& caster,
                                   const ManifoldEnds& ends, const CasterPoint& from, double du, double dv) {
    const Vec3d p = from.p + from.dpdu * du + from.dpdv * dv;
    if (!std::holds_alternative<CasterMesh>(caster.geometry)) return quadric_point(caster, p);
    const double b1 = from.b1 + du, b2 = from.b2 + dv;
    if (b1 >= 0 && b2 >= 0 && b1 + b2 <= 1) return mesh_point(scene, caster, from.primitive, b1, b2);
    const Vec3d d = normalize(p - ends.vertex());
    if (!is_finite(d)) return std::nullopt;
    const Vec3f w(d);
    const Ray ray{
        .o = offset_origin(ends.from.p, ends.from.n, ends.from.error, w), .d = w, .time = ends.time};
    Hit hit;
    if (!tracer.intersect(ray, hit) || hit.shape != caster.shape || hit.instance != no_index)
        return std::nullopt;
    return mesh_point(scene, caster, hit.primitive, double(hit.b1), double(hit.b2));
}

} // namespace

std::optional<ManifoldSolution> walk_manifold(const SceneView& scene, RayTracer& tracer, const Caster& caster,
                                              const ManifoldEnds& ends, const CasterPoint& seed) {
    CasterPoint point = seed;
    const Vec3d to_light = ends.distant ? ends.light : ends.light - seed.p;
    const bool reflects =
        caster.eta == 0 || (dot(ends.vertex() - seed.p, seed.n) > 0) == (dot(to_light, seed.n) > 0);
    double share = 1; // of the full step
    for (int i = 0; i < most_steps; ++i) {
        const Constraint c = constraint_at(point, ends, caster, reflects);
        if (!(is_finite(c.wi) && is_finite(c.wo))) return std::nullopt;
        if (std::abs(c.x) < tolerance && std::abs(c.y) < tolerance) {
            const bool same_side = dot(c.wi, point.n) * dot(c.wo, point.n) > 0;
            if (same_side != reflects || !contains(caster, point)) return std::nullopt;
            return ManifoldSolution{point, reflects};
        }
        const double determinant = c.gradient.determinant();
        const double du = (c.gradient.uv * c.y - c.gradient.vv * c.x) / determinant;
        const double dv = (c.gradient.vu * c.x - c.gradient.uu * c.y) / determinant;
        if (!(std::isfinite(du) && std::isfinite(dv))) return std::nullopt;
        const auto next = stepped(scene, tracer, caster, ends, point, share * du, share * dv);
        if (next && is_finite(next->n)) {
            point = *next;
            share = std::min(1.0, 2 * share);
        } else {
            share /= 2;
            if (share < smallest_share) return std::nullopt;
        }
    }
    return std::nullopt;
}

bool is_same(const ManifoldSolution& a, const ManifoldSolution& b, const ManifoldEnds& ends) {
    if (a.reflects != b.reflects || a.point.primitive != b.point.primitive) return false;
    const double scale = separation * length(a.point.p - ends.vertex());
    return length_squared(a.point.p - b.point.p) < scale * scale;
}

float inverse_probability(const SceneView& scene, RayTracer& tracer, const Caster& caster,
                          const ManifoldEnds& ends, const ManifoldSolution& solution, PhiloxStream& stream) {
    for (int trials = 1; trials <= most_manifold_trials; ++trials) {
        const auto other = walk_manifold(scene, tracer, caster, ends, sample_point(scene, caster, stream));
        if (other && is_same(*other, solution, ends)) return static_cast<float>(trials);
    }
    return std::numeric_limits<float>::quiet_NaN();
}

double manifold_geometry(const ManifoldSolution& solution, const ManifoldEnds& ends, const Caster& caster) {
    const CasterPoint& point = solution.point;
    const Constraint c = constraint_at(point, ends, caster, solution.reflects);
    // By the implicit function theorem a step of the light across its ray, which changes the constraint by
    // eta / (distance * scale), moves the vertex by the inverse gradient.
    const double per_light = c.eta * (ends.distant ? 1 : c.ro) / c.scale;
    const double by_light = per_light * per_light * std::abs(dot(point.n, c.wo));
    const Vec3d normal = normalize(cross(point.dpdu, point.dpdv));
    const double by_vertex = std::abs(dot(normal, c.wi)) * c.ri * c.ri * point.area_element();
    return by_vertex * by_light / std::abs(c.gradient.determinant());
}

} // namespace montelux
