#include "montelux/formats/mesh_scene.h"

#include <utility>

#include "montelux/formats/file_messages.h"
#include "montelux/formats/ply.h"
#include "montelux/formats/stl.h"
#include "montelux/formats/vertex_normals.h"
#include "montelux/mc/math/error.h"
#include "montelux/scene/build/scene_builder.h"

namespace montelux {
namespace {

// The colours of the vertices, if the mesh has any, on the model_material.
SceneDescription scene_of_mesh(TriangleMesh mesh, const std::filesystem::path& path, Warnings& warnings,
                               const LoadOptions& options) {
    if (mesh.indices.empty()) throw Error(path.string(), "the file has no triangles");
    if (options.files_read != nullptr) options.files_read->push_back(path);
    SceneDescription d = model_description();
    constexpr SourceLocation whole_file{0, 0, 0};
    FileMessages messages(path.string(), warnings);
    SceneBuilder builder(d.scene, messages);
    DiffuseMaterial material = model_material();
    if (!mesh.colors.empty()) {
        d.scene.spectrum_textures.emplace_back(VertexColorTexture{});
        material.reflectance = {{}, 0};
    }
    d.scene.materials.emplace_back(material);
    builder.add_shape(std::move(mesh), {.material = 0, .name = path.stem().string()}, whole_file);
    builder.finish(whole_file, false);
    return d;
}

} // namespace

SceneDescription model_description() {
    SceneDescription d;
    d.film.width = 800;
    d.film.height = 600;
    d.film.crop = {0, 0, d.film.width, d.film.height};
    d.sampler.spp = 128;
    d.integrator.max_depth = 8;
    // Few triangles with smooth normals stand for smooth surfaces.
    d.integrator.shading_terminator = ShadingTerminator::soft;
    d.integrator.environment_lookup = EnvironmentLookup::bilinear; // the studio's light has no edges
    d.has_camera = d.has_lights = false;
    d.wants_studio = true;
    d.up = {0, 1, 0};
    return d;
}

SceneDescription load_ply(const std::vector<std::uint8_t>& bytes, const std::filesystem::path& path,
                          Warnings& warnings, const LoadOptions& options) {
    PlyMesh ply = parse_ply(bytes, path.string(), true);
    if (ply.degenerate > 0)
        warnings.add(path.string(),
                     std::to_string(ply.degenerate) + " faces of fewer than 3 corners are left out");
    if (ply.mesh.normals.empty()) add_normals(ply.mesh);
    return scene_of_mesh(std::move(ply.mesh), path, warnings, options);
}

SceneDescription load_stl(const std::vector<std::uint8_t>& bytes, const std::filesystem::path& path,
                          Warnings& warnings, const LoadOptions& options) {
    SceneDescription d = scene_of_mesh(parse_stl(bytes, path.string()), path, warnings, options);
    d.up = {0, 0, 1};
    return d;
}

} // namespace montelux
