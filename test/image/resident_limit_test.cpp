// How much of files of texels is resident: little, whatever other files do.
#include "test/image/texel_testing.h"
#include "test/sanitized.h"
#include "test/temporary_folder.h"
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <fcntl.h>
#include <filesystem>
#include <gtest/gtest.h>
#include <memory>
#include <string>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <thread>
#include <unistd.h>
#include <vector>

#include "montelux/image/resident_limit.h"
#include "montelux/image/texel_file.h"

namespace {

// A mapping whose madvise() is delayed, so that a test can act meanwhile.
std::atomic<const void*> slow_mapping{nullptr};
std::atomic<bool> is_giving_back{false}, is_removed{false}, was_removed_meanwhile{false};

} // namespace

// NOLINTBEGIN: this name and signature are those of the C library.
#pragma GCC visibility push(default)
extern "C" int madvise(void* begin, std::size_t size, int advice) noexcept {
    if (begin != nullptr && begin == slow_mapping) {
        is_giving_back = true;
        for (int i = 0; i < 100 && !is_removed; ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        was_removed_meanwhile = is_removed.load();
        slow_mapping = nullptr;
    }
    return static_cast<int>(::syscall(SYS_madvise, begin, size, advice));
}
#pragma GCC visibility pop
// NOLINTEND

namespace montelux {
namespace {

using testing::byte_at, testing::filled_block, testing::mib, testing::read_pages;

// Two readers that make another 64 KiB resident every 20 us: ten times as often as the render of a large picture.
TEST(ResidentLimit, LittleIsResident) {
    if (under_sanitizers) GTEST_SKIP() << "the sanitizer's threads are too slow to keep the limit";
    const TemporaryFolder folder;
    const std::size_t limit = 128 * mib, size = 512 * mib;
    const auto file = TexelFile::create(limit, folder.path());
    std::this_thread::sleep_for(std::chrono::milliseconds(30)); // its thread sleeps until there is a block
    std::vector<std::shared_ptr<TexelBlock>> blocks;
    for (int i = 0; i < 4; ++i) blocks.push_back(filled_block(*file, size / 4));
    std::atomic<std::size_t> wrong{0}, rounds{0};
    std::atomic<bool> stop{false};
    std::vector<std::thread> readers;
    for (std::size_t t = 0; t < 2; ++t)
        readers.emplace_back([&, t] {
            while (!stop) {
                for (std::size_t b = t; b < blocks.size() && !stop; b += 2) {
                    const auto bytes = blocks[b]->bytes();
                    for (std::size_t i = 0; i < bytes.size() && !stop; i += 65536 + t) {
                        wrong += bytes[i] != byte_at(i);
                        const auto begin = std::chrono::steady_clock::now();
                        while (std::chrono::steady_clock::now() - begin < std::chrono::microseconds(20)) {
                        }
                    }
                }
                ++rounds;
            }
        });
    std::vector<std::size_t> seen;
    for (int i = 0; i < 200; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        seen.push_back(file->resident() / mib);
    }
    stop = true;
    for (std::thread& reader : readers) reader.join();
    EXPECT_EQ(wrong, 0u);
    EXPECT_GT(rounds, 4u) << "the readers were too slow to exceed the limit";
    std::sort(seen.begin(), seen.end());
    std::string quantiles;
    for (const std::size_t i : {0, 50, 100, 150, 180, 199}) quantiles += std::to_string(seen[i]) + " ";
    RecordProperty("residentMiB", quantiles);
    // Single moments of a loaded machine may show more.
    EXPECT_LE(seen[100], limit / mib) << "MiB, quantiles " << quantiles;
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    EXPECT_LE(file->resident(), limit) << "at rest";
}

// Both fit into their limits, but not one of them beside the other.
TEST(ResidentLimit, FilesThatAreUsedInTurnsLeaveEachOtherAlone) {
    const TemporaryFolder folder;
    const std::size_t size = 40 * mib;
    const std::shared_ptr<TexelFile> files[] = {TexelFile::create(64 * mib, folder.path()),
                                                TexelFile::create(64 * mib, folder.path())};
    const std::shared_ptr<TexelBlock> blocks[] = {filled_block(*files[0], size),
                                                  filled_block(*files[1], size)};
    for (const auto& block : blocks) {
        block->give_back();
        // At a low rate, at which nothing is given back early.
        for (std::size_t i = 0; i < size; i += mib / 8) {
            read_pages(block->bytes().subspan(i, mib / 8));
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
    }
    std::size_t least[] = {size, size};
    for (int turn = 0; turn < 60; ++turn) {
        read_pages(blocks[turn % 2]->bytes());
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        for (const std::size_t i : {0, 1}) least[i] = std::min(least[i], files[i]->resident());
    }
    // The kernel may need some.
    EXPECT_GT(least[0], size * 3 / 4);
    EXPECT_GT(least[1], size * 3 / 4);
}

// What the process has resident falls when another file goes, so that it says nothing about this one.
TEST(ResidentLimit, TheLimitHoldsWhenOtherFilesGo) {
    const TemporaryFolder folder;
    const std::size_t limit = 64 * mib, size = 200 * mib;
    auto other = TexelFile::create(512 * mib, folder.path());
    auto of_other = filled_block(*other, size);
    read_pages(of_other->bytes());
    const auto file = TexelFile::create(limit, folder.path());
    const auto block = filled_block(*file, size);
    read_pages(block->bytes().first(40 * mib));
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    of_other.reset();
    other.reset();
    read_pages(block->bytes());
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    EXPECT_LE(file->resident(), limit);
    // Nor does it when maps of the program go.
    const std::string path = folder.write("map", "");
    std::filesystem::resize_file(path, size);
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    void* const map = ::mmap(nullptr, size, PROT_READ, MAP_SHARED | MAP_POPULATE, descriptor, 0);
    ASSERT_NE(map, MAP_FAILED);
    read_pages(block->bytes().first(40 * mib));
    std::this_thread::sleep_for(std::chrono::milliseconds(1300));
    ::munmap(map, size);
    ::close(descriptor);
    read_pages(block->bytes());
    std::this_thread::sleep_for(std::chrono::milliseconds(1500));
    EXPECT_LE(file->resident(), limit);
}

// A removed mapping may be unmapped at once, so remove() must wait for calls in progress.
TEST(ResidentLimit, RemovingWaitsForPagesThatAreGivenBack) {
    const TemporaryFolder folder;
    const std::string path = folder.write("map", std::string(mib, 'x'));
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    void* const map = ::mmap(nullptr, mib, PROT_READ, MAP_SHARED | MAP_POPULATE, descriptor, 0);
    ::close(descriptor);
    ASSERT_NE(map, MAP_FAILED);
    const std::span<const std::byte> mapping(static_cast<const std::byte*>(map), mib);
    is_giving_back = is_removed = was_removed_meanwhile = false;
    slow_mapping = map;
    {
        ResidentLimit limit(mib / 16);
        limit.add(mapping);
        while (!is_giving_back) {
            read_pages(mapping);
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        limit.remove(mapping);
        is_removed = true;
        EXPECT_EQ(limit.resident(), 0u);
    }
    EXPECT_FALSE(was_removed_meanwhile);
    ::munmap(map, mib);
}

} // namespace
} // namespace montelux
