// Shapes: geometry as plain values, and the attributes of each shape.
#pragma once

#include <variant>
#include <vector>

#include "montelux/mc/math/transform.h"
#include "montelux/scene/index.h"
#include "montelux/scene/shape/bilinear_mesh.h"
#include "montelux/scene/shape/curves.h"
#include "montelux/scene/texture/texture.h"

namespace montelux {

// Positions are in world space, or in the space of the mesh's object definition. `normals`, `uvs`, `tangents`,
// `colors`, `opacities` and `second_uvs` are empty or one per vertex. The builder checks the indices.
struct TriangleMesh {
    std::vector<Point3f> positions;
    std::vector<Normal3f> normals;
    std::vector<Point2f> uvs;
    std::vector<Index> indices; // three per triangle
    // Of vertices, along the first axis of the shading frame; empty: along dp/du.
    std::vector<Vec3f> tangents{};
    // Of a mesh that deforms: at time 1. `positions` and `normals` are then those at time 0, and both change linearly.
    // Else empty.
    std::vector<Point3f> end_positions{};
    std::vector<Normal3f> end_normals{};
    // Of vertices, linear sRGB, for textures that read them; empty: white.
    std::vector<Vec3f> colors{};
    // Of vertices, in [0, 1], for textures of numbers that read them; empty: 1.
    std::vector<float> opacities{};
    // For textures whose mapping asks for them; empty: (0, 0).
    std::vector<Point2f> second_uvs{};

    std::size_t triangle_count() const { return indices.size() / 3; }
    bool deforms() const { return !end_positions.empty(); }
    // Time in [0, 1].
    Point3f position(Index vertex, float time) const {
        if (!deforms()) return positions[vertex];
        return (1 - time) * positions[vertex] + time * end_positions[vertex];
    }
    Normal3f normal(Index vertex, float time) const {
        if (!deforms()) return normals[vertex];
        return (1 - time) * normals[vertex] + time * end_normals[vertex];
    }
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
    // Texture coordinates: u from the inner to the outer edge and v around, as in Mitsuba 3, instead of pbrt-v4's.
    bool polar = false;
    Transform world_from_object;
};

// The points at `radius` from the z axis with z in [z_min, z_max] and azimuth in [0, phi_max] (radians); open
// at both ends; normal away from the axis.
struct Cylinder {
    float radius = 1, z_min = -1, z_max = 1, phi_max = 6.2831853f;
    Transform world_from_object;
};

using Quadric = std::variant<Sphere, Disk, Cylinder>;

// The geometry of a shape: an index into the scene's array of its kind.
struct MeshIndex {
    Index index = no_index; // into Scene::meshes
};
struct QuadricIndex {
    Index index = no_index; // into Scene::quadrics
};
struct CurvesIndex {
    Index index = no_index; // into Scene::curves
};
struct BilinearMeshIndex {
    Index index = no_index; // into Scene::bilinear_meshes
};
using ShapeGeometry = std::variant<MeshIndex, QuadricIndex, CurvesIndex, BilinearMeshIndex>;

// The media on both sides of a surface.
struct MediumInterface {
    Index inside = no_index, outside = no_index; // into Scene::media; no_index: vacuum

    // Otherwise the surface lies within one medium, whichever that is.
    bool is_transition() const { return inside != outside; }
};

// One shape of the scene.
struct Shape {
    ShapeGeometry geometry;
    Index material = no_index;
    Index light = no_index;  // its area light, into Scene::lights
    FloatParameter alpha{1}; // cut-out: the probability that a point is present
    // The geometric normal of the primitive is reversed. Set if the file reverses orientation xor the
    // transform swaps handedness. Vertex normals, if present, decide the side instead (reversed only by the
    // file).
    bool flip_normal = false;
    MediumInterface media{}; // the geometric normal points outside
};

// Calls f with the TriangleMesh, Quadric, Curves or BilinearMesh of the shape. S: Scene or SceneView.
template <typename S, typename F>
decltype(auto) visit_geometry(const S& scene, const Shape& shape, const F& f) {
    struct Visitor {
        const S& scene;
        const F& f;
        decltype(auto) operator()(MeshIndex i) const { return f(scene.meshes[i.index]); }
        decltype(auto) operator()(QuadricIndex i) const { return f(scene.quadrics[i.index]); }
        decltype(auto) operator()(CurvesIndex i) const { return f(scene.curves[i.index]); }
        decltype(auto) operator()(BilinearMeshIndex i) const { return f(scene.bilinear_meshes[i.index]); }
    };
    return std::visit(Visitor{scene, f}, shape.geometry);
}
// Null for other geometry.
template <typename S>
const Quadric* quadric_of(const S& scene, const Shape& shape) {
    const auto* i = std::get_if<QuadricIndex>(&shape.geometry);
    return i != nullptr ? &scene.quadrics[i->index] : nullptr;
}
template <typename S>
const TriangleMesh* mesh_of(const S& scene, const Shape& shape) {
    const auto* i = std::get_if<MeshIndex>(&shape.geometry);
    return i != nullptr ? &scene.meshes[i->index] : nullptr;
}
template <typename S>
const Curves* curves_of(const S& scene, const Shape& shape) {
    const auto* i = std::get_if<CurvesIndex>(&shape.geometry);
    return i != nullptr ? &scene.curves[i->index] : nullptr;
}
template <typename S>
const BilinearMesh* bilinear_mesh_of(const S& scene, const Shape& shape) {
    const auto* i = std::get_if<BilinearMeshIndex>(&shape.geometry);
    return i != nullptr ? &scene.bilinear_meshes[i->index] : nullptr;
}

} // namespace montelux
