#include "montelux/mc/io/file.h"

#include <atomic>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <string>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

#include "montelux/mc/math/error.h"

namespace montelux {

namespace {

constexpr std::size_t buffer_size = std::size_t{1} << 18;

std::string reason(int error_number) { return std::strerror(error_number); }

// Repeats a call that a signal interrupted before it did anything.
template <typename Call>
auto retried(Call call) {
    auto result = call();
    while (result < 0 && errno == EINTR) result = call();
    return result;
}

std::filesystem::path folder_of(const std::filesystem::path& path) {
    return path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
}

std::string own_path(int descriptor) { return "/proc/self/fd/" + std::to_string(descriptor); }

} // namespace

InputFile::InputFile(const std::filesystem::path& path) : path_(path) {
    // O_NONBLOCK: opening a pipe without a writer would block.
    descriptor_ = retried([&] { return ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK); });
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
        const ssize_t n =
            retried([&] { return ::read(descriptor_, bytes.data() + done, bytes.size() - done); });
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
    // Links may form a circle; opening such a file fails with its own error.
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
    const int descriptor =
        retried([&] { return ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); });
    if (descriptor < 0 && errno == EACCES) return; // a writable folder need not be readable
    int error_number = descriptor < 0 ? errno : 0;
    if (descriptor >= 0) {
        if (retried([&] { return ::fsync(descriptor); }) != 0 && errno != EINVAL && errno != EROFS)
            error_number = errno;
        ::close(descriptor);
    }
    if (error_number != 0)
        throw Error(path.string(), "is written, but a loss of power might undo that: folder '" +
                                       folder.string() + "': " + reason(error_number));
}

AtomicFile::AtomicFile(const std::filesystem::path& path) : path_(path), target_(output_target(path)) {
    std::error_code error;
    auto status = std::filesystem::status(target_, error);
    // An unnamed file would only fail when it is named.
    if (error == std::errc::filename_too_long)
        throw Error(path.string(), "cannot be written: " + reason(ENAMETOOLONG));
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
        throw Error(path.string(), std::filesystem::is_directory(status)
                                       ? "cannot be written: it is a folder"
                                       : "cannot be written: it is not a regular file");
    // An unnamed file disappears with its process, however that ends. Not every file system has them, and
    // without /proc they cannot be named.
    descriptor_ =
        retried([&] { return ::open(folder_of(target_).c_str(), O_RDWR | O_TMPFILE | O_CLOEXEC, 0666); });
    if (descriptor_ >= 0 && ::access(own_path(descriptor_).c_str(), F_OK) == 0) return;
    if (descriptor_ >= 0) ::close(descriptor_);
    const std::string folder = "folder '" + folder_of(target_).string() + "'";
    descriptor_ = take_temporary_name(folder, [&](const char* name) {
        const int made = retried([&] { return ::open(name, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666); });
        // As in /proc, which exists: "no such file" would be about the folder.
        if (made < 0 && errno == ENOENT && std::filesystem::is_directory(folder_of(target_), error))
            throw Error(path.string(), "cannot be written: no files can be made in the " + folder);
        return made;
    });
}

AtomicFile::~AtomicFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

// The result of `call` with the first name that is free.
template <typename Call>
int AtomicFile::take_temporary_name(const std::string& doing, Call call) {
    static std::atomic<unsigned> counter{0};
    int result = -1;
    for (int attempt = 0; attempt < 100; ++attempt) {
        const auto name = folder_of(target_) / (".montelux-" + std::to_string(::getpid()) + "-" +
                                                std::to_string(counter.fetch_add(1)) + ".tmp");
        result = call(name.c_str());
        if (result >= 0) temporary_ = name;
        if (result >= 0 || errno != EEXIST) break;
    }
    if (result < 0) fail(doing, errno);
    return result;
}

void AtomicFile::fail(const std::string& doing, int error_number) {
    failure_ = "cannot be written: " + doing + ": " + reason(error_number);
    throw Error(path_.string(), failure_);
}

void AtomicFile::check_usable() const {
    if (!failure_.empty()) throw Error(path_.string(), failure_);
    if (descriptor_ < 0) throw Error(path_.string(), "cannot be written: it has its name already");
}

void AtomicFile::write(std::span<const std::uint8_t> bytes) { write(bytes.data(), bytes.size()); }

void AtomicFile::write(const void* data, std::size_t size) {
    check_usable();
    const std::span<const std::uint8_t> bytes(static_cast<const std::uint8_t*>(data), size);
    if (buffer_.size() + size > buffer_size) flush();
    if (size > buffer_size)
        write_out(bytes);
    else
        buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
}

void AtomicFile::seek(std::uint64_t position) {
    flush();
    written_to_ = position;
}

void AtomicFile::flush() {
    write_out(buffer_);
    buffer_.clear();
}

void AtomicFile::write_out(std::span<const std::uint8_t> bytes) {
    while (!bytes.empty()) {
        const ssize_t n = retried([&] {
            return ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(written_to_));
        });
        if (n <= 0) fail("writing", n < 0 ? errno : EIO);
        written_to_ += static_cast<std::uint64_t>(n);
        bytes = bytes.subspan(static_cast<std::size_t>(n));
    }
}

void AtomicFile::finish() {
    check_usable();
    flush();
    // Some file systems cannot synchronise.
    if (retried([&] { return ::fsync(descriptor_); }) != 0 && errno != EINVAL) fail("writing", errno);
    finished_ = true;
}

void AtomicFile::commit() {
    if (!finished_) finish();
    finished_ = false;
    // Linking cannot replace an existing file, renaming can.
    if (temporary_.empty())
        take_temporary_name("naming", [&](const char* name) {
            return ::linkat(AT_FDCWD, own_path(descriptor_).c_str(), AT_FDCWD, name, AT_SYMLINK_FOLLOW);
        });
    const int descriptor = std::exchange(descriptor_, -1);
    // An interrupted close has closed the file, and its bytes are on the disk already.
    if (::close(descriptor) != 0 && errno != EINTR) fail("closing", errno);
    if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail("renaming", errno);
    temporary_.clear();
}

} // namespace montelux
