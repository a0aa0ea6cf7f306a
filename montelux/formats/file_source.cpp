#include "montelux/formats/file_source.h"

#include "montelux/formats/gunzip.h"
#include "montelux/mc/io/byte_stream.h"
#include "montelux/mc/io/file.h"
#include "montelux/mc/math/error.h"

namespace montelux {

bool DiskFiles::exists(const std::filesystem::path& path) {
    std::error_code ignored;
    return std::filesystem::exists(path, ignored);
}

std::vector<std::uint8_t> DiskFiles::read(const std::filesystem::path& path, std::size_t max_bytes) {
    return read_file_bytes(path, max_bytes);
}

std::vector<std::uint8_t> FileBundle::to_bytes() const {
    ByteWriter out;
    std::size_t size = 0;
    for (const auto& [path, bytes] : contents) size += path.size() + bytes.size() + 16;
    for (const auto& [path, there] : exists) size += path.size() + 9;
    out.reserve(size + 16);
    out.put(static_cast<std::uint64_t>(exists.size()));
    for (const auto& [path, there] : exists) {
        out.put_text(path);
        out.put(static_cast<std::uint8_t>(there));
    }
    out.put(static_cast<std::uint64_t>(contents.size()));
    for (const auto& [path, bytes] : contents) {
        out.put_text(path);
        out.put_bytes(bytes);
    }
    return out.take();
}

FileBundle FileBundle::from_bytes(std::span<const std::uint8_t> bytes) {
    ByteReader in(bytes, "bundle of scene files");
    FileBundle bundle;
    for (auto n = in.get<std::uint64_t>(); n > 0; --n) {
        const std::string path = in.get_text();
        bundle.exists[path] = in.get<std::uint8_t>() != 0;
    }
    for (auto n = in.get<std::uint64_t>(); n > 0; --n) {
        const std::string path = in.get_text();
        const auto content = in.get_bytes();
        bundle.contents[path].assign(content.begin(), content.end());
    }
    if (!in.at_end()) throw Error("bundle of scene files", "it is longer than it says");
    return bundle;
}

bool RecordedFiles::exists(const std::filesystem::path& path) {
    return bundle_.exists[path.string()] = disk_.exists(path);
}

std::vector<std::uint8_t> RecordedFiles::read(const std::filesystem::path& path, std::size_t max_bytes) {
    const std::string name = path.string();
    if (auto known = bundle_.contents.find(name); known != bundle_.contents.end()) return known->second;
    return bundle_.contents[name] = disk_.read(path, max_bytes);
}

bool BundledFiles::exists(const std::filesystem::path& path) {
    const auto known = bundle_.exists.find(path.string());
    return known != bundle_.exists.end() && known->second;
}

std::vector<std::uint8_t> BundledFiles::read(const std::filesystem::path& path, std::size_t) {
    const auto known = bundle_.contents.find(path.string());
    if (known == bundle_.contents.end()) throw Error(path.string(), "is not among the files that were sent");
    return known->second;
}

std::vector<std::uint8_t> read_unpacked(FileSource& source, const std::filesystem::path& path) {
    constexpr std::size_t max_file_bytes = std::size_t{16} << 30;
    std::vector<std::uint8_t> bytes = source.read(path, max_file_bytes);
    if (path.extension() == ".gz") return gunzip(bytes, path.string(), max_file_bytes);
    return bytes;
}

} // namespace montelux
