#include "montelux/formats/load_scene.h"

#include <limits>
#include <string>
#include <utility>

#include "montelux/formats/file_kind.h"
#include "montelux/formats/gltf/load_gltf.h"
#include "montelux/formats/mesh_scene.h"
#include "montelux/formats/mitsuba/load_mitsuba.h"
#include "montelux/formats/obj/load_obj.h"
#include "montelux/formats/pbrt/load_pbrt.h"
#include "montelux/mc/math/error.h"

namespace montelux {

namespace {

// Cameras by name are asked of glTF and Mitsuba scenes only, variants and time of glTF, definitions of Mitsuba's.
void check_options(const std::filesystem::path& path, const FileKind& kind, const LoadOptions& options) {
    if (!(options.shutter >= 0 && options.shutter <= std::numeric_limits<double>::max()))
        throw Error("shutter", "expected a number of seconds that is not negative");
    if (options.shutter > 0 && !options.time)
        throw Error("shutter", "expected a time of the animations, when it opens");
    if (kind.format == SceneFormat::none) return;
    if (kind.format != SceneFormat::mitsuba && !options.definitions.empty())
        throw Error(path.string(), "only Mitsuba scenes have parameters that can be defined");
    if (kind.format == SceneFormat::gltf) return;
    if (kind.format != SceneFormat::mitsuba && options.camera)
        throw Error(path.string(), "only glTF and Mitsuba scenes have a choice of cameras");
    for (const auto& [is_given, what] : {std::pair(options.variant.has_value(), "variants of materials"),
                                         std::pair(options.time.has_value(), "a time of animations")})
        if (is_given) throw Error(path.string(), std::string("only glTF scenes have ") + what);
}

} // namespace

SceneDescription load_scene(const std::filesystem::path& path, Warnings& warnings,
                            const LoadOptions& options) {
    DiskFiles disk;
    FileSource& files = options.source != nullptr ? *options.source : disk;
    std::vector<std::uint8_t> bytes = read_unpacked(files, path);
    if (bytes.empty()) throw Error(path.string(), "the file is empty");
    const FileKind kind = file_kind(bytes);
    check_options(path, kind, options);
    switch (kind.format) {
    case SceneFormat::pbrt:
        return load_pbrt(std::move(bytes), path, warnings, options.files_read, files, options.texel_file);
    case SceneFormat::gltf:
        return load_gltf(std::move(bytes), path, warnings, files, options);
    case SceneFormat::mitsuba:
        return load_mitsuba(bytes, path, warnings, files, options);
    case SceneFormat::obj:
        return load_obj(bytes, path, warnings, options);
    case SceneFormat::ply:
        return load_ply(bytes, path, warnings, options);
    case SceneFormat::stl:
        return load_stl(bytes, path, warnings, options);
    case SceneFormat::none:
        break;
    }
    // A binary STL file is recognised by its size; one that was cut short, by its name.
    if (path.extension() == ".stl" || path.extension() == ".STL")
        return load_stl(bytes, path, warnings, options);
    throw Error(path.string(), "this is " + kind.name +
                                   "; pbrt-v4, glTF 2.0, Mitsuba 3, OBJ, PLY and STL are read" +
                                   (kind.hint.empty() ? "" : ": " + kind.hint));
}

} // namespace montelux
