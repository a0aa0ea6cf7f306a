// Where the bytes of scene files come from: the disk, or a process that has read them already.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace montelux {

class FileSource {
  public:
    virtual ~FileSource() = default;
    virtual bool exists(const std::filesystem::path& path) = 0;
    // The whole file. Throws Error, also for one of more than `max_bytes`.
    virtual std::vector<std::uint8_t> read(const std::filesystem::path& path, std::size_t max_bytes) = 0;
};

class DiskFiles final : public FileSource {
  public:
    bool exists(const std::filesystem::path& path) override;
    std::vector<std::uint8_t> read(const std::filesystem::path& path, std::size_t max_bytes) override;
};

// The queries to a file source with their answers: enough to repeat them in another process.
struct FileBundle {
    std::map<std::string, bool> exists; // by path as queried
    std::map<std::string, std::vector<std::uint8_t>> contents;

    std::vector<std::uint8_t> to_bytes() const;
    // Throws Error for bytes that to_bytes() did not produce.
    static FileBundle from_bytes(std::span<const std::uint8_t> bytes);
};

// Reads from the disk, each file once, and keeps the content.
class RecordedFiles final : public FileSource {
  public:
    bool exists(const std::filesystem::path& path) override;
    std::vector<std::uint8_t> read(const std::filesystem::path& path, std::size_t max_bytes) override;

    const FileBundle& bundle() const { return bundle_; }

  private:
    DiskFiles disk_;
    FileBundle bundle_;
};

// Answers from a bundle only: reading a file that is not in it is an Error.
class BundledFiles final : public FileSource {
  public:
    explicit BundledFiles(FileBundle bundle) : bundle_(std::move(bundle)) {}
    bool exists(const std::filesystem::path& path) override;
    std::vector<std::uint8_t> read(const std::filesystem::path& path, std::size_t max_bytes) override;

  private:
    FileBundle bundle_;
};

// The whole file; one whose name ends in ".gz" is decompressed. Files are limited to 16 GiB, compressed or
// not. Throws Error.
std::vector<std::uint8_t> read_unpacked(FileSource& source, const std::filesystem::path& path);

} // namespace montelux
