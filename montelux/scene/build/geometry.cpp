#include "montelux/scene/build/geometry.h"

#include <string>

#include "montelux/mc/math/error.h"
#include "montelux/scene/build/float_range.h"

namespace montelux {
namespace {

void check_one_a_vertex(std::size_t count, std::size_t vertices, const char* what) {
    if (count != 0 && count != vertices)
        throw Error("the mesh has " + std::to_string(count) + " " + what + " for " +
                    std::to_string(vertices) + " vertices; expected one per vertex");
}

void check_deformation(const TriangleMesh& mesh) {
    const std::size_t vertices = mesh.positions.size();
    check_one_a_vertex(mesh.end_positions.size(), vertices, "positions at the end");
    check_one_a_vertex(mesh.end_normals.size(), vertices, "normals at the end");
    if (!mesh.end_normals.empty() && !mesh.deforms())
        throw Error("the mesh has normals at the end, but no positions");
    if (!mesh.deforms()) return;
    if (mesh.normals.empty() != mesh.end_normals.empty())
        throw Error(std::string("the mesh has normals at the ") +
                    (mesh.normals.empty() ? "end, but none at the start" : "start, but none at the end"));
    if (!mesh.tangents.empty()) throw Error("a mesh that deforms has no vertex tangents");
    for (std::size_t i = 0; i < vertices; ++i)
        if (!is_finite(mesh.end_positions[i]))
            throw Error("vertex " + std::to_string(i) + " lies at infinity in world space at the end");
    for (const Normal3f& n : mesh.end_normals)
        if (!is_finite(n)) throw Error("a vertex normal is not finite in world space at the end");
}

// Of triangles or patches.
template <typename Mesh>
void check_mesh(const Mesh& mesh, std::size_t corners, const std::string& primitive) {
    const std::size_t vertices = mesh.positions.size();
    if (vertices > no_index) throw Error("the mesh has more than 2^32 vertices");
    if (mesh.indices.size() % corners != 0)
        throw Error("the mesh has " + std::to_string(mesh.indices.size()) + " indices; expected " +
                    (corners == 3 ? "three" : "four") + " per " + primitive);
    if (mesh.indices.size() / corners >= no_index) throw Error("the mesh has more than 2^32 primitives");
    check_one_a_vertex(mesh.normals.size(), vertices, "normals");
    check_one_a_vertex(mesh.uvs.size(), vertices, "texture coordinates");
    if constexpr (requires { mesh.tangents; }) {
        check_one_a_vertex(mesh.tangents.size(), vertices, "tangents");
        for (const Vec3f& t : mesh.tangents)
            if (!is_finite(t)) throw Error("a vertex tangent is not finite in world space");
    }
    if constexpr (requires { mesh.colors; }) {
        check_one_a_vertex(mesh.colors.size(), vertices, "colours");
        check_one_a_vertex(mesh.opacities.size(), vertices, "opacities");
        check_one_a_vertex(mesh.second_uvs.size(), vertices, "second texture coordinates");
        for (const Vec3f& c : mesh.colors)
            if (!is_finite(c) || !(c.x >= 0 && c.y >= 0 && c.z >= 0))
                throw Error("the colour of a vertex is negative or not finite");
        for (const float o : mesh.opacities)
            if (!(o >= 0 && o <= 1)) throw Error("the opacity of a vertex is not between 0 and 1");
    }
    for (std::size_t i = 0; i < mesh.indices.size(); ++i)
        if (mesh.indices[i] >= vertices)
            throw Error(primitive + " " + std::to_string(i / corners) + " refers to vertex " +
                        std::to_string(mesh.indices[i]) + "; the mesh has " + std::to_string(vertices) +
                        " vertices");
    for (std::size_t i = 0; i < vertices; ++i)
        if (!is_finite(mesh.positions[i]))
            throw Error("vertex " + std::to_string(i) + " lies at infinity in world space");
    for (const Normal3f& n : mesh.normals)
        if (!is_finite(n)) throw Error("a vertex normal is not finite in world space");
    if constexpr (requires { mesh.end_positions; }) check_deformation(mesh);
}

void check_curves(const Curves& curves) {
    const std::size_t count = curves.segment_count();
    const bool ribbon = curves.kind == Curves::Kind::ribbon;
    if (curves.widths.size() != count || curves.normals.size() != (ribbon ? count : 0))
        throw Error("curves need two widths per segment, and ribbons two normals");
    for (std::size_t i = 0; i < count; ++i) {
        const CurveSegment s = curves.segment(i);
        if (!(s.width0 >= 0 && s.width1 >= 0)) throw Error("a curve has a negative width");
        if (!fits_float(bounds_of(s))) throw Error("a curve reaches to infinity in world space");
        if (!s.normals) continue;
        for (const Vec3d n : *s.normals)
            if (!(std::abs(length_squared(n) - 1) < 1e-4))
                throw Error("a normal of a ribbon is not of unit length");
    }
}

template <typename Mesh>
void transform_vertices(Mesh& mesh, const Transform& t, bool reverse_orientation) {
    const bool stays = t.matrix() == Matrix4{};
    const auto move_points = [&](std::vector<Point3f>& points) {
        if (!stays)
            for (Point3f& p : points) p = t.point(p);
    };
    const auto move_normals = [&](std::vector<Normal3f>& normals) {
        for (Normal3f& n : normals) {
            if (!stays) n = t.normal(n);
            if (reverse_orientation) n = -n;
        }
    };
    move_points(mesh.positions);
    move_normals(mesh.normals);
    if constexpr (requires { mesh.end_positions; }) {
        move_points(mesh.end_positions);
        move_normals(mesh.end_normals);
    }
    if constexpr (requires { mesh.tangents; })
        for (Vec3f& tangent : mesh.tangents) tangent = t.vector(tangent);
}

} // namespace

std::size_t primitive_count(const Geometry& geometry) {
    if (const auto* mesh = std::get_if<TriangleMesh>(&geometry)) return mesh->triangle_count();
    if (const auto* curves = std::get_if<Curves>(&geometry)) return curves->segment_count();
    if (const auto* patches = std::get_if<BilinearMesh>(&geometry)) return patches->patch_count();
    return 1;
}

void transform_mesh(TriangleMesh& mesh, const Transform& t, bool reverse_orientation) {
    transform_vertices(mesh, t, reverse_orientation);
}

void transform_mesh(BilinearMesh& mesh, const Transform& t, bool reverse_orientation) {
    transform_vertices(mesh, t, reverse_orientation);
}

void check_geometry(const Geometry& geometry) {
    if (const auto* mesh = std::get_if<TriangleMesh>(&geometry)) return check_mesh(*mesh, 3, "triangle");
    if (const auto* curves = std::get_if<Curves>(&geometry)) return check_curves(*curves);
    if (const auto* mesh = std::get_if<BilinearMesh>(&geometry)) return check_mesh(*mesh, 4, "patch");
    if (!fits_float(world_bounds(std::get<Quadric>(geometry))))
        throw Error("the shape reaches to infinity in world space");
}

float object_area(const Quadric& quadric) {
    struct Area {
        float operator()(const Sphere& s) const { return s.phi_max * s.radius * (s.z_max - s.z_min); }
        float operator()(const Disk& d) const {
            return 0.5f * d.phi_max * (d.radius * d.radius - d.inner_radius * d.inner_radius);
        }
        float operator()(const Cylinder& c) const { return c.phi_max * c.radius * (c.z_max - c.z_min); }
    };
    return std::visit(Area{}, quadric);
}

} // namespace montelux
