#include "montelux/formats/load_scene.h"

#include <string>
#include <utility>

#include "montelux/formats/file_kind.h"
#include "montelux/formats/pbrt/load_pbrt.h"
#include "montelux/mc/math/error.h"

namespace montelux {

SceneDescription load_scene(const std::filesystem::path& path, Warnings& warnings,
                            const LoadOptions& options) {
    DiskFiles disk;
    FileSource& files = options.source != nullptr ? *options.source : disk;
    std::vector<std::uint8_t> bytes = read_unpacked(files, path);
    const FileKind kind = file_kind(bytes);
    if (!kind.name.empty())
        throw Error(path.string(), "looks like " + kind.name +
                                       "; expected a scene of pbrt-v4 (.pbrt or .pbrt.gz)" +
                                       (kind.hint.empty() ? "" : ": " + kind.hint));
    // All other text goes to the pbrt reader, which reports what it does not understand.
    return load_pbrt(std::move(bytes), path, warnings, options.files_read, files, options.texel_file);
}

} // namespace montelux
