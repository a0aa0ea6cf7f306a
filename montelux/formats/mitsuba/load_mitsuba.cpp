#include "montelux/formats/mitsuba/load_mitsuba.h"

#include "montelux/formats/mitsuba/scene_graph.h"
#include "montelux/formats/mitsuba/scene_reader.h"
#include "montelux/formats/scene_files.h"
#include "montelux/formats/text_diagnostics.h"

namespace montelux {

SceneDescription load_mitsuba(const std::vector<std::uint8_t>& bytes, const std::filesystem::path& path,
                              Warnings& warnings, FileSource& source, const LoadOptions& options) {
    TextDiagnostics diagnostics(warnings);
    SceneFiles files(path.parent_path(), source, diagnostics);
    files.count_as_read(path);
    const mitsuba::SceneGraph graph =
        mitsuba::read_scene_graph(bytes, path, options.definitions, diagnostics, files);
    SceneDescription description;
    description.scene.texel_file = options.texel_file;
    mitsuba::SceneReader(graph, description, options).read();
    if (options.files_read != nullptr)
        options.files_read->insert(options.files_read->end(), files.files_read().begin(),
                                   files.files_read().end());
    return description;
}

} // namespace montelux
