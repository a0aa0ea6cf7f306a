#include "montelux/scene/light/emissive_shape.h"

#include "montelux/mc/math/overloaded.h"
#include "montelux/mc/warp/disk.h"
#include "montelux/mc/warp/triangle.h"

namespace montelux {

namespace {

std::optional<EmissivePoint> sample_triangle(const TriangleMesh& mesh, const LightTriangle& t, Index part,
                                             Vec2f u) {
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
        if (turns_normal(interpolated_normal(mesh, v, b.y, b.z), t.n)) s.n = -t.n;
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

std::optional<EmissivePoint> sample_area(const LightContext& context, Index index, Index part, Vec2f u) {
    const Shape& shape = context.scene.shapes[index];
    auto s = visit_geometry(
        context.scene, shape,
        Overloaded{[&](const TriangleMesh& mesh) {
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
    return visit_geometry(context.scene, context.scene.shapes[index],
                          Overloaded{[&](const TriangleMesh&) {
                                         const float area = context.tables().area(context.light, hit.part);
                                         return area > 0 ? 1 / area : 0;
                                     },
                                     [&](const Quadric& quadric) {
                                         const auto& disk = context.tables().disk(context.light);
                                         return disk ? 1 / disk->area
                                                     : static_cast<float>(area_pdf(quadric, Vec3d(hit.p)));
                                     },
                                     [&](const BilinearMesh& mesh) {
                                         return static_cast<float>(area_pdf(
                                             mesh.patch(hit.part), double(hit.b.x), double(hit.b.y)));
                                     },
                                     [](const Curves&) { return 0.0f; }});
}

} // namespace montelux
