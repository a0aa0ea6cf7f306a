// run_beside: long work in a thread of its own, while the thread that owns the mailbox stays in touch with other ranks.
#pragma once

#include <chrono>
#include <exception>
#include <future>
#include <thread>

namespace montelux {

// Calls meanwhile() in this thread every `interval` until work() has returned in another one. Rethrows the exceptions of
// work(), and those of meanwhile() after work() has returned.
template <typename Work, typename Meanwhile>
void run_beside(const Work& work, std::chrono::microseconds interval, const Meanwhile& meanwhile) {
    std::promise<void> promise;
    std::future<void> done = promise.get_future();
    const std::jthread thread([&] {
        try {
            work();
            promise.set_value();
        } catch (...) {
            promise.set_exception(std::current_exception());
        }
    });
    while (done.wait_for(interval) != std::future_status::ready) meanwhile();
    done.get();
}

} // namespace montelux
