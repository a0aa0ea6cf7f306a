#include "montelux/mc/io/file.h"

#include <atomic>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <string>
#include <sys/stat.h>
#include <unistd.h>

#include "montelux/mc/math/error.h"

namespace montelux {

namespace {

std::string reason(int error_number) { return std::strerror(error_number); }

std::filesystem::path folder_of(const std::filesystem::path& path) {
    return path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
}

} // namespace

InputFile::InputFile(const std::filesystem::path& path) : path_(path) {
    // O_NONBLOCK: opening a pipe that nobody writes to would wait for ever.
    descriptor_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (descriptor_ < 0)
        throw Error(path.empty() ? "''" : path.string(), "cannot be opened: " + reason(errno));
    struct stat info {};
    std::string refusal;
    if (::fstat(descriptor_, &info) != 0)
        refusal = reason(errno);
    else if (S_ISDIR(info.st_mode))
        refusal = "it is a folder";
    else if (!S_ISREG(info.st_mode))
        refusal = "it is not a regular file";
    if (!refusal.empty()) {
        ::close(descriptor_);
        throw Error(path.string(), "cannot be read: " + refusal);
    }
    size_ = static_cast<std::uint64_t>(info.st_size);
}

InputFile::~InputFile() { ::close(descriptor_); }

void InputFile::read(std::span<std::uint8_t> bytes) {
    std::size_t done = 0;
    while (done < bytes.size()) {
        const ssize_t n = ::read(descriptor_, bytes.data() + done, bytes.size() - done);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) throw Error(path_.string(), "cannot be read: " + reason(errno));
        if (n == 0) throw Error(path_.string(), "became shorter while it was read");
        done += static_cast<std::size_t>(n);
    }
}

std::vector<std::uint8_t> read_file_bytes(const std::filesystem::path& path, std::size_t max_bytes) {
    InputFile file(path);
    if (file.size() > max_bytes)
        throw Error(path.string(), "has " + std::to_string(file.size()) + " bytes; the limit is " +
                                       std::to_string(max_bytes) + " bytes");
    std::vector<std::uint8_t> bytes(file.size());
    file.read(bytes);
    return bytes;
}

std::filesystem::path output_target(const std::filesystem::path& path) {
    std::filesystem::path target = path;
    // Links may form a circle; opening such a file fails with its own sentence.
    for (int links = 0; links < 40; ++links) {
        std::error_code error;
        const auto next = std::filesystem::read_symlink(target, error);
        if (error) break;
        target = target.parent_path() / next;
    }
    return target;
}

void sync_folder_of(const std::filesystem::path& path) {
    const auto folder = folder_of(path);
    const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0 && errno == EACCES) return; // one may write to folders that one may not read
    int error_number = descriptor < 0 ? errno : 0;
    if (descriptor >= 0) {
        if (::fsync(descriptor) != 0 && errno != EINVAL && errno != EROFS) error_number = errno;
        ::close(descriptor);
    }
    if (error_number != 0)
        throw Error(path.string(), "is written, but a loss of power might undo that: folder '" +
                                       folder.string() + "': " + reason(error_number));
}

AtomicFile::AtomicFile(const std::filesystem::path& path) : path_(path), target_(output_target(path)) {
    std::error_code ignored;
    auto status = std::filesystem::status(target_, ignored);
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
        throw Error(path.string(), std::filesystem::is_directory(status)
                                       ? "cannot be written: it is a folder"
                                       : "cannot be written: it is not a regular file");
    const auto folder = folder_of(target_);
    static std::atomic<unsigned> counter{0};
    for (int attempt = 0; attempt < 100; ++attempt) {
        temporary_ = folder / (".montelux-" + std::to_string(::getpid()) + "-" +
                               std::to_string(counter.fetch_add(1)) + ".tmp");
        int fd = ::open(temporary_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (fd < 0 && errno == EEXIST) continue;
        if (fd < 0) {
            int error_number = errno;
            temporary_.clear();
            throw Error(path.string(),
                        "cannot be written: folder '" + folder.string() + "': " + reason(error_number));
        }
        file_ = ::fdopen(fd, "w+b");
        if (!file_) {
            int error_number = errno;
            ::close(fd);
            ::unlink(temporary_.c_str());
            throw Error(path.string(), "cannot be written: " + reason(error_number));
        }
        return;
    }
    throw Error(path.string(), "cannot be written: no free temporary name in '" + folder.string() + "'");
}

AtomicFile::~AtomicFile() {
    if (file_) std::fclose(file_);
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void AtomicFile::fail(const char* doing, int error_number) {
    failed_ = true;
    throw Error(path_.string(), std::string("cannot be written: ") + doing + ": " + reason(error_number));
}

void AtomicFile::write(std::span<const std::uint8_t> bytes) { write(bytes.data(), bytes.size()); }

void AtomicFile::write(const void* data, std::size_t size) {
    if (size == 0) return;
    if (std::fwrite(data, 1, size, file_) != size) fail("writing", errno);
    position_ += size;
}

void AtomicFile::seek(std::uint64_t position) {
    if (::fseeko(file_, static_cast<off_t>(position), SEEK_SET) != 0) fail("seeking", errno);
    position_ = position;
}

void AtomicFile::finish() {
    if (failed_ || !file_) throw Error(path_.string(), "cannot be written: an earlier write failed");
    if (std::fflush(file_) != 0) fail("writing", errno);
    if (::fsync(::fileno(file_)) != 0 && errno != EINVAL) fail("writing", errno);
    std::FILE* file = file_;
    file_ = nullptr;
    if (std::fclose(file) != 0) fail("closing", errno);
    finished_ = true;
}

void AtomicFile::commit() {
    if (!finished_) finish();
    finished_ = false;
    if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail("renaming", errno);
    temporary_.clear();
}

} // namespace montelux
