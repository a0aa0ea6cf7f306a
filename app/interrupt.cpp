#include "app/interrupt.h"

#include "app/commands.h"
#include <atomic>
#include <csignal>
#include <string_view>
#include <unistd.h>

namespace montelux::app {

namespace {

enum class Phase { nothing_to_save, cancellable, writing };

CancelFlag cancel_flag;
std::atomic<Phase> phase{Phase::nothing_to_save};
static_assert(std::atomic<Phase>::is_always_lock_free);

// Async-signal-safe calls alone.
extern "C" void on_signal(int) {
    const Phase now = phase.load();
    if (now == Phase::writing) return;
    if (now == Phase::cancellable && !cancel_flag.requested()) {
        cancel_flag.request();
        return;
    }
    constexpr std::string_view message = "\nmontelux: interrupted, nothing was written\n";
    if (::write(STDERR_FILENO, message.data(), message.size()) < 0) ::_exit(exit_interrupted);
    ::_exit(exit_interrupted);
}

} // namespace

void end_on_signals() {
    struct sigaction action {};
    action.sa_handler = on_signal;
    action.sa_flags = SA_RESTART;
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    struct sigaction inherited {};
    if (sigaction(SIGHUP, nullptr, &inherited) == 0 && inherited.sa_handler != SIG_IGN)
        sigaction(SIGHUP, &action, nullptr);
}

const CancelFlag& cancel_on_signals() {
    phase.store(Phase::cancellable);
    return cancel_flag;
}

void finish_on_signals() { phase.store(Phase::writing); }

} // namespace montelux::app
