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

class Descriptor {
  public:
    explicit Descriptor(int fd) : fd_(fd) {}
    ~Descriptor() {
        if (fd_ >= 0) ::close(fd_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    int get() const { return fd_; }

  private:
    int fd_;
};

} // namespace

std::vector<std::uint8_t> read_file_bytes(const std::filesystem::path& path, std::size_t max_bytes) {
    // O_NONBLOCK: opening a pipe that nobody writes to would wait for ever.
    Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    if (file.get() < 0)
        throw Error(path.empty() ? "''" : path.string(), "cannot be opened: " + reason(errno));
    struct stat info {};
    if (::fstat(file.get(), &info) != 0) throw Error(path.string(), "cannot be read: " + reason(errno));
    if (S_ISDIR(info.st_mode)) throw Error(path.string(), "cannot be read: it is a folder");
    if (!S_ISREG(info.st_mode)) throw Error(path.string(), "cannot be read: it is not a regular file");
    auto size = static_cast<std::uint64_t>(info.st_size);
    if (size > max_bytes)
        throw Error(path.string(), "has " + std::to_string(size) + " bytes; the limit is " +
                                       std::to_string(max_bytes) + " bytes");
    std::vector<std::uint8_t> bytes(size);
    std::size_t done = 0;
    while (done < bytes.size()) {
        ssize_t n = ::read(file.get(), bytes.data() + done, bytes.size() - done);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) throw Error(path.string(), "cannot be read: " + reason(errno));
        if (n == 0) throw Error(path.string(), "became shorter while it was read");
        done += static_cast<std::size_t>(n);
    }
    return bytes;
}

AtomicFile::AtomicFile(const std::filesystem::path& path) : path_(path), target_(path) {
    std::error_code ignored;
    if (std::filesystem::is_symlink(path, ignored)) {
        auto resolved = std::filesystem::weakly_canonical(path, ignored);
        if (!ignored) target_ = resolved;
    }
    auto status = std::filesystem::status(target_, ignored);
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
        throw Error(path.string(), std::filesystem::is_directory(status)
                                       ? "cannot be written: it is a folder"
                                       : "cannot be written: it is not a regular file");
    auto folder = target_.has_parent_path() ? target_.parent_path() : std::filesystem::path(".");
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

void AtomicFile::commit() {
    if (failed_ || !file_) throw Error(path_.string(), "cannot be written: an earlier write failed");
    if (std::fflush(file_) != 0) fail("writing", errno);
    if (::fsync(::fileno(file_)) != 0 && errno != EINVAL) fail("writing", errno);
    std::FILE* file = file_;
    file_ = nullptr;
    if (std::fclose(file) != 0) fail("closing", errno);
    if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail("renaming", errno);
    temporary_.clear();
}

} // namespace montelux
