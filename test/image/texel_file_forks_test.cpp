// Files of texels in processes that are forked off.
#include "test/image/texel_testing.h"
#include "test/temporary_folder.h"
#include <chrono>
#include <cstddef>
#include <functional>
#include <gtest/gtest.h>
#include <memory>
#include <string>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include "montelux/image/texel_file.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

using testing::byte_at, testing::filled_block, testing::mib, testing::read_pages;

// Runs something in a process that is forked off, and returns what it returns; -1 if it takes more than 20 s or dies.
template <typename F>
int forked(const F& f) {
    const pid_t child = ::fork();
    if (child == 0) {
        ::alarm(20);
        ::_exit(f());
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

// The thread does not exist there, and may have been anywhere.
TEST(TexelFileForks, ClosesInAForkedProcess) {
    const TemporaryFolder folder;
    auto file = TexelFile::create(16 * mib, folder.path());
    auto idle = TexelFile::create(16 * mib, folder.path());
    auto block = filled_block(*file, 64 * mib);
    for (int i = 0; i < 20; ++i) {
        read_pages(block->bytes());
        ASSERT_EQ(forked([&] {
                      const bool same = block->bytes()[99999] == byte_at(99999);
                      static_cast<void>(file->resident());
                      block.reset();
                      file.reset();
                      idle.reset();
                      return same ? 3 : 4;
                  }),
                  3)
            << i;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    EXPECT_LE(file->resident(), 16 * mib); // the thread is still there
}

std::string message_of(const std::function<void()>& f) {
    try {
        f();
    } catch (const Error& e) {
        return e.what();
    }
    return {};
}

// Both read the same file.
TEST(TexelFileForks, ForkedProcessesKeepTheirTexels) {
    const TemporaryFolder folder;
    const auto file = TexelFile::create(16 * mib, folder.path());
    const std::size_t size = mib;
    const auto is_whole = [](const TexelBlock& block) {
        std::size_t same = 0;
        for (std::size_t i = 0; i < size; ++i) same += block.bytes()[i] == byte_at(i);
        return same == size;
    };
    auto kept = filled_block(*file, size), dropped = filled_block(*file, size);
    int ends[2];
    ASSERT_EQ(::pipe(ends), 0);
    const pid_t child = ::fork();
    if (child == 0) {
        ::alarm(20);
        kept.reset();
        char byte = 0;
        int result = ::read(ends[0], &byte, 1) == 1 && is_whole(*dropped) ? 1 : 0;
        const std::string expected = "only the process that made a file of texels can write to it";
        result += message_of([&] { file->allocate(size); }).find(expected) != std::string::npos ? 2 : 0;
        result += message_of([&] { dropped->write(0, {}); }).find(expected) != std::string::npos ? 4 : 0;
        ::_exit(result);
    }
    dropped.reset();
    EXPECT_EQ(::write(ends[1], "", 1), 1);
    int status = 0;
    ::waitpid(child, &status, 0);
    ::close(ends[0]);
    ::close(ends[1]);
    EXPECT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 7);
    EXPECT_TRUE(is_whole(*kept));
}

} // namespace
} // namespace montelux
