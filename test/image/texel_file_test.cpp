// Images in a temporary file: nothing changes but where their samples are.
#include "test/image/texel_testing.h"
#include "test/sanitized.h"
#include "test/temporary_folder.h"
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <pthread.h>
#include <span>
#include <string>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/statfs.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

#include "montelux/image/image.h"
#include "montelux/image/texel_file.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

using testing::byte_at, testing::filled_block, testing::mib;

std::string refusal(std::size_t limit, const std::filesystem::path& folder) {
    try {
        TexelFile::create(limit, folder);
    } catch (const Error& e) {
        return e.what();
    }
    return {};
}
bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

// Of the unnamed file in the folder: bytes on the disk, and how many of its blocks are mapped.
struct Usage {
    std::uintmax_t on_disk = 0;
    int mappings = 0;
};
Usage usage_of(const TemporaryFolder& folder) {
    Usage usage;
    const std::string begin = folder.path().string() + "/";
    for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
        std::error_code gone;
        struct stat info {};
        if (std::filesystem::read_symlink(entry, gone).string().starts_with(begin) &&
            ::stat(entry.path().c_str(), &info) == 0)
            usage.on_disk += static_cast<std::uintmax_t>(info.st_blocks) * 512;
    }
    std::ifstream maps("/proc/self/maps");
    for (std::string line; std::getline(maps, line);) usage.mappings += contains(line, begin);
    return usage;
}

// Whether the file system can free a part of a file.
bool punches_holes(const TemporaryFolder& folder) {
    const int file = ::open((folder / "holes").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    const bool can = ::posix_fallocate(file, 0, 65536) == 0 &&
                     ::fallocate(file, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, 0, 65536) == 0;
    ::close(file);
    std::filesystem::remove(folder / "holes");
    return can;
}

TEST(TexelFile, BlocksHoldWhatIsWritten) {
    const TemporaryFolder folder;
    const auto file = TexelFile::create(16 * mib, folder.path());
    std::vector<std::shared_ptr<TexelBlock>> blocks;
    for (const std::size_t size : {1, 4095, 65537, 300000}) blocks.push_back(filled_block(*file, size));
    EXPECT_EQ(folder.file_count(), 0); // the file has no name
    blocks.erase(blocks.begin() + 1);
    EXPECT_EQ(file->bytes(), 1u + 65537 + 300000);
    for (const auto& block : blocks) {
        const auto bytes = block->bytes();
        std::size_t wrong = 0;
        for (std::size_t i = 0; i < bytes.size(); ++i) wrong += bytes[i] != byte_at(i);
        EXPECT_EQ(wrong, 0u) << bytes.size();
        EXPECT_THROW(block->write(bytes.size(), std::vector<std::byte>(1)), Error);
    }
    EXPECT_GT(file->resident(), 300000u);
    for (const auto& block : blocks) block->give_back();
    EXPECT_EQ(file->resident(), 0u);
    EXPECT_EQ(blocks.back()->bytes()[299999], byte_at(299999));
    const Usage before = usage_of(folder);
    EXPECT_GT(before.on_disk, 300000u);
    EXPECT_GT(before.mappings, 0);
    const std::span<const std::byte> last = blocks.back()->bytes();
    blocks.clear();
    EXPECT_EQ(file->bytes(), 0u);
    // What is mapped where a block was is none of the file's.
    void* const there = const_cast<std::byte*>(last.data());
    void* const other = ::mmap(there, last.size(), PROT_READ | PROT_WRITE,
                               MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED_NOREPLACE, -1, 0);
    if (other != MAP_FAILED) {
        std::memset(other, 1, last.size());
        EXPECT_EQ(file->resident(), 0u);
        ::munmap(other, last.size());
    }
    const Usage after = usage_of(folder);
    EXPECT_EQ(after.mappings, 0);
    if (punches_holes(folder)) {
        EXPECT_LT(after.on_disk, before.on_disk / 4);
    }
}

TEST(TexelFile, RefusalsSayWhatToDo) {
    const TemporaryFolder folder;
    EXPECT_TRUE(contains(refusal(16 * mib - 1, folder.path()), "at least 16777216 bytes, but is 16777215"));
    EXPECT_TRUE(contains(refusal(16 * mib, folder / "missing"), "set TMPDIR to another folder"));
    EXPECT_TRUE(contains(refusal(16 * mib, folder.write("a", "file")), "set TMPDIR to another folder"));
    struct statfs info {};
    if (::statfs("/dev/shm", &info) == 0 && info.f_type == 0x01021994) {
        EXPECT_TRUE(contains(refusal(16 * mib, "/dev/shm"), "is itself in memory; set TMPDIR"));
    }
}

std::ptrdiff_t open_files() {
    return std::ranges::distance(std::filesystem::directory_iterator("/proc/self/fd"));
}

// Nothing is changed where no thread can be started, here because its stack does not fit into the memory.
TEST(TexelFile, AThreadThatCannotBeStartedIsAnError) {
    pthread_attr_t usual, vast;
    ASSERT_EQ(pthread_getattr_default_np(&usual), 0);
    ASSERT_EQ(pthread_getattr_default_np(&vast), 0);
    ASSERT_EQ(pthread_attr_setstacksize(&vast, std::size_t{1} << 50), 0);
    TemporaryFolder folder;
    const std::ptrdiff_t files = open_files();
    ASSERT_EQ(pthread_setattr_default_np(&vast), 0);
    std::string error;
    try {
        TexelFile::create(TexelFile::least_limit, folder.path());
    } catch (const std::exception& e) {
        error = e.what();
    }
    ASSERT_EQ(pthread_setattr_default_np(&usual), 0);
    EXPECT_EQ(error.rfind("memory of textures: the thread that keeps the limit cannot be started: ", 0), 0u)
        << error;
    EXPECT_EQ(open_files(), files);
    sigset_t blocked;
    ASSERT_EQ(pthread_sigmask(SIG_SETMASK, nullptr, &blocked), 0);
    EXPECT_EQ(sigismember(&blocked, SIGINT), 0);
    pthread_attr_destroy(&usual);
    pthread_attr_destroy(&vast);
}

// A limit of a file's size stands for the space of a disk.
TEST(TexelFile, MissingSpaceIsAnErrorBeforeAnythingIsRead) {
    const TemporaryFolder folder;
    const pid_t child = ::fork();
    if (child == 0) {
        std::signal(SIGXFSZ, SIG_IGN);
        const rlimit limit{mib, mib};
        ::setrlimit(RLIMIT_FSIZE, &limit);
        int code = 1;
        try {
            const auto file = TexelFile::create(16 * mib, folder.path());
            Image image(512, 1024, {"Y"}, PixelFormat::u8);
            image.move_to(*file);
            code = 2;
            static_cast<void>(file->allocate(700 * 1000)); // not written yet
        } catch (const Error& e) {
            if (contains(e.what(), "0.668 MiB of texels cannot be written to the temporary folder"))
                code += 10;
        }
        ::_exit(code);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 12);
}

TEST(TexelFile, ImagesStayTheSame) {
    const TemporaryFolder folder;
    const auto file = TexelFile::create(16 * mib, folder.path());
    for (const PixelFormat format : {PixelFormat::u8, PixelFormat::u16, PixelFormat::f16, PixelFormat::f32}) {
        Image image(37, 21, {"R", "G", "B", "A"}, format, ColorEncoding::srgb());
        for (std::size_t i = 0; i < image.sample_count(); ++i) {
            if (format == PixelFormat::u8)
                image.u8()[i] = static_cast<std::uint8_t>(i * 7);
            else if (format == PixelFormat::f32)
                image.f32()[i] = static_cast<float>(i % 91) / 7;
            else
                image.u16()[i] = static_cast<std::uint16_t>(i * 5);
        }
        const Image before = image;
        image.move_to(*file);
        EXPECT_EQ(image.file(), file);
        EXPECT_EQ(image.memory_bytes(), 0u);
        EXPECT_EQ(image.byte_count(), before.byte_count());
        const auto expect_same = [&](const Image& after) {
            ASSERT_EQ(after.sample_count(), before.sample_count());
            for (std::size_t i = 0; i < before.sample_count(); ++i)
                ASSERT_EQ(after.value_at(i), before.value_at(i)) << i;
        };
        expect_same(image);
        expect_same(image.select(image.channel_names()));
        // A copy shares the block; to be written it comes back into memory, alone.
        Image copy = image;
        EXPECT_EQ(file->bytes(), image.byte_count());
        static_cast<void>(copy.f32());
        static_cast<void>(copy.u16());
        static_cast<void>(copy.u8());
        EXPECT_EQ(copy.file(), nullptr);
        expect_same(copy);
        const Image moved = std::move(image);
        EXPECT_EQ(moved.file(), file);
        expect_same(moved);
    }
    EXPECT_EQ(file->bytes(), 0u);
}

#if defined(__GLIBC__) && __GLIBC_PREREQ(2, 33)
TEST(TexelFile, TakesImagesOutOfMemory) {
    if (under_sanitizers) GTEST_SKIP() << "the sanitizer has a heap of its own";
    const TemporaryFolder folder;
    const auto file = TexelFile::create(16 * mib, folder.path());
    Image image(1024, 1024, {"R", "G", "B", "A"}, PixelFormat::f32);
    const auto heap = [] {
        const struct mallinfo2 info = mallinfo2();
        return info.uordblks + info.hblkhd;
    };
    const std::size_t before = heap();
    image.move_to(*file);
    EXPECT_LT(heap() + 15 * mib, before);
}
#endif

} // namespace
} // namespace montelux
