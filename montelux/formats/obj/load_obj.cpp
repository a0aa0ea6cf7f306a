#include "montelux/formats/obj/load_obj.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "montelux/formats/file_messages.h"
#include "montelux/formats/mesh_scene.h"
#include "montelux/formats/obj/mtl_materials.h"
#include "montelux/formats/obj/obj.h"
#include "montelux/image/color_encoding.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/math/nearest_name.h"
#include "montelux/scene/build/quoted.h"

namespace montelux {
namespace {

struct LibraryMaterial {
    MtlMaterial material;
    std::uint32_t file = 0; // of FileMessages
};

SourceLocation at_line(std::size_t line, std::uint32_t file = 0) {
    return {file, static_cast<std::uint32_t>(line), 1};
}

// Programs that write colours of vertices take them from pictures, in sRGB.
void decode(std::vector<Vec3f>& colors) {
    for (Vec3f& c : colors)
        for (int i = 0; i < 3; ++i) c[i] = srgb_to_linear(std::clamp(c[i], 0.0f, 1.0f));
}

double size_of(const ObjModel& model) {
    Bounds3 bounds;
    for (const ObjPart& part : model.parts)
        for (const Point3f p : part.mesh.positions) bounds.add(Vec3d(p));
    return 2 * bounds.radius();
}

} // namespace

SceneDescription load_obj(const std::vector<std::uint8_t>& bytes, const std::filesystem::path& path,
                          Warnings& warnings, const LoadOptions& options) {
    DiskFiles disk;
    FileSource& files = options.source != nullptr ? *options.source : disk;
    if (options.files_read != nullptr) options.files_read->push_back(path);
    ObjModel model = parse_obj(bytes, path.string(), warnings, {.colors = true});
    if (model.parts.empty()) throw Error(path.string(), "the file has no faces");

    SceneDescription d = model_description();
    d.scene.texel_file = options.texel_file;
    FileMessages messages(path.string(), warnings);
    SceneBuilder builder(d.scene, messages);
    MtlMaterials materials(path.parent_path(), files, builder, messages, options.files_read);
    std::map<std::string, LibraryMaterial> library;
    for (const ObjLibrary& l : model.libraries) {
        const std::optional<std::filesystem::path> found = materials.find(l.file);
        if (!found) {
            messages.warn(at_line(l.line),
                          "there is no file " + montelux::quoted(l.file) + " in the folder of the OBJ file");
            continue;
        }
        if (options.files_read != nullptr) options.files_read->push_back(*found);
        const std::uint32_t file = messages.add_file(found->string());
        for (MtlMaterial& m : parse_mtl(read_unpacked(files, *found), found->string(), warnings)) {
            LibraryMaterial& known = library[m.name];
            known = {std::move(m), file};
        }
    }

    const double size = size_of(model);
    std::map<std::string, MtlSurface> surfaces; // those in use
    const auto surface_of = [&](const ObjPart& part) -> const MtlSurface& {
        const auto [known, is_new] = surfaces.try_emplace(part.material);
        if (!is_new) return known->second;
        const auto found = library.find(part.material);
        if (found != library.end()) {
            known->second = materials.add(found->second.material, found->second.file, size);
            return known->second;
        }
        if (!part.material.empty() && !library.empty())
            messages.warn(at_line(part.line),
                          "no MTL file has the material " + montelux::quoted(part.material));
        DiffuseMaterial clay = model_material();
        if (!part.mesh.colors.empty()) {
            d.scene.spectrum_textures.emplace_back(VertexColorTexture{});
            clay.reflectance = {{}, static_cast<Index>(d.scene.spectrum_textures.size() - 1)};
        }
        d.scene.materials.emplace_back(clay);
        known->second.material = static_cast<Index>(d.scene.materials.size() - 1);
        known->second.is_clay = true;
        return known->second;
    };
    std::size_t line_of_hidden_colors = 0;
    for (ObjPart& part : model.parts) {
        const MtlSurface& surface = surface_of(part);
        if (!surface.is_clay && !part.mesh.colors.empty()) {
            if (line_of_hidden_colors == 0) line_of_hidden_colors = part.line;
            part.mesh.colors.clear();
        }
        decode(part.mesh.colors);
        ShapeSettings settings;
        settings.material = surface.material;
        settings.alpha = surface.alpha;
        settings.name = part.name;
        if (surface.emission) settings.emission = &*surface.emission;
        builder.add_shape(std::move(part.mesh), settings, at_line(part.line));
    }
    if (line_of_hidden_colors > 0)
        messages.warn(at_line(line_of_hidden_colors),
                      "colours of vertices are ignored where faces have a material of an MTL file");
    builder.finish(at_line(0), false);
    d.has_lights = !d.scene.lights.empty();
    return d;
}

} // namespace montelux
