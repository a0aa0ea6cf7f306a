#include "montelux/scene/shape/shading_terminator.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace montelux {

namespace {

struct Corner {
    Point3f p;
    Normal3f n; // unit, or zero where the mesh has no usable one
};

std::array<Corner, 3> corners_of(const TriangleMesh& mesh, Index primitive, float time,
                                 const Transform* world_from_object) {
    std::array<Corner, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) {
        const Index v = mesh.indices[3 * std::size_t{primitive} + i];
        Corner& c = corners[i];
        c = {mesh.position(v, time), mesh.normal(v, time)};
        if (world_from_object != nullptr) c = {world_from_object->point(c.p), world_from_object->normal(c.n)};
        const float len2 = length_squared(c.n);
        c.n = len2 > 0 ? c.n / std::sqrt(len2) : Normal3f{};
    }
    return corners;
}

// `side`: 1 if the normals point to the side of the ray, else -1.
Point3f raised(const std::array<Corner, 3>& corners, Point3f p, Vec2f b, float side) {
    const std::array weights{1 - b.x - b.y, b.x, b.y};
    Vec3f rise;
    for (std::size_t i = 0; i < 3; ++i) {
        const Corner& c = corners[i];
        const Vec3f n = c.n * side;
        rise += n * (weights[i] * std::max(-dot(p - c.p, n), 0.0f));
    }
    return p + rise;
}

} // namespace

bool has_vertex_normals(const SceneView& scene, const Shape& shape) {
    const TriangleMesh* mesh = mesh_of(scene, shape);
    return mesh != nullptr && !mesh->normals.empty();
}

std::optional<Point3f> raised_position(const SceneView& scene, const Ray& ray, const Hit& hit,
                                       const SurfacePoint& s) {
    if (!has_vertex_normals(scene, *s.shape) || s.ng == s.ns) return std::nullopt;
    const float side = -dot(ray.d, s.ns);
    if (!(side * dot(ray.d, s.ng) < 0)) return std::nullopt;
    const TriangleMesh& mesh = *mesh_of(scene, *s.shape);
    const auto raise = [&](const Transform* t) {
        return raised(corners_of(mesh, hit.primitive, ray.time, t), s.p, s.b, std::copysign(1.0f, side));
    };
    if (hit.instance == no_index) return raise(nullptr);
    const Instance& instance = scene.instances[hit.instance];
    if (instance.motion == no_index) return raise(&instance.world_from_object);
    const Transform moved = scene.motions[instance.motion].at(ray.time);
    return raise(&moved);
}

} // namespace montelux
