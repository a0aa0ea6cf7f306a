// What is resident: reads of /proc that come in parts or fail, and memory that the kernel keeps.
#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <gtest/gtest.h>
#include <span>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>
#include <vector>

#include "montelux/image/process_memory.h"

namespace montelux {
namespace {

constexpr std::uint64_t resident = std::uint64_t{1} << 63;

TEST(ProcessMemory, ReadsInPartsLeaveNoPageOut) {
    std::vector<std::uint64_t> pages(10000);
    std::size_t expected = 0;
    for (std::size_t i = 0; i < pages.size(); ++i) {
        pages[i] = i % 3 == 0 || i > 9000 ? resident | i : i;
        expected += pages[i] >> 63;
    }
    constexpr std::size_t first = 77;
    int calls = 0;
    // No more than `most` entries at a time; every fifth call is interrupted by a signal.
    const auto count_by = [&](std::size_t most) {
        return count_resident_pages(
            first, pages.size(), [&](std::span<std::uint64_t> entries, std::size_t page) -> ssize_t {
                if (++calls % 5 == 1) {
                    errno = EINTR;
                    return -1;
                }
                const std::size_t n = std::min(entries.size(), most);
                std::copy_n(pages.begin() + static_cast<std::ptrdiff_t>(page - first), n, entries.begin());
                return static_cast<ssize_t>(n * sizeof entries[0]);
            });
    };
    for (const std::size_t most : {10000, 4095, 1000, 17, 1}) EXPECT_EQ(count_by(most), expected) << most;
}

// Who keeps a limit must not take them for free memory.
TEST(ProcessMemory, PagesThatAreNotToldOfCountAsResident) {
    const auto count_after = [](ssize_t result) {
        return count_resident_pages(0, 5000, [&](std::span<std::uint64_t> entries, std::size_t page) {
            if (page > 0) return result;
            std::fill(entries.begin(), entries.end(), 0);
            errno = EIO;
            return ssize_t{4000} * 8;
        });
    };
    EXPECT_EQ(count_after(-1), 1000u);
    EXPECT_EQ(count_after(0), 1000u);
}

TEST(ProcessMemory, KnowsWhatIsResidentAndWhatTheKernelKeeps) {
    const ProcessMemory memory;
    const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
    void* const at = ::mmap(nullptr, 4 * page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    ASSERT_NE(at, MAP_FAILED);
    const std::span<std::byte> mapping(static_cast<std::byte*>(at), 4 * page);
    EXPECT_EQ(memory.resident(mapping), 0u);
    mapping[0] = mapping[page] = mapping[3 * page] = std::byte{1};
    EXPECT_EQ(memory.resident(mapping), 3 * page);
    EXPECT_EQ(memory.resident(mapping.subspan(page, 1)), page);
    // Called directly: under the address sanitizer mlock() does nothing and says that it succeeded.
    if (::syscall(SYS_mlock, mapping.data() + page, page) == 0) {
        EXPECT_EQ(memory.give_back(mapping.subspan(page, page)), 0u);
        EXPECT_EQ(memory.resident(mapping.subspan(page, page)), page);
        EXPECT_EQ(memory.give_back(mapping), page); // the first
        EXPECT_EQ(memory.resident(mapping), 2 * page);
        mapping[0] = std::byte{1};
        ::syscall(SYS_munlock, mapping.data() + page, page);
    }
    EXPECT_EQ(memory.give_back(mapping), 3 * page);
    EXPECT_EQ(memory.resident(mapping), 0u);
    EXPECT_EQ(memory.give_back(mapping), 0u);
    ::munmap(at, 4 * page);
    EXPECT_GT(memory.file_bytes().value_or(0), page);
}

} // namespace
} // namespace montelux
