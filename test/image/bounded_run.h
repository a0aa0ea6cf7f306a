// Runs something in a child process that may use only so much memory and time.
#pragma once

#include "test/sanitized.h"
#include <chrono>
#include <csignal>
#include <cstdio>
#include <string>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "montelux/mc/math/error.h"

namespace montelux {

enum class Ending { done, refused, crashed, timed_out };

struct BoundedRun {
    Ending ending;
    std::string message; // of the Error, or how the child died
};

// `action` ends, or throws an Error; anything else is a crash. The memory limit is 1.5 GiB of addresses,
// except under the address sanitizer, which reserves terabytes.
template <typename Action>
BoundedRun bounded_run(Action action, unsigned seconds = 10) {
    int pipe_ends[2];
    if (::pipe(pipe_ends) != 0) return {Ending::crashed, "no pipe"};
    pid_t child = ::fork();
    if (child == 0) {
        ::close(pipe_ends[0]);
        const rlimit memory{rlim_t{1536} << 20, rlim_t{1536} << 20};
        if (!under_sanitizers) ::setrlimit(RLIMIT_AS, &memory);
        rlimit core{0, 0};
        ::setrlimit(RLIMIT_CORE, &core);
        ::alarm(seconds);
        try {
            action();
        } catch (const Error& e) {
            std::string what = e.what();
            [[maybe_unused]] auto written =
                ::write(pipe_ends[1], what.data(), std::min<std::size_t>(what.size(), 4096));
            ::_exit(1);
        } catch (const std::exception& e) {
            std::string what = std::string("not an Error: ") + e.what();
            [[maybe_unused]] auto written =
                ::write(pipe_ends[1], what.data(), std::min<std::size_t>(what.size(), 4096));
            ::_exit(2);
        }
        ::_exit(0);
    }
    ::close(pipe_ends[1]);
    std::string message;
    char buffer[4096];
    for (ssize_t n; (n = ::read(pipe_ends[0], buffer, sizeof buffer)) > 0;) message.append(buffer, n);
    ::close(pipe_ends[0]);
    int status = 0;
    ::waitpid(child, &status, 0);
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {Ending::done, ""};
    if (WIFEXITED(status) && WEXITSTATUS(status) == 1) return {Ending::refused, message};
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM) return {Ending::timed_out, "too slow"};
    return {Ending::crashed, message + " (status " + std::to_string(status) + ")"};
}

} // namespace montelux
