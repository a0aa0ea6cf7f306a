// Shapes: triangle meshes and quadrics as plain values, and what each instance of them carries.
#pragma once

#include <variant>
#include <vector>

#include "montelux/mc/math/transform.h"
#include "montelux/scene/index.h"
#include "montelux/scene/texture/texture.h"

namespace montelux {

// Positions are in world space, or in the space of the object definition that the mesh belongs to.
// `normals` and `uvs` are empty or one a vertex. Indices are checked by the builder.
struct TriangleMesh {
    std::vector<Point3f> positions;
    std::vector<Normal3f> normals;
    std::vector<Point2f> uvs;
    std::vector<Index> indices; // three a triangle

    std::size_t triangle_count() const { return indices.size() / 3; }
};

// All points at `radius` from the origin of object space with z in [z_min, z_max] and azimuth in [0, phi_max]
// (radians).
struct Sphere {
    float radius = 1, z_min = -1, z_max = 1, phi_max = 6.2831853f;
    Transform world_from_object;
};

// The points of the plane z = height between two radii, azimuth in [0, phi_max] (radians); normal +z.
struct Disk {
    float height = 0, radius = 1, inner_radius = 0, phi_max = 6.2831853f;
    Transform world_from_object;
};

using Quadric = std::variant<Sphere, Disk>;

// The geometry of a shape: a place in the scene's array of its kind.
struct MeshIndex {
    Index index = no_index; // into Scene::meshes
};
struct QuadricIndex {
    Index index = no_index; // into Scene::quadrics
};
using ShapeGeometry = std::variant<MeshIndex, QuadricIndex>;

// One shape of the scene.
struct Shape {
    ShapeGeometry geometry;
    Index material = no_index;
    Index light = no_index;  // its area light, into Scene::lights
    FloatParameter alpha{1}; // cut-out: a point is there with this probability
    // The geometric normal of the primitive is turned around. Set when the file asks for it xor its transform
    // swaps handedness; where a mesh has vertex normals these decide the side instead (file's wish alone
    // applied).
    bool flip_normal = false;
};

// Calls f with the TriangleMesh or the Quadric of the shape. S: Scene or SceneView.
template <typename S, typename F>
decltype(auto) visit_geometry(const S& scene, const Shape& shape, const F& f) {
    struct Visitor {
        const S& scene;
        const F& f;
        decltype(auto) operator()(MeshIndex i) const { return f(scene.meshes[i.index]); }
        decltype(auto) operator()(QuadricIndex i) const { return f(scene.quadrics[i.index]); }
    };
    return std::visit(Visitor{scene, f}, shape.geometry);
}
// Null for other geometry.
template <typename S>
const Quadric* quadric_of(const S& scene, const Shape& shape) {
    const auto* i = std::get_if<QuadricIndex>(&shape.geometry);
    return i != nullptr ? &scene.quadrics[i->index] : nullptr;
}

} // namespace montelux
