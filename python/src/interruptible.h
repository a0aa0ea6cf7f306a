// Work of the library that Ctrl-C ends.
#pragma once

#include <chrono>
#include <future>
#include <nanobind/nanobind.h>

#include "montelux/mc/parallel/parallel_for.h"

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

} // namespace montelux::python
