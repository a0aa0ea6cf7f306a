#include "montelux/image/texel_file.h"

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <pthread.h>
#include <string>
#include <sys/mman.h>
#include <unistd.h>
#include <utility>
#include <vector>

#if defined(__linux__)
#include <linux/magic.h>
#include <sys/vfs.h>
#endif

#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

constexpr const char* place = "memory of textures";
// Blocks begin at multiples of what the kernel maps at once.
constexpr std::size_t alignment = std::size_t{1} << 16;

std::size_t rounded_up(std::size_t bytes) { return (bytes + alignment - 1) / alignment * alignment; }

bool is_in_memory(const std::filesystem::path& folder) {
#if defined(__linux__)
    struct statfs info {};
    if (::statfs(folder.c_str(), &info) != 0) return false;
    const auto type = static_cast<unsigned long>(info.f_type) & 0xffffffff;
    return type == TMPFS_MAGIC || type == RAMFS_MAGIC;
#else
    static_cast<void>(folder);
    return false;
#endif
}

int open_unnamed(const std::filesystem::path& folder) {
#if defined(O_TMPFILE)
    const int descriptor = ::open(folder.c_str(), O_RDWR | O_TMPFILE | O_CLOEXEC, 0600);
    if (descriptor >= 0 || errno == ENOENT || errno == EACCES || errno == ENOSPC) return descriptor;
#endif
    // A file system without unnamed files.
    std::string name = (folder / ".montelux-texels-XXXXXX").string();
    const int made = ::mkostemp(name.data(), O_CLOEXEC);
    if (made >= 0) ::unlink(name.c_str());
    return made;
}

// Counts the forks of this process, before the two part.
std::atomic<std::uint64_t> forks{0};

void count_forks() {
    static const int error = ::pthread_atfork([] { ++forks; }, nullptr, nullptr);
    if (error != 0) throw Error(place, std::string("forks cannot be noticed: ") + std::strerror(error));
}

} // namespace

std::filesystem::path TexelFile::default_folder() {
    std::error_code error;
    std::filesystem::path folder = std::filesystem::temp_directory_path(error);
    if (error) {
        const char* given = std::getenv("TMPDIR");
        return given != nullptr ? given : "/tmp"; // which create() reports
    }
    const std::filesystem::path on_disk = "/var/tmp";
    if (std::getenv("TMPDIR") == nullptr && is_in_memory(folder) &&
        std::filesystem::is_directory(on_disk, error) && !is_in_memory(on_disk))
        return on_disk;
    return folder;
}

std::shared_ptr<TexelFile> TexelFile::create(std::size_t limit, const std::filesystem::path& folder) {
    if (limit < least_limit)
        throw Error(place, "the limit must be at least " + std::to_string(least_limit) + " bytes, but is " +
                               std::to_string(limit));
    return std::shared_ptr<TexelFile>(new TexelFile(limit, folder));
}

TexelFile::TexelFile(std::size_t limit, std::filesystem::path folder)
    : folder_(std::move(folder)), process_(::getpid()), limit_(limit) {
    count_forks();
    if (is_in_memory(folder_))
        throw Error(place, "the temporary folder '" + folder_.string() +
                               "' is itself in memory; set TMPDIR to a folder on a disk");
    descriptor_ = open_unnamed(folder_);
    if (descriptor_ < 0)
        throw Error(place, "no file can be made in the temporary folder '" + folder_.string() +
                               "': " + std::strerror(errno) + "; set TMPDIR to another folder");
}

TexelFile::~TexelFile() { ::close(descriptor_); }

void TexelFile::fail(const char* what, std::size_t bytes, int error_number) const {
    char size[32];
    std::snprintf(size, sizeof size, "%.3g", static_cast<double>(bytes) / (1 << 20));
    throw Error(place, std::string(size) + " MiB of texels cannot be " + what + " the temporary folder '" +
                           folder_.string() + "': " + std::strerror(error_number) +
                           "; free space there, or set TMPDIR to another folder");
}

void TexelFile::require_own_process() const {
    if (::getpid() != process_)
        throw Error(place,
                    "only the process that made a file of texels can write to it; load the scene in the "
                    "forked process");
}

std::shared_ptr<TexelBlock> TexelFile::allocate(std::size_t bytes) {
    require_own_process(); // both would use the same space
    if (bytes == 0) throw Error(place, "a block of no bytes was asked for");
    const std::uint64_t position = end_.fetch_add(rounded_up(bytes));
    // Space that is missing must be noticed now: a read of the map would end the program by a signal.
    int error = 0;
    do {
        error = ::posix_fallocate(descriptor_, static_cast<off_t>(position), static_cast<off_t>(bytes));
    } while (error == EINTR);
    if (error != 0) fail("written to", bytes, error);
    void* const data =
        ::mmap(nullptr, bytes, PROT_READ, MAP_SHARED, descriptor_, static_cast<off_t>(position));
    if (data == MAP_FAILED) fail("mapped from", bytes, errno);
#if defined(MADV_NOHUGEPAGE)
    ::madvise(data, bytes, MADV_NOHUGEPAGE); // a look-up must not make 2 MiB resident
#endif
    const std::span<const std::byte> mapping(static_cast<const std::byte*>(data), bytes);
    return std::shared_ptr<TexelBlock>(new TexelBlock(shared_from_this(), position, mapping));
}

TexelBlock::TexelBlock(std::shared_ptr<TexelFile> file, std::uint64_t position,
                       std::span<const std::byte> mapping)
    : file_(std::move(file)), position_(position), forks_(forks), mapping_(mapping) {
    file_->bytes_ += mapping_.size();
    file_->limit_.add(mapping_);
}

TexelBlock::~TexelBlock() {
    file_->limit_.remove(mapping_);
    file_->bytes_ -= mapping_.size();
    ::munmap(const_cast<std::byte*>(mapping_.data()), mapping_.size());
#if defined(FALLOC_FL_PUNCH_HOLE)
    // Where the file system cannot do this, the space is free when the file is closed. So it is where another process
    // may read the block.
    if (forks_ == forks)
        static_cast<void>(::fallocate(file_->descriptor_, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE,
                                      static_cast<off_t>(position_), static_cast<off_t>(mapping_.size())));
#endif
}

void TexelBlock::give_back() const {
    ::madvise(const_cast<std::byte*>(mapping_.data()), mapping_.size(), MADV_DONTNEED);
}

void TexelBlock::write(std::size_t offset, std::span<const std::byte> bytes) {
    if (offset > mapping_.size() || bytes.size() > mapping_.size() - offset)
        throw Error(place, "a write beyond the end of a block");
    file_->require_own_process();
    std::uint64_t position = position_ + offset;
    for (auto rest = bytes; !rest.empty();) {
        const ssize_t n =
            ::pwrite(file_->descriptor_, rest.data(), rest.size(), static_cast<off_t>(position));
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) file_->fail("written to", bytes.size(), n < 0 ? errno : EIO);
        position += static_cast<std::uint64_t>(n);
        rest = rest.subspan(static_cast<std::size_t>(n));
    }
}

} // namespace montelux
