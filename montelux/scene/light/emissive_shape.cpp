#include "montelux/scene/light/emissive_shape.h"

#include <cmath>

#include "montelux/mc/math/overloaded.h"
#include "montelux/mc/warp/disk.h"
#include "montelux/mc/warp/triangle.h"

namespace montelux {

namespace {

std::optional<EmissivePoint> sample_triangle(const TriangleMesh& mesh, const LightTriangle& t, Index part,
                                             Vec2f u, float time = 0) {
    std::optional<EmissivePoint> point;
    if (!(t.area > 0)) return point;
    EmissivePoint& s = point.emplace();
    const Vec3f b = sample_uniform_triangle(u);
    s.hit.b1 = b.y;
    s.hit.b2 = b.z;
    s.p = t.p0 + b.y * t.e1 + b.z * t.e2;
    s.n = t.n;
    if (!mesh.normals.empty()) {
        const Index* v = &mesh.indices[3 * std::size_t{part}];
        if (turns_normal(interpolated_normal(mesh, v, b.y, b.z, time), t.n)) s.n = -t.n;
    }
    s.error = t.error;
    s.area_density = 1 / t.area;
    return point;
}

std::optional<EmissivePoint> sample_patch(const BilinearMesh& mesh, const Shape& shape, Index part, Vec2f u) {
    std::optional<EmissivePoint> point;
    const BilinearPatch patch = mesh.patch(part);
    const PatchSample at = sample_area(patch, Vec2d(u));
    if (!(at.pdf > 0)) return point;
    EmissivePoint& s = point.emplace();
    s.hit.b1 = static_cast<float>(at.u);
    s.hit.b2 = static_cast<float>(at.v);
    s.p = Vec3f(point_of(patch, at.u, at.v));
    s.n = patch_normal(mesh, shape, part, at.u, at.v);
    s.error = patch_error(patch, s.n);
    s.area_density = static_cast<float>(at.pdf);
    return point;
}

std::optional<EmissivePoint> sample_disk(const WorldDisk& disk, bool flip_normal, Vec2f u) {
    std::optional<EmissivePoint> point;
    EmissivePoint& s = point.emplace();
    const Vec2f d = sample_uniform_disk_concentric(u);
    s.p = disk.center + d.x * disk.s + d.y * disk.t;
    s.n = flip_normal ? -disk.n : disk.n;
    const Vec3f reach = abs(disk.center) + abs(disk.s) + abs(disk.t);
    s.error = coordinate_error(disk.n, reach);
    s.area_density = 1 / disk.area;
    return point;
}

std::optional<EmissivePoint> sample_quadric(const Quadric& quadric, bool flip_normal, Vec2f u) {
    std::optional<EmissivePoint> point;
    EmissivePoint& s = point.emplace();
    const QuadricAreaSample q = sample_area(quadric, u);
    s.p = Vec3f(q.point.p);
    s.n = Vec3f(flip_normal ? -q.point.n : q.point.n);
    s.error = coordinate_error(s.n, abs(s.p));
    s.area_density = static_cast<float>(q.pdf);
    return point;
}

} // namespace

LightTriangle light_triangle(const TriangleMesh& mesh, const Shape& shape, std::size_t primitive,
                             float time) {
    const Index* v = &mesh.indices[3 * primitive];
    const Point3f p1 = mesh.position(v[1], time), p2 = mesh.position(v[2], time);
    LightTriangle t;
    t.p0 = mesh.position(v[0], time);
    t.e1 = p1 - t.p0;
    t.e2 = p2 - t.p0;
    const Vec3f c = cross(t.e1, t.e2);
    const float len = length(c);
    t.area = 0.5f * len;
    if (!(len > 0)) return t;
    t.n = shape.flip_normal ? -normalize(c) : normalize(c);
    Vec3f reach = max(abs(t.p0), max(abs(p1), abs(p2)));
    if (mesh.deforms()) // rounded in proportion to the ends
        for (std::size_t k = 0; k < 3; ++k)
            reach = max(reach, max(abs(mesh.positions[v[k]]), abs(mesh.end_positions[v[k]])));
    t.error = coordinate_error(t.n, reach);
    return t;
}

std::optional<EmissivePoint> sample_area(const LightContext& context, Index index, Index part, Vec2f u) {
    const Shape& shape = context.scene.shapes[index];
    auto s = visit_geometry(
        context.scene, shape,
        Overloaded{[&](const TriangleMesh& mesh) {
                       if (context.tables().deforms(context.light)) [[unlikely]]
                           return sample_triangle(mesh, light_triangle(mesh, shape, part, context.time), part,
                                                  u, context.time);
                       return sample_triangle(mesh, context.tables().triangle(context.light, part), part, u);
                   },
                   [&](const Quadric& quadric) {
                       const auto& disk = context.tables().disk(context.light);
                       return disk ? sample_disk(*disk, shape.flip_normal, u)
                                   : sample_quadric(quadric, shape.flip_normal, u);
                   },
                   [&](const BilinearMesh& mesh) { return sample_patch(mesh, shape, part, u); },
                   [](const Curves&) { return std::optional<EmissivePoint>(); }});
    if (s) {
        s->hit.shape = index;
        s->hit.primitive = part;
    }
    return s;
}

float area_density(const LightContext& context, Index index, const LightHit& hit) {
    const Shape& shape = context.scene.shapes[index];
    return visit_geometry(
        context.scene, shape,
        Overloaded{[&](const TriangleMesh& mesh) {
                       const float area = context.tables().deforms(context.light)
                                              ? light_triangle(mesh, shape, hit.part, context.time).area
                                              : context.tables().area(context.light, hit.part);
                       return area > 0 ? 1 / area : 0;
                   },
                   [&](const Quadric& quadric) {
                       const auto& disk = context.tables().disk(context.light);
                       return disk ? 1 / disk->area : static_cast<float>(area_pdf(quadric, Vec3d(hit.p)));
                   },
                   [&](const BilinearMesh& mesh) {
                       return static_cast<float>(
                           area_pdf(mesh.patch(hit.part), double(hit.b.x), double(hit.b.y)));
                   },
                   [](const Curves&) { return 0.0f; }});
}

EmitterPlace::EmitterPlace(const LightContext& context, Index index) {
    const Instance& instance = context.scene.instances[index];
    if (instance.motion == no_index) {
        world_from_shape_ = instance.world_from_object;
        return;
    }
    const Motion& motion = context.scene.motions[instance.motion];
    world_from_shape_ = motion.at(context.time);
    error_ = coordinate_error(static_cast<float>(motion.reach()));
}

void EmitterPlace::move(EmissivePoint& point) const {
    point.p = world_from_shape_.point(point.p);
    point.n = normalize(world_from_shape_.normal(point.n));
    point.error = transformed_error(point.error, world_from_shape_, point.p) + error_;
    point.area_density /= area_scale(point.n);
}

// The area changes by |det M| |M^-T n'| for the unit normal n' in the shape's space, which is M^T n over its length.
float EmitterPlace::area_scale(Normal3f n) const {
    const Matrix4& m = world_from_shape_.matrix();
    Vec3d back;
    for (std::size_t j = 0; j < 3; ++j)
        back[static_cast<int>(j)] =
            m.m[0][j] * double(n.x) + m.m[1][j] * double(n.y) + m.m[2][j] * double(n.z);
    return static_cast<float>(std::abs(m.linear_determinant()) / length(back));
}

Quadric placed(Quadric quadric, const Transform& world_from_shape) {
    std::visit([&](auto& q) { q.world_from_object = world_from_shape * q.world_from_object; }, quadric);
    return quadric;
}

} // namespace montelux
