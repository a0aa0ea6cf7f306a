#include "montelux/formats/pbrt/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "montelux/formats/loop_subdivision.h"
#include "montelux/formats/pbrt/bilinear_mesh.h"
#include "montelux/formats/pbrt/coverage.h"
#include "montelux/formats/pbrt/curves.h"
#include "montelux/formats/pbrt/mesh_parameters.h"
#include "montelux/formats/ply.h"
#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/error.h"

namespace montelux::pbrt {
namespace {

float radians(float degrees) { return std::clamp(degrees, 0.0f, 360.0f) * (pi_f / 180); }

Quadric read_sphere(ParameterReader& r, const Transform& world_from_object) {
    Sphere s;
    s.radius = r.number("radius", 1);
    if (!(s.radius > 0)) r.error("radius", "parameter 'radius' must be positive");
    float a = r.number("zmin", -s.radius), b = r.number("zmax", s.radius);
    s.z_min = std::clamp(std::min(a, b), -s.radius, s.radius);
    s.z_max = std::clamp(std::max(a, b), -s.radius, s.radius);
    s.phi_max = radians(r.number("phimax", 360));
    s.world_from_object = world_from_object;
    return s;
}

Quadric read_cylinder(ParameterReader& r, const Transform& world_from_object) {
    Cylinder c;
    c.radius = r.number("radius", 1);
    if (!(c.radius > 0)) r.error("radius", "parameter 'radius' must be positive");
    const float a = r.number("zmin", -1), b = r.number("zmax", 1);
    c.z_min = std::min(a, b);
    c.z_max = std::max(a, b);
    c.phi_max = radians(r.number("phimax", 360));
    c.world_from_object = world_from_object;
    return c;
}

Quadric read_disk(ParameterReader& r, const Transform& world_from_object) {
    Disk d;
    d.height = r.number("height", 0);
    d.radius = r.number("radius", 1);
    if (!(d.radius > 0)) r.error("radius", "parameter 'radius' must be positive");
    d.inner_radius = r.number("innerradius", 0);
    if (!(d.inner_radius >= 0 && d.inner_radius <= d.radius))
        r.error("innerradius", "parameter 'innerradius' is not between 0 and 'radius'");
    d.phi_max = radians(r.number("phimax", 360));
    d.world_from_object = world_from_object;
    return d;
}

TriangleMesh read_triangle_mesh(ParameterReader& r) {
    TriangleMesh mesh;
    mesh.positions = r.triples("P", ParameterType::point3);
    if (mesh.positions.empty()) r.error("shape 'trianglemesh' needs vertex positions 'P'");
    if (r.integers("indices").empty()) {
        if (mesh.positions.size() != 3)
            r.error("shape 'trianglemesh' needs 'indices' when it has not exactly 3 vertices");
        mesh.indices = {0, 1, 2};
    } else {
        mesh.indices = read_indices(r, mesh.positions.size(), 3, "triangle");
    }
    read_vertex_values(r, mesh);
    r.ignored("faceIndices"); // only Ptex textures use it
    return mesh;
}

TriangleMesh read_ply_mesh(ParameterReader& r, Files& files, DisplacementReader& displacements,
                           const Transform& world_from_object) {
    std::optional<std::string> name = r.string("filename");
    if (!name) r.error("shape 'plymesh' needs a parameter 'filename'");
    Location at = r.at("filename");
    std::filesystem::path path = files.find(*name, at);
    std::vector<std::uint8_t> bytes = files.read(path, at);
    PlyMesh ply;
    try {
        ply = parse_ply(bytes, path.string(), r.boolean("vertexcolors", false));
    } catch (const Error& e) {
        r.error("filename", e.what());
    }
    auto note = [&](std::size_t count, const char* what) {
        if (count > 0) r.diagnostics().warn(at, path.string() + ": " + std::to_string(count) + what);
    };
    note(ply.quads, " quadrilaterals are split into two triangles each");
    note(ply.polygons, " faces of more than four corners are split into fans of triangles");
    note(ply.degenerate, " faces of fewer than three corners are left out");
    displacements.displace(r, ply.mesh, world_from_object);
    return std::move(ply.mesh);
}

TriangleMesh read_loop_subdivision(ParameterReader& r, SubdivisionBudget& budget) {
    int levels = r.integer("levels", 3);
    if (levels < 0) r.error("levels", "parameter 'levels' is negative");
    r.choice("scheme", {"loop"}, "loop");
    std::vector<Vec3f> positions = r.triples("P", ParameterType::point3);
    if (positions.empty()) r.error("shape 'loopsubdiv' needs vertex positions 'P'");
    std::vector<Index> indices = read_indices(r, positions.size(), 3, "triangle");
    if (indices.empty()) r.error("shape 'loopsubdiv' needs 'indices'");
    if (!budget.take(indices.size() / 3, levels))
        r.error("levels", std::to_string(levels) +
                              " levels would take the triangles of all 'loopsubdiv' shapes together beyond " +
                              std::to_string(budget.limit()));
    TriangleMesh mesh;
    try {
        SubdividedMesh fine = subdivide_loop(positions, indices, levels);
        mesh.positions = std::move(fine.positions);
        mesh.normals = std::move(fine.normals);
        mesh.indices = std::move(fine.indices);
    } catch (const Error& e) {
        r.error(e.what());
    }
    return mesh;
}

} // namespace

Geometry read_shape(ParameterReader& r, const std::string& plugin, const Transform& world_from_object,
                    bool reverse_orientation, bool emits, Files& files, SubdivisionBudget& budget,
                    DisplacementReader& displacements, const Transform& displacement_space) {
    if (plugin == "sphere") return read_sphere(r, world_from_object);
    if (plugin == "disk") return read_disk(r, world_from_object);
    if (plugin == "cylinder") return read_cylinder(r, world_from_object);
    if (plugin == "curve") return read_curves(r, world_from_object);
    if (plugin == "bilinearmesh") return read_bilinear_mesh(r, world_from_object, reverse_orientation, emits);
    TriangleMesh mesh;
    if (plugin == "trianglemesh")
        mesh = read_triangle_mesh(r);
    else if (plugin == "plymesh")
        mesh = read_ply_mesh(r, files, displacements, displacement_space);
    else if (plugin == "loopsubdiv")
        mesh = read_loop_subdivision(r, budget);
    else
        r.error("unknown shape " + in_quotes(plugin) + plugin_suggestion("Shape", plugin));
    transform_mesh(mesh, world_from_object, reverse_orientation);
    return mesh;
}

} // namespace montelux::pbrt
