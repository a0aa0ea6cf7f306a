#include "montelux/formats/load_scene.h"

#include <string>
#include <utility>

#include "montelux/formats/file_kind.h"
#include "montelux/formats/gltf/load_gltf.h"
#include "montelux/formats/pbrt/load_pbrt.h"
#include "montelux/mc/math/error.h"

namespace montelux {

SceneDescription load_scene(const std::filesystem::path& path, Warnings& warnings,
                            const LoadOptions& options) {
    DiskFiles disk;
    FileSource& files = options.source != nullptr ? *options.source : disk;
    std::vector<std::uint8_t> bytes = read_unpacked(files, path);
    const FileKind kind = file_kind(bytes);
    if (kind.is_gltf) return load_gltf(std::move(bytes), path, warnings, files, options);
    if (!kind.name.empty())
        throw Error(path.string(),
                    "looks like " + kind.name +
                        "; expected a scene of pbrt-v4 (.pbrt or .pbrt.gz) or glTF 2.0 (.gltf or .glb)" +
                        (kind.hint.empty() ? "" : ": " + kind.hint));
    for (const auto& [is_given, what] : {std::pair(options.camera.has_value(), "choice of cameras"),
                                         std::pair(options.variant.has_value(), "variants of materials"),
                                         std::pair(options.time.has_value(), "time of animations")})
        if (is_given) throw Error(path.string(), "a scene of pbrt-v4 has no " + std::string(what));
    // All other text goes to the pbrt reader, which reports what it does not understand.
    return load_pbrt(std::move(bytes), path, warnings, options.files_read, files, options.texel_file);
}

} // namespace montelux
