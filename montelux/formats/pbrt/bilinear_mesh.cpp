#include "montelux/formats/pbrt/bilinear_mesh.h"

#include <array>

#include "montelux/formats/pbrt/mesh_parameters.h"

namespace montelux::pbrt {
namespace {

bool is_parallelogram(const BilinearMesh& mesh, std::size_t patch) {
    const BilinearPatch p = mesh.patch(patch);
    const Vec3d twist = abs(p.p00 - p.p10 - p.p01 + p.p11);
    const Vec3d reach = max(max(abs(p.p00), abs(p.p10)), max(abs(p.p01), abs(p.p11)));
    if (max_component(twist) > 0x1p-22 * max_component(reach)) return false; // rounding of single precision
    if (mesh.uvs.empty()) return true;
    const Index* v = &mesh.indices[4 * patch];
    return mesh.uvs[v[0]] + mesh.uvs[v[3]] == mesh.uvs[v[1]] + mesh.uvs[v[2]];
}

TriangleMesh triangles_of(const BilinearMesh& mesh) {
    constexpr std::array<Point2f, 4> own_uvs = {Point2f{0, 0}, {1, 0}, {0, 1}, {1, 1}};
    TriangleMesh out;
    for (std::size_t patch = 0; patch < mesh.patch_count(); ++patch) {
        const auto first = static_cast<Index>(out.positions.size());
        for (std::size_t k = 0; k < 4; ++k) {
            const Index v = mesh.indices[4 * patch + k];
            out.positions.push_back(mesh.positions[v]);
            out.uvs.push_back(mesh.uvs.empty() ? own_uvs[k] : mesh.uvs[v]);
        }
        for (const Index corner : {0u, 1u, 3u, 0u, 3u, 2u}) out.indices.push_back(first + corner);
    }
    return out;
}

} // namespace

Geometry read_bilinear_mesh(ParameterReader& r, const Transform& world_from_object, bool reverse_orientation,
                            bool emits) {
    BilinearMesh mesh;
    mesh.positions = r.triples("P", ParameterType::point3);
    if (mesh.positions.empty()) r.error("shape 'bilinearmesh' needs vertex positions 'P'");
    if (r.integers("indices").empty()) {
        if (mesh.positions.size() != 4)
            r.error("shape 'bilinearmesh' needs 'indices' when it has not exactly 4 vertices");
        mesh.indices = {0, 1, 2, 3};
    } else {
        mesh.indices = read_indices(r, mesh.positions.size(), 4, "patch");
    }
    read_vertex_values(r, mesh);
    r.ignored("emissionfilename"); // guides pbrt's sampling, without effect on the picture
    r.ignored("faceIndices");      // only Ptex textures use it
    transform_mesh(mesh, world_from_object, reverse_orientation);
    bool flat = !emits && mesh.normals.empty() && mesh.patch_count() < (std::size_t{1} << 30);
    for (std::size_t patch = 0; flat && patch < mesh.patch_count(); ++patch)
        flat = is_parallelogram(mesh, patch);
    return flat ? Geometry(triangles_of(mesh)) : Geometry(std::move(mesh));
}

} // namespace montelux::pbrt
