#include "montelux/formats/pbrt/files.h"

#include <string>

#include "montelux/formats/gunzip.h"
#include "montelux/mc/math/error.h"

namespace montelux::pbrt {
namespace {

// No file that a scene consists of is larger, compressed or not.
constexpr std::size_t max_file_bytes = std::size_t{16} << 30;

} // namespace

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

std::vector<std::uint8_t> Files::read_alone(const std::filesystem::path& path) {
    std::vector<std::uint8_t> bytes = source_.read(path, max_file_bytes);
    if (path.extension() == ".gz") return gunzip(bytes, path.string(), max_file_bytes);
    return bytes;
}

std::vector<std::uint8_t> Files::read(const std::filesystem::path& path, Location at) {
    count_as_read(path);
    try {
        return read_alone(path);
    } catch (const Error& e) {
        diagnostics_.error(at, e.what());
    }
}

} // namespace montelux::pbrt
