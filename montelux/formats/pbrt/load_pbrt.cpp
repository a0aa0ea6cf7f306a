#include "montelux/formats/pbrt/load_pbrt.h"

#include <utility>
#include <vector>

#include "montelux/formats/pbrt/scene_parser.h"

namespace montelux {

SceneDescription load_pbrt(const std::filesystem::path& path, Warnings& warnings,
                           std::vector<std::filesystem::path>* files_read, FileSource* source,
                           std::shared_ptr<TexelFile> texel_file) {
    DiskFiles disk;
    FileSource& files = source != nullptr ? *source : disk;
    return load_pbrt(read_unpacked(files, path), path, warnings, files_read, files, std::move(texel_file));
}

SceneDescription load_pbrt(std::vector<std::uint8_t> bytes, const std::filesystem::path& path,
                           Warnings& warnings, std::vector<std::filesystem::path>* files_read,
                           FileSource& source, std::shared_ptr<TexelFile> texel_file) {
    pbrt::Diagnostics diagnostics(warnings);
    std::uint32_t file = diagnostics.add_file(path.string());
    pbrt::Files files(path.parent_path(), source, diagnostics);
    files.count_as_read(path);
    pbrt::Directives builder(files, diagnostics, std::move(texel_file));
    pbrt::SceneParser parser(files, builder, diagnostics);
    parser.enter(path);
    pbrt::Location end = parser.parse({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, file);
    SceneDescription description = builder.finish(end);
    if (files_read) *files_read = files.files_read();
    return description;
}

SceneDescription parse_pbrt(std::string_view text, const std::string& name,
                            const std::filesystem::path& folder, Warnings& warnings,
                            std::shared_ptr<TexelFile> texel_file) {
    pbrt::Diagnostics diagnostics(warnings);
    std::uint32_t file = diagnostics.add_file(name);
    DiskFiles disk;
    pbrt::Files files(folder, disk, diagnostics);
    pbrt::Directives builder(files, diagnostics, std::move(texel_file));
    pbrt::SceneParser parser(files, builder, diagnostics);
    return builder.finish(parser.parse(text, file));
}

} // namespace montelux
