#include "montelux/scene/light/emissive_shape.h"

#include "montelux/mc/warp/disk.h"
#include "montelux/mc/warp/triangle.h"

namespace montelux {

std::optional<EmissivePoint> sample_area(const LightContext& context, Index index, Index part, Vec2f u) {
    const Shape& shape = context.scene.shapes[index];
    EmissivePoint s;
    s.hit = {.t = 0, .shape = index, .primitive = part};
    if (shape.mesh != no_index) {
        const LightTriangle& t = context.tables().triangle(context.light, part);
        if (!(t.area > 0)) return std::nullopt;
        const Vec3f b = sample_uniform_triangle(u);
        s.hit.b1 = b.y;
        s.hit.b2 = b.z;
        s.p = t.p0 + b.y * t.e1 + b.z * t.e2;
        s.n = t.n;
        const TriangleMesh& mesh = context.scene.meshes[shape.mesh];
        if (!mesh.normals.empty()) {
            const Index* v = &mesh.indices[3 * std::size_t{part}];
            if (turns_normal(interpolated_normal(mesh, v, b.y, b.z), t.n)) s.n = -t.n;
        }
        s.error = t.error;
        s.area_density = 1 / t.area;
    } else if (const auto& disk = context.tables().disk(context.light)) {
        const Vec2f d = sample_uniform_disk_concentric(u);
        s.p = disk->center + d.x * disk->s + d.y * disk->t;
        s.n = shape.flip_normal ? -disk->n : disk->n;
        const Vec3f reach = abs(disk->center) + abs(disk->s) + abs(disk->t);
        s.error = coordinate_error(disk->n, reach);
        s.area_density = 1 / disk->area;
    } else {
        const QuadricAreaSample q = sample_area(context.scene.quadrics[shape.quadric], u);
        s.p = Vec3f(q.point.p);
        s.n = Vec3f(shape.flip_normal ? -q.point.n : q.point.n);
        s.error = coordinate_error(s.n, abs(s.p));
        s.area_density = static_cast<float>(q.pdf);
    }
    return s;
}

float area_density(const LightContext& context, Index index, Index part, Point3f p) {
    const Shape& shape = context.scene.shapes[index];
    if (shape.mesh != no_index) {
        const float area = context.tables().triangle(context.light, part).area;
        return area > 0 ? 1 / area : 0;
    }
    if (const auto& disk = context.tables().disk(context.light)) return 1 / disk->area;
    return static_cast<float>(area_pdf(context.scene.quadrics[shape.quadric], Vec3d(p)));
}

} // namespace montelux
