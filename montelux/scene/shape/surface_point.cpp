#include "montelux/scene/shape/surface_point.h"

#include <algorithm>
#include <cmath>

#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/overloaded.h"
#include "montelux/scene/shape/quadric.h"

namespace montelux {

namespace {

float largest_coordinate(Vec3f p) { return std::max(std::abs(p.x), std::max(std::abs(p.y), std::abs(p.z))); }

// The derivatives of p with respect to uv by those of p (e1, e2) and of uv with respect to two other coordinates.
// Degenerate uv yield arbitrary tangents.
struct UvTangents {
    Vec3f u, v;
};
UvTangents uv_tangents_of(Normal3f ng, Vec3f e1, Vec3f e2, Vec2f duv1, Vec2f duv2) {
    float determinant = duv1.x * duv2.y - duv1.y * duv2.x;
    if (std::abs(determinant) > 1e-20f) {
        float inv = 1 / determinant;
        const UvTangents t{(duv2.y * e1 - duv1.y * e2) * inv, (duv1.x * e2 - duv2.x * e1) * inv};
        if (length_squared(cross(t.u, t.v)) > 0) return t;
    }
    Frame frame = Frame::from_normal(ng);
    return {frame.s, frame.t};
}
void set_tangents(SurfacePoint& s, Vec3f e1, Vec3f e2, Vec2f duv1, Vec2f duv2) {
    const UvTangents t = uv_tangents_of(s.ng, e1, e2, duv1, duv2);
    s.dpdu = t.u;
    s.dpdv = t.v;
}

SurfacePoint mesh_point(const TriangleMesh& mesh, const Shape& shape, const Hit& hit, float time,
                        bool coordinates) {
    SurfacePoint s;
    const Index* v = &mesh.indices[3 * std::size_t{hit.primitive}];
    const Point3f p0 = mesh.position(v[0], time), p1 = mesh.position(v[1], time),
                  p2 = mesh.position(v[2], time);
    const Vec3f normal = mesh.normals.empty() ? Vec3f{} : interpolated_normal(mesh, v, hit.b1, hit.b2, time);
    const TrianglePoint<float> point = triangle_point(p0, p1, p2, hit.b1, hit.b2, shape.flip_normal, normal);
    s.p = point.p;
    s.ng = point.ng;
    s.ns = point.ns;
    s.error = point.error;
    if (mesh.deforms()) { // rounded in proportion to the ends
        Vec3f reach;
        for (std::size_t k = 0; k < 3; ++k)
            reach = max(reach, max(abs(mesh.positions[v[k]]), abs(mesh.end_positions[v[k]])));
        s.error = coordinate_error(s.ng, reach);
    }
    if (!coordinates) return s;
    Point2f uv0{0, 0}, uv1{1, 0}, uv2{1, 1};
    if (!mesh.uvs.empty()) {
        uv0 = mesh.uvs[v[0]];
        uv1 = mesh.uvs[v[1]];
        uv2 = mesh.uvs[v[2]];
    }
    s.uv = (1 - hit.b1 - hit.b2) * uv0 + hit.b1 * uv1 + hit.b2 * uv2;
    set_tangents(s, p1 - p0, p2 - p0, uv1 - uv0, uv2 - uv0);
    if (!mesh.tangents.empty())
        s.vertex_tangent = (1 - hit.b1 - hit.b2) * mesh.tangents[v[0]] + hit.b1 * mesh.tangents[v[1]] +
                           hit.b2 * mesh.tangents[v[2]];
    const auto interpolated = [&](const auto& values) {
        return (1 - hit.b1 - hit.b2) * values[v[0]] + hit.b1 * values[v[1]] + hit.b2 * values[v[2]];
    };
    if (!mesh.colors.empty()) s.vertex_color = interpolated(mesh.colors);
    if (!mesh.opacities.empty()) s.vertex_opacity = interpolated(mesh.opacities);
    if (!mesh.second_uvs.empty()) {
        s.second_uv = interpolated(mesh.second_uvs);
        const Point2f first = mesh.second_uvs[v[0]];
        const UvTangents t = uv_tangents_of(s.ng, p1 - p0, p2 - p0, mesh.second_uvs[v[1]] - first,
                                            mesh.second_uvs[v[2]] - first);
        s.second_dpdu = t.u;
        s.second_dpdv = t.v;
    }
    return s;
}

SurfacePoint patch_point(const BilinearMesh& mesh, const Shape& shape, const Hit& hit, bool coordinates) {
    SurfacePoint s;
    const Index* i = &mesh.indices[4 * std::size_t{hit.primitive}];
    const BilinearPatch patch = mesh.patch(hit.primitive);
    const double u = double(hit.b1), v = double(hit.b2);
    s.p = Vec3f(point_of(patch, u, v));
    s.ng = patch_normal(mesh, shape, hit.primitive, u, v);
    s.ns = s.ng;
    if (const Vec3f n = interpolated_patch_normal(mesh, hit.primitive, hit.b1, hit.b2); length_squared(n) > 0)
        s.ns = normalize(n);
    s.error = patch_error(patch, s.ng);
    if (!coordinates) return s;
    const Vec3f dpdu(dpdu_of(patch, v)), dpdv(dpdv_of(patch, u));
    Point2f uv00{0, 0}, uv10{1, 0}, uv01{0, 1}, uv11{1, 1};
    if (!mesh.uvs.empty()) {
        uv00 = mesh.uvs[i[0]];
        uv10 = mesh.uvs[i[1]];
        uv01 = mesh.uvs[i[2]];
        uv11 = mesh.uvs[i[3]];
    }
    s.uv = bilinear(uv00, uv10, uv01, uv11, hit.b1, hit.b2);
    const Vec2f duv_du = (1 - hit.b2) * (uv10 - uv00) + hit.b2 * (uv11 - uv01),
                duv_dv = (1 - hit.b1) * (uv01 - uv00) + hit.b1 * (uv11 - uv10);
    set_tangents(s, dpdu, dpdv, duv_du, duv_dv);
    return s;
}

SurfacePoint quadric_point(const Quadric& quadric, const Shape& shape, const Ray& ray, const Hit& hit,
                           bool coordinates) {
    SurfacePoint s;
    QuadricPoint q = point_at(quadric, ray, double(hit.t), coordinates);
    s.p = Vec3f(q.p);
    s.ng = Vec3f(shape.flip_normal ? -q.n : q.n);
    s.ns = s.ng;
    s.uv = q.uv;
    s.error =
        coordinate_error(s.ng, abs(s.p)) +
        0x1p-40f * (largest_coordinate(s.p) + std::visit([](const auto& x) { return x.radius; }, quadric));
    if (coordinates) {
        s.dpdu = Vec3f(q.dpdu);
        s.dpdv = Vec3f(q.dpdv);
    }
    return s;
}

// Texture coordinates of a tube, as Mitsuba 3 has them: u is the azimuth around the tangent from a direction that lies
// across the z axis, v the share of all segments.
void set_tube_coordinates(SurfacePoint& s, Vec3d tangent, Vec3d n, double radius, Vec3d along, double v,
                          double segments) {
    Vec3d upright = Vec3d(0, 0, 1) - tangent * tangent.z;
    upright = length_squared(upright) > 1e-24 ? normalize(upright) : Vec3d(0, 1, 0);
    const Vec3d level = cross(upright, tangent);
    const double sine = dot(upright, n), cosine = dot(level, n);
    const double azimuth = std::atan2(sine, cosine) / (2 * pi);
    s.uv = {static_cast<float>(azimuth < 0 ? azimuth + 1 : azimuth), static_cast<float>(v / segments)};
    s.dpdu = Vec3f((cosine * upright - sine * level) * (2 * pi * radius));
    s.dpdv = Vec3f(along * segments);
}

SurfacePoint curve_point(const Curves& curves, const Shape& shape, const Ray& ray, const Hit& hit) {
    SurfacePoint s;
    const CurveSegment segment = curves.segment(hit.primitive);
    const double u = double(hit.b1), v = double(hit.b2);
    const double width = (1 - u) * segment.width0 + u * segment.width1;
    const Vec3d d = normalize(Vec3d(ray.d)), o(ray.o);
    Vec3d along = derivative_of(segment.curve, u);
    if (!(length_squared(along) > 0)) along = segment.curve[3] - segment.curve[0];
    if (!(length_squared(along) > 0)) along = Vec3d(Frame::from_normal(Vec3f(d)).s);
    const Vec3d tangent = normalize(along);
    // Across the curve in the direction of growing v, and the normal on the ray's side.
    Vec3d across = cross(d, tangent);
    across = length_squared(across) > 1e-24 ? normalize(across) : Vec3d(Frame::from_normal(Vec3f(tangent)).s);
    Vec3d facing = cross(across, tangent);
    s.p = Vec3f(o + Vec3d(ray.d) * double(hit.t));
    s.uv = {hit.b1, hit.b2};
    s.dpdu = Vec3f(along);
    if (curves.kind == Curves::Kind::ribbon && segment.normals) {
        const Vec3d n = normal_of(segment, u);
        const Vec3d upright = n - tangent * dot(n, tangent);
        const double side = dot(upright, facing) < 0 ? -1.0 : 1.0;
        if (length_squared(upright) > 1e-24) facing = normalize(upright) * side;
        across = cross(tangent, facing);
        s.ng = Vec3f(shape.flip_normal ? facing * -side : facing * side);
        s.ns = s.ng;
        s.dpdv = Vec3f(across * width);
    } else if (curves.kind == Curves::Kind::cylinder) {
        const double theta = (v - 0.5) * pi;
        s.ng = s.ns = Vec3f(normalize(facing * std::cos(theta) + across * std::sin(theta)));
        s.dpdv = Vec3f((across * std::cos(theta) - facing * std::sin(theta)) * width);
    } else if (curves.kind == Curves::Kind::tube) {
        const double sine = 2 * v - 1;
        const Vec3d n = facing * std::sqrt(std::max(0.0, 1 - sine * sine)) + across * sine;
        s.ng = s.ns = Vec3f(normalize(n));
        set_tube_coordinates(s, tangent, n, width / 2, along, hit.primitive + u,
                             static_cast<double>(curves.segment_count()));
    } else {
        s.ng = s.ns = Vec3f(facing);
        s.dpdv = Vec3f(across * width);
    }
    // A ray that leaves must not meet the curve, which will face it then.
    s.error = static_cast<float>(width) + coordinate_error(largest_coordinate(s.p));
    return s;
}

void transform_by(const Transform& t, SurfacePoint& s) {
    s.p = t.point(s.p);
    s.ng = normalize(t.normal(s.ng));
    s.ns = normalize(t.normal(s.ns));
    s.dpdu = t.vector(s.dpdu);
    s.dpdv = t.vector(s.dpdv);
    s.vertex_tangent = t.vector(s.vertex_tangent);
    s.second_dpdu = t.vector(s.second_dpdu);
    s.second_dpdv = t.vector(s.second_dpdv);
    s.error = transformed_error(s.error, t, s.p);
}

// Largest stretch of a transform, bounded by the Frobenius norm.
float stretch(const Transform& t) {
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) sum += t.matrix().m[i][j] * t.matrix().m[i][j];
    return static_cast<float>(std::sqrt(sum));
}

} // namespace

Vec3f interpolated_patch_normal(const BilinearMesh& mesh, std::size_t primitive, float u, float v) {
    if (mesh.normals.empty()) return {};
    const Index* i = &mesh.indices[4 * primitive];
    return bilinear(mesh.normals[i[0]], mesh.normals[i[1]], mesh.normals[i[2]], mesh.normals[i[3]], u, v);
}

Normal3f patch_normal(const BilinearMesh& mesh, const Shape& shape, std::size_t primitive, double u,
                      double v) {
    const BilinearPatch patch = mesh.patch(primitive);
    Vec3d n = normal_of(patch, u, v);
    if (!(length_squared(n) > 0)) n = normal_of(patch, 0.5, 0.5); // at a corner where edges coincide
    if (!(length_squared(n) > 0)) n = {0, 0, 1};
    const Normal3f ng = Vec3f(normalize(shape.flip_normal ? -n : n));
    const Vec3f vertex_normal =
        interpolated_patch_normal(mesh, primitive, static_cast<float>(u), static_cast<float>(v));
    return turns_normal(vertex_normal, ng) ? -ng : ng;
}

float transformed_error(float error, const Transform& t, Point3f p) {
    return error * stretch(t) + coordinate_error(largest_coordinate(p));
}

float patch_error(const BilinearPatch& p, Normal3f n) {
    return coordinate_error(n, Vec3f(max(max(abs(p.p00), abs(p.p10)), max(abs(p.p01), abs(p.p11)))));
}

SurfacePoint surface_point(const SceneView& scene, const Ray& ray, const Hit& hit, bool coordinates) {
    const Shape& shape = scene.shapes[hit.shape];
    auto point = [&](const Ray& local) {
        return visit_geometry(
            scene, shape,
            Overloaded{
                [&](const TriangleMesh& mesh) { return mesh_point(mesh, shape, hit, ray.time, coordinates); },
                [&](const Quadric& quadric) {
                    return quadric_point(quadric, shape, local, hit, coordinates);
                },
                [&](const Curves& curves) { return curve_point(curves, shape, local, hit); },
                [&](const BilinearMesh& mesh) { return patch_point(mesh, shape, hit, coordinates); }});
    };
    SurfacePoint s;
    if (hit.instance == no_index) {
        s = point(ray);
    } else {
        const auto place = [&](const Transform& t) {
            s = point(
                {Vec3f(t.inverse_point(Vec3d(ray.o))), Vec3f(t.inverse_vector(Vec3d(ray.d))), ray.t_max});
            transform_by(t, s);
        };
        const Instance& instance = scene.instances[hit.instance];
        if (instance.motion == no_index) {
            place(instance.world_from_object);
        } else {
            // The ray tracer interpolates in single precision.
            const Motion& motion = scene.motions[instance.motion];
            place(motion.at(ray.time));
            s.error += coordinate_error(static_cast<float>(motion.reach()));
        }
    }
    s.shape = &shape;
    s.primitive = hit.primitive;
    s.b = {hit.b1, hit.b2};
    return s;
}

} // namespace montelux
