#include "montelux/image/process_memory.h"

#include <cstdlib>
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

std::size_t page_size() {
    static const auto size = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    return size;
}

} // namespace

ProcessMemory::ProcessMemory()
    : statm_(::open("/proc/self/statm", O_RDONLY | O_CLOEXEC)),
      pagemap_(::open("/proc/self/pagemap", O_RDONLY | O_CLOEXEC)) {
    std::uint64_t entry;
    const std::uintptr_t page = reinterpret_cast<std::uintptr_t>(&entry) / page_size();
    if (statm_ >= 0 && pagemap_ >= 0 &&
        pread(pagemap_, &entry, sizeof entry, static_cast<off_t>(page * sizeof entry)) == sizeof entry)
        return;
    ::close(statm_);
    ::close(pagemap_);
    throw Error("memory of textures", "a limit needs Linux with /proc; leave it out");
}

ProcessMemory::~ProcessMemory() {
    ::close(statm_);
    ::close(pagemap_);
}

std::optional<std::size_t> ProcessMemory::file_bytes() const {
    std::array<char, 256> text{};
    ssize_t bytes = 0;
    do {
        bytes = pread(statm_, text.data(), text.size() - 1, 0);
    } while (bytes < 0 && errno == EINTR);
    char* at = text.data();
    std::strtoull(at, &at, 10); // all, and the resident memory
    std::strtoull(at, &at, 10);
    char* const begin = at;
    const std::size_t pages = std::strtoull(begin, &at, 10);
    // A number that is followed by another one is complete.
    if (bytes <= 0 || at == begin || *at != ' ') return std::nullopt;
    return pages * page_size();
}

std::size_t ProcessMemory::resident(std::span<const std::byte> mapping) const {
    const auto read = [&](std::span<std::uint64_t> entries, std::size_t page) {
        return pread(pagemap_, entries.data(), entries.size_bytes(),
                     static_cast<off_t>(page * sizeof(std::uint64_t)));
    };
    return count_resident_pages(reinterpret_cast<std::uintptr_t>(mapping.data()) / page_size(),
                                (mapping.size() + page_size() - 1) / page_size(), read) *
           page_size();
}

std::size_t ProcessMemory::give_back(std::span<const std::byte> mapping) const {
    const std::size_t before = resident(mapping);
    if (before == 0) return 0;
    if (::madvise(const_cast<std::byte*>(mapping.data()), mapping.size(), MADV_DONTNEED) == 0) return before;
    return before - std::min(before, resident(mapping)); // all up to what is locked
}

} // namespace montelux
