#include "montelux/formats/scene_files.h"

#include <algorithm>
#include <string>
#include <vector>

#include "montelux/mc/math/error.h"
#include "montelux/scene/build/quoted.h"

namespace montelux {

std::filesystem::path SceneFiles::find(std::string_view name, SourceLocation at) const {
    if (name.empty()) diagnostics_.error(at, "an empty file name");
    if (name.find('\0') != std::string_view::npos)
        diagnostics_.error(at, "a NUL byte in the file name " + quoted(name));
    std::vector<std::filesystem::path> folders(folders_.rbegin(), folders_.rend());
    folders.push_back(main_folder_);
    folders.push_back(std::filesystem::path(diagnostics_.file_name(at.file)).parent_path());
    std::string slashes(name); // of names that were written on Windows
    std::ranges::replace(slashes, '\\', '/');
    for (const std::string& spelling : {std::string(name), slashes})
        for (const std::filesystem::path& folder : folders)
            if (std::filesystem::path found = folder / spelling; source_.exists(found)) return found;
    diagnostics_.error(at, "there is no file '" + (main_folder_ / name).string() + "'");
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
