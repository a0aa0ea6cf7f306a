#include "montelux/formats/mitsuba/mesh_files.h"

#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "montelux/formats/mitsuba/serialized.h"
#include "montelux/formats/obj/obj.h"
#include "montelux/formats/ply.h"
#include "montelux/formats/vertex_normals.h"
#include "montelux/formats/warnings.h"
#include "montelux/mc/math/error.h"

namespace montelux::mitsuba {
namespace {

TriangleMesh read_obj(std::span<const std::uint8_t> bytes, const std::string& name, const Plugin& shape) {
    Warnings warnings;
    ObjModel model = parse_obj(bytes, name, warnings, {.split = false, .make_normals = false});
    for (const std::string& message : warnings.messages()) shape.warn(message);
    if (model.parts.empty()) throw Error(name, "there are no faces");
    TriangleMesh mesh = std::move(model.parts.front().mesh);
    if (mesh.normals.empty()) add_smooth_normals(mesh, welded(mesh.positions));
    return mesh;
}

TriangleMesh read_ply(std::span<const std::uint8_t> bytes, const std::string& name, const Plugin& shape) {
    constexpr bool with_colors = true; // the attribute "vertex_color"
    PlyMesh ply = parse_ply(bytes, name, with_colors);
    if (ply.degenerate > 0)
        shape.warn(name + ": " + std::to_string(ply.degenerate) +
                   " faces of fewer than three corners are left out");
    return std::move(ply.mesh);
}

} // namespace

TriangleMesh read_mesh_file(Plugin& shape) {
    const bool is_obj = shape.type() == "obj";
    const std::filesystem::path path = shape.file("filename");
    const std::vector<std::uint8_t> bytes = shape.graph().files.read(path, shape.at());
    bool face_normals = shape.flag("face_normals", false);
    TriangleMesh mesh;
    try {
        if (shape.type() == "serialized") {
            const auto number = static_cast<std::uint32_t>(
                shape.integer("shape_index", 0, 0, std::numeric_limits<std::uint32_t>::max()));
            SerializedMesh read = parse_serialized(bytes, path.string(), number);
            mesh = std::move(read.mesh);
            if (!shape.has("face_normals")) face_normals = read.face_normals;
        } else {
            mesh = is_obj ? read_obj(bytes, path.string(), shape) : read_ply(bytes, path.string(), shape);
            if (shape.flag("flip_tex_coords", is_obj))
                for (Point2f& uv : mesh.uvs) uv.y = 1 - uv.y;
        }
    } catch (const LocatedError&) {
        throw;
    } catch (const Error& e) {
        shape.error(e.what());
    }
    if (face_normals)
        mesh.normals.clear();
    else if (mesh.normals.empty())
        add_smooth_normals(mesh);
    return mesh;
}

} // namespace montelux::mitsuba
