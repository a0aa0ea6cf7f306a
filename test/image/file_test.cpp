#include "test/image/image_testing.h"
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <functional>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "montelux/image/image_read.h"
#include "montelux/image/image_write.h"
#include "montelux/mc/io/file.h"

namespace montelux {
namespace {

// Runs `action` in a child in which no file may grow beyond `limit` bytes, as on a full disk.
// 0: it ended; 1: it threw an Error that says that it cannot write.
int exit_code_on_full_disk(rlim_t limit, const std::function<void()>& action) {
    pid_t child = ::fork();
    if (child == 0) {
        std::signal(SIGXFSZ, SIG_IGN);
        rlimit r{limit, limit};
        ::setrlimit(RLIMIT_FSIZE, &r);
        try {
            action();
        } catch (const Error& e) {
            ::_exit(std::string(e.what()).find("cannot be written") != std::string::npos ? 1 : 2);
        } catch (...) {
            ::_exit(3);
        }
        ::_exit(0);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 100 + WTERMSIG(status);
}

TEST(AtomicFile, AppearsOnlyWithACommit) {
    TemporaryFolder folder;
    write_bytes(folder / "a", "old");
    {
        AtomicFile file(folder / "a");
        file.write("new contents", 12);
        EXPECT_EQ(read_bytes(folder / "a"), "old");
    }
    EXPECT_EQ(read_bytes(folder / "a"), "old");
    EXPECT_EQ(folder.file_count(), 1);
    AtomicFile file(folder / "a");
    file.write("new contents", 12);
    file.seek(4);
    file.write("C", 1);
    file.commit();
    EXPECT_EQ(read_bytes(folder / "a"), "new Contents");
    EXPECT_EQ(folder.file_count(), 1);
}

TEST(AtomicFile, LeavesNothingWhenItsProcessIsKilled) {
    TemporaryFolder folder;
    const int unnamed = ::open(folder.path().c_str(), O_RDWR | O_TMPFILE | O_CLOEXEC, 0600);
    if (unnamed < 0) GTEST_SKIP() << "this file system has no files without a name";
    ::close(unnamed);
    write_bytes(folder / "a", "old");
    const pid_t child = ::fork();
    if (child == 0) {
        AtomicFile file(folder / "a");
        file.write(std::vector<std::uint8_t>(1 << 20));
        file.finish();
        ::kill(::getpid(), SIGKILL);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);
    EXPECT_EQ(folder.file_count(), 1);
    EXPECT_EQ(read_bytes(folder / "a"), "old");
}

TEST(AtomicFile, TakesAnotherNameWhereOneIsTaken) {
    TemporaryFolder folder;
    // Of a process of the same number that was killed, as in a container that was begun anew.
    for (int i = 0; i < 64; ++i)
        write_bytes(folder / (".montelux-" + std::to_string(::getpid()) + "-" + std::to_string(i) + ".tmp"),
                    "");
    AtomicFile file(folder / "a");
    file.write("new", 3);
    file.commit();
    EXPECT_EQ(read_bytes(folder / "a"), "new");
    EXPECT_EQ(folder.file_count(), 65);
}

TEST(AtomicFile, FollowsASymbolicLink) {
    TemporaryFolder folder;
    write_bytes(folder / "target", "old");
    std::filesystem::create_symlink("target", folder / "link");
    AtomicFile file(folder / "link");
    file.write("new", 3);
    file.commit();
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
    EXPECT_EQ(read_bytes(folder / "target"), "new");
}

TEST(AtomicFile, RefusesFoldersDevicesAndMissingPlaces) {
    TemporaryFolder folder;
    std::filesystem::create_directory(folder / "sub");
    expect_error([&] { AtomicFile f(folder / "sub"); }, {"sub", "is a folder"});
    expect_error([&] { AtomicFile f("/dev/full"); }, {"/dev/full", "not a regular file"});
    expect_error([&] { AtomicFile f(folder / "none/a"); }, {"none/a", "No such file or directory"});
    expect_error([&] { AtomicFile f("/proc/montelux-test"); },
                 {"/proc/montelux-test", "cannot be written", "no files can be made in the folder '/proc'"});
    // As long as a name may be, without and with a letter more.
    { const AtomicFile longest(folder / std::string(255, 'x')); }
    expect_error([&] { AtomicFile f(folder / std::string(256, 'x')); }, {"File name too long"});
    EXPECT_EQ(folder.file_count(), 1);
}

TEST(AtomicFile, RemembersItsFirstFailure) {
    TemporaryFolder folder;
    // OpenEXR swallows what is thrown while it closes a file.
    auto swallowed = [&] {
        AtomicFile file(folder / "a");
        const std::vector<std::uint8_t> bytes(1 << 20);
        EXPECT_THROW(file.write(bytes), Error);
        try {
            file.commit();
        } catch (const Error& e) {
            if (std::string(e.what()).find(std::strerror(EFBIG)) == std::string::npos) ::_exit(4);
            throw;
        }
    };
    EXPECT_EQ(exit_code_on_full_disk(1000, swallowed), 1);
    EXPECT_EQ(folder.file_count(), 0);
    AtomicFile file(folder / "a");
    file.commit();
    expect_error([&] { file.write("more", 4); }, {"cannot be written: it has its name already"});
}

TEST(ImageWrite, AFullDiskIsAnErrorAndLeavesNothing) {
    TemporaryFolder folder;
    Image image = make_picture(300, 200, {"R", "G", "B"});
    for (const char* name : {"a.exr", "a.png", "a.hdr", "a.pfm"}) {
        auto path = folder / name;
        auto write = [&] { write_image(path, image); };
        for (rlim_t limit : {0, 100, 20000}) {
            EXPECT_EQ(exit_code_on_full_disk(limit, write), 1) << name << " " << limit;
            EXPECT_EQ(folder.file_count(), 0) << name;
        }
        // An older file stays as it was, and with room enough it is replaced.
        write_bytes(path, "old");
        EXPECT_EQ(exit_code_on_full_disk(20000, write), 1) << name;
        EXPECT_EQ(read_bytes(path), "old");
        EXPECT_EQ(exit_code_on_full_disk(1 << 24, write), 0) << name;
        EXPECT_EQ(read_image(path).width(), 300);
        std::filesystem::remove(path);
    }
}

TEST(CheckWritable, ReportsBeforehandWhatWouldFailLater) {
    TemporaryFolder folder;
    write_bytes(folder / "there.exr", "old");
    check_writable(folder / "there.exr");
    check_writable(folder / "new.PNG");
    EXPECT_EQ(read_bytes(folder / "there.exr"), "old");
    EXPECT_EQ(folder.file_count(), 1);
    expect_error([&] { check_writable(folder / "a.tiff"); }, {"'.tiff'", ".exr, .png, .jpg, .hdr, .pfm"});
    expect_error([&] { check_writable(folder / "a"); }, {"no extension", ".exr, .png, .jpg, .hdr or .pfm"});
    expect_error([&] { check_writable(folder / "none/a.exr"); }, {"none"});
    expect_error([&] { check_writable(folder / "there.exr/a.exr"); }, {"there.exr", "Not a directory"});
    if (::geteuid() != 0) { // the superuser may write anywhere
        ::chmod(folder.path().c_str(), 0500);
        expect_error([&] { check_writable(folder / "a.exr"); }, {"Permission denied"});
        ::chmod(folder.path().c_str(), 0700);
    }
}

TEST(ReadFile, RefusesWhatIsNoFile) {
    TemporaryFolder folder;
    expect_error([&] { read_image(folder / "none.png"); }, {"none.png", "No such file"});
    expect_error([&] { read_image(folder.path()); }, {"it is a folder"});
    ASSERT_EQ(::mkfifo((folder / "pipe.png").c_str(), 0600), 0);
    expect_error([&] { read_image(folder / "pipe.png"); }, {"pipe.png", "not a regular file"});
    write_bytes(folder / "empty.png", "");
    expect_error([&] { read_image(folder / "empty.png"); }, {"is empty"});
    write_bytes(folder / "text.png", "this is not a picture");
    expect_error([&] { read_image(folder / "text.png"); }, {"text.png", "known format", "EXR, PNG, JPEG"});
    write_bytes(folder / "long.png", std::string(1000, 'x'));
    expect_error([&] { read_image(folder / "long.png", {.max_file_bytes = 999}); }, {"1000 bytes", "999"});
}

} // namespace
} // namespace montelux
