#include "app/interrupt.h"

#include "app/commands.h"
#include <atomic>
#include <csignal>
#include <cstdint>
#include <ctime>
#include <string_view>
#include <unistd.h>

namespace montelux::app {

namespace {

enum class Phase { nothing_to_save, cancellable, following, waiting, writing };

constexpr std::int64_t same_wish_milliseconds = 1000;

CancelFlag cancel_flag;
std::atomic<Phase> phase{Phase::nothing_to_save};
std::atomic<Phase> phase_before{Phase::nothing_to_save}; // of waiting
std::atomic<bool> signal_waits{false};
std::atomic<std::int64_t> first_signal{0}; // in milliseconds, where it set the flag
static_assert(std::atomic<Phase>::is_always_lock_free && std::atomic<bool>::is_always_lock_free &&
              std::atomic<std::int64_t>::is_always_lock_free);

std::int64_t milliseconds() {
    timespec t{};
    clock_gettime(CLOCK_MONOTONIC, &t);
    return std::int64_t{1000} * t.tv_sec + t.tv_nsec / 1'000'000;
}

// Async-signal-safe calls alone.
extern "C" void on_signal(int) {
    const Phase now = phase.load();
    if (now == Phase::writing) return;
    if (now == Phase::waiting) {
        signal_waits.store(true);
        return;
    }
    if (now == Phase::cancellable || now == Phase::following) {
        const std::int64_t first = first_signal.load(), at = milliseconds();
        if (first == 0) first_signal.store(at);
        cancel_flag.request();
        if (first == 0 || now == Phase::following || at - first < same_wish_milliseconds) return;
    }
    // There may be checkpoints, which this leaves alone.
    constexpr std::string_view early = "\nmontelux: interrupted, nothing was written\n",
                               hasty = "\nmontelux: ended at once by another signal: no result was written; "
                                       "checkpoints are as they were last written\n";
    const std::string_view message = now == Phase::cancellable ? hasty : early;
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

WaitingSignals::WaitingSignals() { phase_before.store(phase.exchange(Phase::waiting)); }

WaitingSignals::~WaitingSignals() {
    phase.store(phase_before.load());
    if (signal_waits.exchange(false)) on_signal(0);
}

const CancelFlag& follow_on_signals() {
    phase.store(Phase::following);
    return cancel_flag;
}

void request_cancel() { cancel_flag.request(); }

void finish_on_signals() { phase.store(Phase::writing); }

} // namespace montelux::app
