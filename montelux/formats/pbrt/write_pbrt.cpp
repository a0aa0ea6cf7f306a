#include "montelux/formats/pbrt/write_pbrt.h"

#include "montelux/formats/pbrt/scene_writer.h"
#include "montelux/mc/math/error.h"

namespace montelux {

std::vector<std::filesystem::path> write_pbrt(const SceneDescription& description,
                                              const std::filesystem::path& path, Warnings& warnings) {
    if (path.extension() != ".pbrt")
        throw Error(path.string(), "cannot be written: a scene's name ends in .pbrt");
    AtomicFile out(path);
    pbrt::SideFiles files(path);
    pbrt::SceneWriter(description, files, warnings, out).write();
    out.finish();
    std::vector<std::filesystem::path> written = files.commit();
    out.commit();
    written.push_back(path);
    return written;
}

} // namespace montelux
