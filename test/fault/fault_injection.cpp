// A library for LD_PRELOAD, or linked into a test, that makes one file operation fail. Never installed.
//
// Counted are the calls of this process and its children that open, write, truncate, synchronise, close,
// rename or link something below a folder. From the environment:
//   MONTELUX_FAULT_FOLDER  the folder, absolute; without it nothing happens
//   MONTELUX_FAULT_CALL    which call goes wrong, from 1; 0: none
//   MONTELUX_FAULT_KIND    ENOSPC, EIO, EINTR, EDQUOT: it fails with this error
//                          full-disk: it and all that follow fail with ENOSPC, but for closing
//                          short: it writes half of what it was asked for; other calls do as they do
//                          kill-before, kill-after: the process ends by SIGKILL
//   MONTELUX_FAULT_REPORT  a file with a line each: `fault CALL PATH` where a call went wrong, and
//                          `unseen PATH` where something is opened for writing by the streams of C or C++,
//                          whose writes cannot be reached from here
#include "test/fault/fault_injection.h"

#include <atomic>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <fcntl.h>
#include <string>
#include <string_view>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

namespace {

enum class Kind { none, error, full_disk, shorten, kill_before, kill_after };
enum class Fate { passes, fails, is_short, kills_after };

struct Plan {
    std::string folder, report;
    long call = 0;
    Kind kind = Kind::none;
    int error = 0;
};

std::string variable(const char* name) {
    const char* value = std::getenv(name);
    return value ? value : "";
}

Plan read_plan() {
    Plan plan{variable("MONTELUX_FAULT_FOLDER"), variable("MONTELUX_FAULT_REPORT")};
    plan.call = std::atol(variable("MONTELUX_FAULT_CALL").c_str());
    const std::string kind = variable("MONTELUX_FAULT_KIND");
    struct Name {
        const char* name;
        Kind kind;
        int error;
    };
    for (const Name& n : {Name{"ENOSPC", Kind::error, ENOSPC}, Name{"EIO", Kind::error, EIO},
                          Name{"EINTR", Kind::error, EINTR}, Name{"EDQUOT", Kind::error, EDQUOT},
                          Name{"full-disk", Kind::full_disk, ENOSPC}, Name{"short", Kind::shorten, 0},
                          Name{"kill-before", Kind::kill_before, 0}, Name{"kill-after", Kind::kill_after, 0}})
        if (kind == n.name) plan.kind = n.kind, plan.error = n.error;
    if (plan.call > 0 && plan.kind == Kind::none) {
        std::fprintf(stderr, "fault injection: there is no kind '%s'\n", kind.c_str());
        std::abort();
    }
    return plan;
}

// Never destroyed: files are closed after the end of main, too.
Plan& plan() {
    static Plan* const the_plan = new Plan(read_plan());
    return *the_plan;
}
std::atomic<long> calls{0};

template <typename Function>
Function* next(const char* name) {
    return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

// The kernel's own calls, which are not counted.
void report(std::string_view what, std::string_view path) {
    if (plan().report.empty()) return;
    const std::string line = std::string(what) + " " + std::string(path) + "\n";
    const long fd =
        ::syscall(SYS_openat, AT_FDCWD, plan().report.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0666);
    if (fd < 0) return;
    ::syscall(SYS_write, fd, line.data(), line.size());
    ::syscall(SYS_close, fd);
}

std::string link_text(const std::string& link) {
    char text[PATH_MAX];
    const ssize_t size = ::readlink(link.c_str(), text, sizeof text);
    return size > 0 ? std::string(text, static_cast<std::size_t>(size)) : "";
}
std::string path_of(int fd) { return link_text("/proc/self/fd/" + std::to_string(fd)); }
std::string path_of(int folder, const char* path) {
    if (path[0] == '/') return path;
    return (folder == AT_FDCWD ? link_text("/proc/self/cwd") : path_of(folder)) + "/" + path;
}
bool is_counted(const std::string& path) {
    const std::string& folder = plan().folder;
    return !folder.empty() && path.starts_with(folder) &&
           (path.size() == folder.size() || path[folder.size()] == '/');
}

void die() {
    ::syscall(SYS_kill, ::getpid(), SIGKILL);
    ::pause();
}

Fate fate_of(const char* name, const std::string& path, bool writes = false) {
    if (!is_counted(path)) return Fate::passes;
    const Plan& p = plan();
    const long now = calls.fetch_add(1) + 1;
    const bool lasts = p.kind == Kind::full_disk && std::strcmp(name, "close") != 0;
    if (p.call == 0 || now < p.call || (now > p.call && !lasts)) return Fate::passes;
    report(std::string("fault ") + name, path);
    switch (p.kind) {
    case Kind::error:
    case Kind::full_disk:
        return lasts || p.kind == Kind::error ? Fate::fails : Fate::passes;
    case Kind::shorten:
        return writes ? Fate::is_short : Fate::passes;
    case Kind::kill_before:
        die();
        break;
    case Kind::kill_after:
        return Fate::kills_after;
    case Kind::none:
        break;
    }
    return Fate::passes;
}

template <typename Call>
auto carry_out(Fate fate, Call call) {
    decltype(call()) result = -1;
    if (fate != Fate::fails) result = call();
    if (fate == Fate::fails) errno = plan().error;
    if (fate == Fate::kills_after) die();
    return result;
}

int open_at(int folder, const char* path, int flags, mode_t mode) {
    return carry_out(fate_of("open", path_of(folder, path)),
                     [&] { return static_cast<int>(::syscall(SYS_openat, folder, path, flags, mode)); });
}

mode_t mode_of(int flags, va_list arguments) {
    const bool creates = (flags & O_CREAT) != 0 || (flags & O_TMPFILE) == O_TMPFILE;
    return creates ? static_cast<mode_t>(va_arg(arguments, unsigned)) : 0;
}

void note_stream(const char* path, const char* mode) {
    if (std::strpbrk(mode, "wa+") && is_counted(path_of(AT_FDCWD, path)))
        report("unseen", path_of(AT_FDCWD, path));
}

} // namespace

namespace montelux::fault {
void restart() {
    calls = 0;
    plan() = read_plan();
}
long count() { return calls; }
} // namespace montelux::fault

#define OPEN(NAME)                                                                                           \
    int NAME(const char* path, int flags, ...) {                                                             \
        va_list arguments;                                                                                   \
        va_start(arguments, flags);                                                                          \
        const mode_t mode = mode_of(flags, arguments);                                                       \
        va_end(arguments);                                                                                   \
        return open_at(AT_FDCWD, path, flags, mode);                                                         \
    }
#define OPENAT(NAME)                                                                                         \
    int NAME(int folder, const char* path, int flags, ...) {                                                 \
        va_list arguments;                                                                                   \
        va_start(arguments, flags);                                                                          \
        const mode_t mode = mode_of(flags, arguments);                                                       \
        va_end(arguments);                                                                                   \
        return open_at(folder, path, flags, mode);                                                           \
    }
#define PWRITE(NAME)                                                                                         \
    ssize_t NAME(int fd, const void* data, std::size_t size, off_t at) {                                     \
        const Fate fate = fate_of("pwrite", path_of(fd), true);                                              \
        if (fate == Fate::is_short && size > 1) size /= 2;                                                   \
        return carry_out(fate,                                                                               \
                         [&] { return static_cast<ssize_t>(::syscall(SYS_pwrite64, fd, data, size, at)); }); \
    }
#define OF_DESCRIPTOR(NAME)                                                                                  \
    int NAME(int fd) {                                                                                       \
        return carry_out(fate_of(#NAME, path_of(fd)),                                                        \
                         [&] { return static_cast<int>(::syscall(SYS_##NAME, fd)); });                       \
    }
#define FTRUNCATE(NAME)                                                                                      \
    int NAME(int fd, off_t size) noexcept {                                                                  \
        return carry_out(fate_of("ftruncate", path_of(fd)),                                                  \
                         [&] { return static_cast<int>(::syscall(SYS_ftruncate, fd, size)); });              \
    }
#define FOPEN(NAME)                                                                                          \
    std::FILE* NAME(const char* path, const char* mode) {                                                    \
        note_stream(path, mode);                                                                             \
        return next<std::FILE*(const char*, const char*)>(#NAME)(path, mode);                                \
    }

// NOLINTBEGIN: these names and signatures are those of the C library.
#pragma GCC visibility push(default)
extern "C" {
OPEN(open)
OPEN(open64)
OPENAT(openat)
OPENAT(openat64)
int creat(const char* path, mode_t mode) {
    return open_at(AT_FDCWD, path, O_CREAT | O_WRONLY | O_TRUNC, mode);
}
PWRITE(pwrite)
PWRITE(pwrite64)
OF_DESCRIPTOR(fsync)
OF_DESCRIPTOR(fdatasync)
FTRUNCATE(ftruncate)
FTRUNCATE(ftruncate64)
FOPEN(fopen)
FOPEN(fopen64)

std::FILE* fdopen(int fd, const char* mode) noexcept {
    if (std::strpbrk(mode, "wa+") && is_counted(path_of(fd))) report("unseen", path_of(fd));
    return next<std::FILE*(int, const char*)>("fdopen")(fd, mode);
}

ssize_t write(int fd, const void* data, std::size_t size) {
    const Fate fate = fate_of("write", path_of(fd), true);
    if (fate == Fate::is_short && size > 1) size /= 2;
    return carry_out(fate, [&] { return static_cast<ssize_t>(::syscall(SYS_write, fd, data, size)); });
}

ssize_t writev(int fd, const iovec* pieces, int count) {
    const Fate fate = fate_of("writev", path_of(fd), true);
    if (fate == Fate::is_short && count > 1) count /= 2;
    return carry_out(fate, [&] { return static_cast<ssize_t>(::syscall(SYS_writev, fd, pieces, count)); });
}

// A descriptor is closed even where closing fails.
int close(int fd) {
    const Fate fate = fate_of("close", path_of(fd));
    const int result = static_cast<int>(::syscall(SYS_close, fd));
    return carry_out(fate, [&] { return result; });
}

int renameat(int from_folder, const char* from, int to_folder, const char* to) noexcept {
    return carry_out(fate_of("rename", path_of(to_folder, to)), [&] {
        return static_cast<int>(::syscall(SYS_renameat, from_folder, from, to_folder, to));
    });
}
int rename(const char* from, const char* to) noexcept { return renameat(AT_FDCWD, from, AT_FDCWD, to); }

int linkat(int from_folder, const char* from, int to_folder, const char* to, int flags) noexcept {
    return carry_out(fate_of("link", path_of(to_folder, to)), [&] {
        return static_cast<int>(::syscall(SYS_linkat, from_folder, from, to_folder, to, flags));
    });
}
int link(const char* from, const char* to) noexcept { return linkat(AT_FDCWD, from, AT_FDCWD, to, 0); }
}
#pragma GCC visibility pop
// NOLINTEND
