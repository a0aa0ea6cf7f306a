#include "app/cluster_job.h"

#include "app/commands.h"
#include "app/interrupt.h"
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fcntl.h>
#include <limits>
#include <memory>
#include <thread>
#include <unistd.h>

#include "montelux/cluster/communicator.h"

namespace montelux::app {
namespace {

// Seconds. After a signal everything is already written, so do not wait longer.
constexpr double patience_when_interrupted = 2;

int own_stderr = STDERR_FILENO;
std::unique_ptr<Communicator> the_job;
double patience_with_others = patience_with_ranks;

} // namespace

bool is_silent_rank() {
    const auto launched = launched_as();
    return launched && launched->rank != 0;
}

void silence_other_ranks() {
    if (!is_silent_rank()) return;
    const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
    own_stderr = ::fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
    if (nowhere < 0 || own_stderr < 0) return;
    ::dup2(nowhere, STDOUT_FILENO);
    ::dup2(nowhere, STDERR_FILENO);
    ::close(nowhere);
}

void print_rank_error(const std::string& message) {
    const std::string line = "montelux: error: " + message + "\n";
    if (::write(own_stderr, line.data(), line.size()) < 0) std::fputs(line.c_str(), stderr);
}

void wait_for_rank_0(const std::string& message) {
    std::this_thread::sleep_for(std::chrono::seconds(5));
    print_rank_error(message);
}

Communicator* join_job(double patience_seconds) {
    const auto launched = launched_as();
    if (!launched || launched->size == 1) return nullptr;
    the_job = std::make_unique<Communicator>();
    patience_with_others = patience_seconds;
    return the_job.get();
}

void leave_job(int exit_code) {
    if (!the_job) return;
    double patience = std::numeric_limits<double>::infinity();
    if (the_job->rank() == 0)
        patience = exit_code == exit_interrupted ? std::min(patience_with_others, patience_when_interrupted)
                                                 : patience_with_others;
    if (!the_job->leave(patience)) {
        // A failure was already reported.
        if (exit_code != exit_failed && exit_code != exit_usage)
            std::fprintf(stderr,
                         "montelux: warning: a rank has not ended in time; the job ends without it\n");
        end_job(exit_code);
    }
    the_job.reset();
}

void end_job(int exit_code) {
    std::fflush(nullptr);
    finish_on_signals(); // the launcher sends one to all ranks, this one too
    the_job->abort(exit_code);
}

} // namespace montelux::app
