// Files as bytes: reading a whole file with a size limit, and writing one that appears complete or not at
// all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <span>
#include <vector>

namespace montelux {

// Throws Error when the path is no regular file (a pipe would block), cannot be read, or is longer than
// `max_bytes`.
std::vector<std::uint8_t> read_file_bytes(const std::filesystem::path& path, std::size_t max_bytes);

// Collects output in a temporary file beside `path`, which commit() renames over it. Without a commit the
// temporary file is removed and `path` is as it was. A symbolic link is followed, not replaced.
// Every failure is an Error that names the path and the reason; after one, commit() fails as well.
class AtomicFile {
  public:
    explicit AtomicFile(const std::filesystem::path& path);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    void write(std::span<const std::uint8_t> bytes);
    void write(const void* data, std::size_t size);
    std::uint64_t position() const { return position_; }
    void seek(std::uint64_t position);
    void commit();

  private:
    [[noreturn]] void fail(const char* doing, int error_number);
    std::filesystem::path path_, target_, temporary_;
    std::FILE* file_ = nullptr;
    std::uint64_t position_ = 0;
    bool failed_ = false;
};

} // namespace montelux
