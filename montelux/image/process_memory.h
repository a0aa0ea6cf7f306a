// ProcessMemory: what of this process is resident, as Linux tells in /proc/self.
#pragma once

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <sys/types.h>

namespace montelux {

class ProcessMemory {
  public:
    // Throws Error where the system does not tell.
    ProcessMemory();
    ~ProcessMemory();
    ProcessMemory(const ProcessMemory&) = delete;
    ProcessMemory& operator=(const ProcessMemory&) = delete;

    // Resident bytes of mapped files and libraries, within a few hundred pages; empty if the kernel does not say.
    std::optional<std::size_t> file_bytes() const;
    // Of the pages of a mapping, which begins with a page. Reads 8 bytes per page.
    std::size_t resident(std::span<const std::byte> mapping) const;
    // Makes nothing of a mapping of a file resident until it is read again. Returns how many bytes were; the
    // kernel keeps locked memory.
    std::size_t give_back(std::span<const std::byte> mapping) const;

  private:
    int statm_ = -1, pagemap_ = -1;
};

// How many of `count` pages are resident. read(entries, page) reads entries of /proc/self/pagemap, whose highest bit
// says that the page is resident, and returns bytes, as pread does: they may be fewer than requested. Pages that it does
// not tell of count as resident: who keeps a limit must not take them for free memory.
template <typename Read>
std::size_t count_resident_pages(std::size_t page, std::size_t count, const Read& read) {
    std::array<std::uint64_t, 4096> entries;
    std::size_t resident = 0;
    while (count > 0) {
        const ssize_t bytes = read(std::span(entries).first(std::min(count, entries.size())), page);
        if (bytes < 0 && errno == EINTR) continue;
        const std::size_t told = bytes > 0 ? static_cast<std::size_t>(bytes) / sizeof entries[0] : 0;
        if (told == 0) return resident + count;
        for (std::size_t i = 0; i < told; ++i) resident += entries[i] >> 63;
        page += told;
        count -= told;
    }
    return resident;
}

} // namespace montelux
