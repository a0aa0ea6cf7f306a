#include "montelux/formats/pbrt/files.h"

#include <string>

#include "montelux/mc/math/error.h"

namespace montelux::pbrt {

std::filesystem::path Files::find(std::string_view name, Location at) const {
    if (name.empty()) diagnostics_.error(at, "an empty file name");
    if (name.find('\0') != std::string_view::npos)
        diagnostics_.error(at, "a NUL byte in the file name " + in_quotes(name));
    std::filesystem::path path(name);
    std::filesystem::path first = main_folder_ / path;
    std::filesystem::path second =
        std::filesystem::path(diagnostics_.file_name(at.file)).parent_path() / path;
    if (source_.exists(first)) return first;
    if (source_.exists(second)) return second;
    diagnostics_.error(at, "there is no file '" + first.string() + "'");
}

std::vector<std::uint8_t> Files::read(const std::filesystem::path& path, Location at) {
    count_as_read(path);
    try {
        return read_unpacked(source_, path);
    } catch (const Error& e) {
        diagnostics_.error(at, e.what());
    }
}

} // namespace montelux::pbrt
