#include "app/cluster_job.h"

#include <chrono>
#include <cstdio>
#include <fcntl.h>
#include <thread>
#include <unistd.h>

#include "montelux/cluster/communicator.h"

namespace montelux::app {
namespace {

int own_stderr = STDERR_FILENO;

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

void speak_up(const std::string& message) {
    const std::string line = "montelux: error: " + message + "\n";
    if (::write(own_stderr, line.data(), line.size()) < 0) std::fputs(line.c_str(), stderr);
}

void wait_for_the_speaker(const std::string& message) {
    std::this_thread::sleep_for(std::chrono::seconds(5));
    speak_up(message);
}

std::unique_ptr<Communicator> join_job() {
    const auto launched = launched_as();
    if (!launched || launched->size == 1) return nullptr;
    return std::make_unique<Communicator>();
}

} // namespace montelux::app
