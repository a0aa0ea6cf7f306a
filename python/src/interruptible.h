// Work of the library that Ctrl-C ends.
#pragma once

#include <chrono>
#include <future>
#include <nanobind/nanobind.h>

#include "montelux/mc/parallel/cancel_flag.h"

namespace montelux::python {

namespace nb = nanobind;

// Without Python's lock, on another thread, so that Ctrl-C is seen and cancels it.
template <typename Work>
void run_interruptibly(const Work& work) {
    CancelFlag cancel;
    std::future<void> done = std::async(std::launch::async, [&] { work(cancel); });
    while (done.wait_for(std::chrono::milliseconds(50)) != std::future_status::ready) {
        nb::gil_scoped_acquire lock;
        if (!cancel.requested() && PyErr_CheckSignals() != 0) cancel.request();
    }
    if (cancel.requested()) {
        nb::gil_scoped_acquire lock;
        throw nb::python_error();
    }
    done.get();
}

// An integration that Ctrl-C ends with its result so far, while this object lives on the thread that called it. An
// integrand may integrate: the runs of a thread form a stack, and Ctrl-C ends all of them.
class InterruptibleRun {
  public:
    explicit InterruptibleRun(CancelFlag& cancel);
    InterruptibleRun(const InterruptibleRun&) = delete;
    InterruptibleRun& operator=(const InterruptibleRun&) = delete;
    ~InterruptibleRun();

    bool is_inside_interrupted() const { return outer_ != nullptr && outer_->cancel_.requested(); }
    // Requests the runs of this thread to stop if an error of Python is Ctrl-C; false: it is not, or there are none.
    static bool interrupt(const nb::python_error& error);

  private:
    static thread_local InterruptibleRun* innermost;

    CancelFlag& cancel_;
    InterruptibleRun* outer_;
};

// Throws the error of Python that is set, or IntegrandInterrupted where that interrupts runs. Requires the lock.
[[noreturn]] void throw_python_error();

} // namespace montelux::python
