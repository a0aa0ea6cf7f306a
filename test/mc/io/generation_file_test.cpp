// Generation files: contents survive, damage is reported and the previous generation is used.
#include "test/temporary_folder.h"
#include <algorithm>
#include <fstream>
#include <functional>
#include <gtest/gtest.h>
#include <random>

#include "montelux/mc/io/file.h"
#include "montelux/mc/io/generation_file.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;
constexpr std::size_t header_size = 72, limit = 1 << 20;

class GenerationFile : public testing::Test {
  protected:
    static Bytes payload(std::size_t size, unsigned seed) {
        std::mt19937 random(seed);
        Bytes bytes(size);
        for (auto& b : bytes) b = static_cast<std::uint8_t>(random());
        return bytes;
    }
    static void overwrite(const fs::path& path, const Bytes& bytes) {
        fs::remove(path); // some file systems hasten to the disk what is written over an old file
        std::ofstream(path, std::ios::binary)
            .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    }
    std::string refusal(std::string_view kind = "test") const {
        try {
            read_generation(path_, kind, limit);
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    }

    TemporaryFolder folder_;
    fs::path path_ = folder_ / "state";
};

// The previous generation has a longer name than the newest.
TEST_F(GenerationFile, ReportsBeforehandWhatWouldFailLater) {
    check_generation_writable(path_);
    EXPECT_EQ(folder_.file_count(), 0);
    EXPECT_THROW(check_generation_writable(folder_.path()), Error);
    EXPECT_THROW(check_generation_writable(folder_ / "none" / "state"), Error);
    const fs::path longest = folder_ / std::string(255 - std::string(".previous.tmp").size(), 'x');
    check_generation_writable(longest);
    for (unsigned seed : {1u, 2u, 3u}) write_generation(longest, "test", payload(9, seed));
    EXPECT_THROW(check_generation_writable(longest.string() + "x"), Error);
}

TEST_F(GenerationFile, ContainsWhatWasWrittenAndThePreviousOne) {
    EXPECT_FALSE(generation_exists(path_));
    for (std::size_t size : {0UL, 1UL, 7UL, 8UL, 4097UL, 3UL << 20}) {
        const Bytes first = payload(size, 1), second = payload(size + 1, 2);
        fs::remove(path_);
        fs::remove(previous_generation(path_));
        write_generation(path_, "test", first);
        EXPECT_TRUE(generation_exists(path_));
        EXPECT_EQ(folder_.file_count(), 1);
        write_generation(path_, "test", second);
        EXPECT_EQ(folder_.file_count(), 2);
        Generation newest = read_generation(path_, "test", 4 << 20);
        EXPECT_EQ(newest.payload, second);
        EXPECT_FALSE(newest.previous);
        EXPECT_EQ(newest.newest_refused_because, "");
        fs::remove(path_);
        EXPECT_TRUE(generation_exists(path_));
        Generation before = read_generation(path_, "test", 4 << 20);
        EXPECT_EQ(before.payload, first);
        EXPECT_TRUE(before.previous);
        EXPECT_EQ(before.newest_refused_because,
                  path_.string() + ": cannot be opened: No such file or directory");
    }
}

TEST_F(GenerationFile, KeepsAWholeGenerationRatherThanADamagedOne) {
    const Bytes first = payload(100, 1), third = payload(100, 3);
    write_generation(path_, "test", first);
    write_generation(path_, "test", payload(100, 2));
    fs::resize_file(path_, 90);
    write_generation(path_, "test", third);
    EXPECT_EQ(read_generation(path_, "test", limit).payload, third);
    fs::remove(path_);
    EXPECT_EQ(read_generation(path_, "test", limit).payload, first);
    // One of another kind is none either.
    write_generation(path_, "other", first);
    write_generation(path_, "test", third);
    fs::remove(path_);
    EXPECT_EQ(read_generation(path_, "test", limit).payload, first);
}

TEST_F(GenerationFile, ResumesAfterAnEndBetweenTheTwoRenamings) {
    write_generation(path_, "test", payload(100, 1));
    fs::create_hard_link(path_, previous_generation(path_));
    overwrite(previous_generation(path_).string() + ".tmp", payload(10, 1)); // or before the first
    write_generation(path_, "test", payload(100, 2));
    write_generation(path_, "test", payload(100, 3));
    EXPECT_EQ(folder_.file_count(), 2);
    fs::remove(path_);
    EXPECT_EQ(read_generation(path_, "test", limit).payload, payload(100, 2));
}

TEST_F(GenerationFile, FollowsASymbolicLink) {
    fs::create_directory(folder_ / "sub");
    fs::create_symlink("sub/state", path_);
    write_generation(path_, "test", payload(10, 1));
    write_generation(path_, "test", payload(10, 2));
    EXPECT_TRUE(fs::is_symlink(path_));
    EXPECT_TRUE(fs::exists(folder_ / "sub/state.previous"));
    fs::resize_file(folder_ / "sub/state", 3);
    EXPECT_EQ(read_generation(path_, "test", limit).payload, payload(10, 1));
}

TEST_F(GenerationFile, EachDamageHasItsSentence) {
    write_generation(path_, "test", payload(1000, 1));
    const Bytes good = read_file_bytes(path_, limit);
    ASSERT_EQ(good.size(), header_size + 1000);
    auto expect = [&](const std::function<void(Bytes&)>& change, const std::string& sentence) {
        Bytes bytes = good;
        change(bytes);
        overwrite(path_, bytes);
        EXPECT_NE(refusal().find(path_.string() + ": " + sentence), std::string::npos) << refusal();
        EXPECT_NE(refusal().find(path_.string() + ".previous: cannot be opened"), std::string::npos);
    };
    expect([](Bytes& b) { b.clear(); }, "is cut short: it has 0 bytes; its header alone takes 72 bytes");
    expect([](Bytes& b) { b.resize(71); }, "is cut short: it has 71 bytes");
    expect([](Bytes& b) { b.pop_back(); }, "is cut short: it holds 999 bytes of 1000 bytes");
    expect([](Bytes& b) { b.push_back(0); }, "is damaged: 1 byte follow");
    expect([](Bytes& b) { b[0] ^= 1; }, "is not a saved state of Montelux");
    expect([](Bytes& b) { b[8] = 2; }, "was saved in version 2 of the format; expected 1");
    expect([](Bytes& b) { b[16] ^= 1; }, "is damaged: its checksum does not fit");
    expect([](Bytes& b) { b[54] = 1; }, "says that it holds 281474976711656 bytes; expected at most 1048576");
    expect([](Bytes& b) { b[60] ^= 1; }, "is damaged: its checksum does not fit");
    expect([](Bytes& b) { b.back() ^= 0x80; }, "is damaged: its checksum does not fit");
    overwrite(path_, good);
    EXPECT_NE(refusal("other").find("holds the state of 'test'; expected 'other'"), std::string::npos);
    EXPECT_THROW(read_generation(path_, "test", 999), Error);
    EXPECT_EQ(read_generation(path_, "test", 1000).payload.size(), 1000U);
    EXPECT_THROW(write_generation(path_, "", good), Error);
    EXPECT_THROW(write_generation(path_, std::string(32, 'a'), good), Error);
    EXPECT_THROW(write_generation(folder_ / "none/state", "test", good), Error);
}

// One of many ways to damage a file; false where it happens to stay as it was.
bool damage(Bytes& bytes, std::mt19937& random) {
    const Bytes before = bytes;
    auto below = [&](std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random); };
    switch (below(7)) {
    case 0:
        bytes.resize(below(bytes.size()));
        break;
    case 1:
        bytes[below(bytes.size())] ^= static_cast<std::uint8_t>(1 << below(8));
        break;
    case 2:
        for (std::size_t i = 0, n = 2 + below(30); i < n; ++i)
            bytes[below(bytes.size())] ^= static_cast<std::uint8_t>(1 << below(8));
        break;
    case 3: { // two blocks change places
        const std::size_t size = std::size_t{1} << below(13), blocks = bytes.size() / size;
        if (blocks < 2) return false;
        const std::size_t a = below(blocks) * size, b = below(blocks) * size;
        if (a == b) return false;
        std::swap_ranges(bytes.begin() + a, bytes.begin() + a + size, bytes.begin() + b);
        break;
    }
    case 4: { // a page that never reached the disk
        const std::size_t size = below(2) == 0 ? 512 : 4096, first = below(bytes.size() / size + 1) * size;
        if (first >= bytes.size()) return false;
        std::fill(bytes.begin() + first, bytes.begin() + std::min(first + size, bytes.size()),
                  std::uint8_t{0});
        break;
    }
    case 5: { // a byte lost here and one gained there
        const std::size_t from = below(bytes.size()), to = below(bytes.size());
        const std::uint8_t byte = bytes[from];
        bytes.erase(bytes.begin() + from);
        bytes.insert(bytes.begin() + to, byte);
        break;
    }
    default: // another file's rest
        for (std::size_t n = 1 + below(100); n > 0; --n) bytes.push_back(static_cast<std::uint8_t>(random()));
    }
    return bytes != before;
}

TEST_F(GenerationFile, TenThousandDamagedFilesAreAllFound) {
    const Bytes old = payload(500, 1);
    write_generation(path_, "test", old);
    std::mt19937 random(4);
    for (int i = 0; i < 10000;) {
        if (i % 100 == 0) { // the payload has smooth parts as states have them, and zeros
            Bytes fresh = payload(64 + 90 * static_cast<std::size_t>(i / 100), static_cast<unsigned>(i));
            std::fill(fresh.begin(), fresh.begin() + fresh.size() / 3, std::uint8_t{0});
            fs::remove(path_);
            write_generation(path_, "test", old);
            write_generation(path_, "test", fresh);
        }
        const Bytes good = read_file_bytes(path_, limit);
        for (int k = 0; k < 100;) {
            Bytes bytes = good;
            if (!damage(bytes, random)) continue;
            overwrite(path_, bytes);
            const Generation g = read_generation(path_, "test", limit);
            ASSERT_TRUE(g.previous) << i << ' ' << k;
            ASSERT_EQ(g.payload, old);
            ASSERT_FALSE(g.newest_refused_because.empty());
            ++k;
            ++i;
        }
        overwrite(path_, good);
        ASSERT_FALSE(read_generation(path_, "test", limit).previous);
    }
}

} // namespace
} // namespace montelux
