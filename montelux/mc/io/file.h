// Files as bytes: reading a whole file with a size limit, and writing one that appears complete or not at
// all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace montelux {

// Throws Error when the path is no regular file (a pipe would block), cannot be read, or is longer than
// `max_bytes`.
std::vector<std::uint8_t> read_file_bytes(const std::filesystem::path& path, std::size_t max_bytes);

// A regular file, read from its beginning. Errors name the path.
class InputFile {
  public:
    // Pipes and devices are refused, since reading could block.
    explicit InputFile(const std::filesystem::path& path);
    ~InputFile();
    InputFile(const InputFile&) = delete;
    InputFile& operator=(const InputFile&) = delete;

    std::uint64_t size() const { return size_; }
    // Fills `bytes`, or throws.
    void read(std::span<std::uint8_t> bytes);

  private:
    std::filesystem::path path_;
    int descriptor_ = -1;
    std::uint64_t size_ = 0;
};

// The file that writing to `path` changes: the target of a symbolic link, which may be missing.
std::filesystem::path output_target(const std::filesystem::path& path);

// Makes changes of names in the folder of `path` permanent, if its file system can.
void sync_folder_of(const std::filesystem::path& path);

// Collects output in an unnamed file, which commit() moves to `path`. Without a commit `path` is unchanged,
// and nothing else is left. A symbolic link is followed, not replaced. On file systems without unnamed files
// it is a temporary file beside `path`, which a killed process leaves. Every failure is an Error with path
// and reason; later calls fail with the same Error, since a library in between may have swallowed it.
class AtomicFile {
  public:
    explicit AtomicFile(const std::filesystem::path& path);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    void write(std::span<const std::uint8_t> bytes);
    void write(const void* data, std::size_t size);
    std::uint64_t position() const { return written_to_ + buffer_.size(); }
    void seek(std::uint64_t position);
    // Ends the writing: all bytes are on the disk, not yet under their name.
    void finish();
    // Gives the file its name, after finish() where that has not been called.
    void commit();

  private:
    template <typename Call>
    int take_temporary_name(const std::string& doing, Call call);
    [[noreturn]] void fail(const std::string& doing, int error_number);
    void check_usable() const;
    void flush();
    void write_out(std::span<const std::uint8_t> bytes);

    std::filesystem::path path_, target_, temporary_;
    int descriptor_ = -1;
    std::vector<std::uint8_t> buffer_;
    std::uint64_t written_to_ = 0; // position of the buffer in the file
    std::string failure_;          // the first, as a sentence
    bool finished_ = false;
};

} // namespace montelux
