#include "app/interrupt.h"

#include "app/commands.h"
#include <atomic>
#include <csignal>
#include <string_view>
#include <unistd.h>

namespace montelux::app {

namespace {

CancelFlag cancel_flag;
std::atomic<bool> saving{false};
static_assert(std::atomic<bool>::is_always_lock_free);

// Async-signal-safe calls alone.
extern "C" void on_signal(int) {
    if (saving.load() && !cancel_flag.requested()) {
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
    saving.store(true);
    return cancel_flag;
}

} // namespace montelux::app
