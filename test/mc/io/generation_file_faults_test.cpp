// Generation files under faults: whichever call fails or is the last one before the process is killed, a
// whole generation is there.
#include "test/fault/fault_injection.h"
#include "test/temporary_folder.h"
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <gtest/gtest.h>
#include <string>
#include <sys/wait.h>
#include <unistd.h>

#include "montelux/mc/io/generation_file.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;

enum class End { written, refused, killed, other };

class GenerationFileFaults : public testing::TestWithParam<const char*> {
  protected:
    // Large enough for more than one call of writing.
    static Bytes payload(std::uint8_t generation) { return Bytes(600'000, generation); }

    // Writes in a child, whose n-th call goes wrong. `met`: there was such a call.
    End write_with_fault(std::uint8_t generation, long n, bool& met) const {
        int ends[2];
        if (::pipe(ends) != 0) return End::other;
        const pid_t child = ::fork();
        if (child == 0) {
            ::setenv("MONTELUX_FAULT_FOLDER", folder_.path().c_str(), 1);
            ::setenv("MONTELUX_FAULT_CALL", std::to_string(n).c_str(), 1);
            ::setenv("MONTELUX_FAULT_KIND", GetParam(), 1);
            fault::restart();
            int code = 0;
            try {
                write_generation(path_, "test", payload(generation));
            } catch (const Error&) {
                code = 1;
            }
            const char was_met = fault::count() >= n ? 1 : 0;
            ::_exit(::write(ends[1], &was_met, 1) == 1 ? code : 9);
        }
        ::close(ends[1]);
        char was_met = 1; // a child that was killed says nothing
        if (::read(ends[0], &was_met, 1) < 0) return End::other;
        ::close(ends[0]);
        met = was_met != 0;
        int status = 0;
        ::waitpid(child, &status, 0);
        if (WIFSIGNALED(status)) return WTERMSIG(status) == SIGKILL ? End::killed : End::other;
        return WEXITSTATUS(status) == 0 ? End::written : WEXITSTATUS(status) == 1 ? End::refused : End::other;
    }

    TemporaryFolder folder_;
    fs::path path_ = folder_ / "state";
};

TEST_P(GenerationFileFaults, LeaveAWholeGeneration) {
    const std::string kind = GetParam();
    const bool kills = kind.starts_with("kill");
    long n = 1;
    int ends[4] = {};
    for (bool met = true; met; ++n) {
        ASSERT_LT(n, 100) << "the end is never reached";
        for (const auto& entry : fs::directory_iterator(folder_.path())) fs::remove(entry);
        write_generation(path_, "test", payload(1));
        write_generation(path_, "test", payload(2));
        const End end = write_with_fault(3, n, met);
        ++ends[static_cast<int>(end)];
        ASSERT_NE(end, End::other);
        if (!met) {
            ASSERT_EQ(end, End::written);
        } else if (kills) {
            ASSERT_EQ(end, End::killed) << n;
        } else if (kind == "short") {
            ASSERT_EQ(end, End::written) << n;
        }

        // The newest is complete, not only the previous one.
        const Generation newest = read_generation(path_, "test", 1 << 20);
        ASSERT_FALSE(newest.previous) << n << ": " << newest.newest_refused_because;
        ASSERT_TRUE(newest.payload == payload(2) || newest.payload == payload(3)) << n;
        if (end == End::written) {
            ASSERT_EQ(newest.payload, payload(3)) << n;
        }
        // Without it the previous one exists.
        fs::remove(path_);
        const Generation before = read_generation(path_, "test", 1 << 20);
        ASSERT_TRUE(before.payload == payload(1) || before.payload == payload(2)) << n;
        if (end == End::written && kind == "short") {
            ASSERT_EQ(before.payload, payload(2)) << n;
        }
        if (!kills) {
            fs::remove(path_.string() + ".previous");
            ASSERT_TRUE(fs::is_empty(folder_.path()))
                << "call " << n << " left " << fs::directory_iterator(folder_.path())->path();
        }

        // Left-over files do no harm.
        write_generation(path_, "test", payload(4));
        write_generation(path_, "test", payload(5));
        ASSERT_EQ(read_generation(path_, "test", 1 << 20).payload, payload(5));
        fs::remove(path_);
        ASSERT_EQ(read_generation(path_, "test", 1 << 20).payload, payload(4));
    }
    // Opening, three writes, synchronising, closing, three names, the folder: the faults were there to be
    // met.
    EXPECT_GE(n, 12);
    if (kills) {
        EXPECT_EQ(ends[static_cast<int>(End::killed)], n - 2);
    }
    // All but opening a file without a name, for which a named one is used instead; opening and closing the
    // present file, which is not kept then; and closing the folder.
    if (kind == "ENOSPC" || kind == "EIO" || kind == "EDQUOT") {
        EXPECT_EQ(ends[static_cast<int>(End::refused)], n - 2 - 4);
    }
}

INSTANTIATE_TEST_SUITE_P(Kinds, GenerationFileFaults,
                         testing::Values("ENOSPC", "EIO", "EINTR", "EDQUOT", "full-disk", "short",
                                         "kill-before", "kill-after"));

} // namespace
} // namespace montelux
