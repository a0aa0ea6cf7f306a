#include "montelux/formats/scene_files.h"

#include <string>

#include "montelux/mc/math/error.h"
#include "montelux/scene/build/quoted.h"

namespace montelux {

std::filesystem::path SceneFiles::find(std::string_view name, SourceLocation at) const {
    if (name.empty()) diagnostics_.error(at, "an empty file name");
    if (name.find('\0') != std::string_view::npos)
        diagnostics_.error(at, "a NUL byte in the file name " + quoted(name));
    const std::filesystem::path path(name);
    for (auto folder = folders_.rbegin(); folder != folders_.rend(); ++folder)
        if (std::filesystem::path found = *folder / path; source_.exists(found)) return found;
    std::filesystem::path first = main_folder_ / path;
    if (source_.exists(first)) return first;
    std::filesystem::path second =
        std::filesystem::path(diagnostics_.file_name(at.file)).parent_path() / path;
    if (source_.exists(second)) return second;
    diagnostics_.error(at, "there is no file '" + first.string() + "'");
}

std::vector<std::uint8_t> SceneFiles::read(const std::filesystem::path& path, SourceLocation at) {
    count_as_read(path);
    try {
        return read_unpacked(source_, path);
    } catch (const Error& e) {
        diagnostics_.error(at, e.what());
    }
}

} // namespace montelux
