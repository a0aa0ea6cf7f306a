#include "python/src/interruptible.h"

#include "montelux/mc/integrate/interruptible.h"

namespace montelux::python {

thread_local InterruptibleRun* InterruptibleRun::innermost = nullptr;

InterruptibleRun::InterruptibleRun(CancelFlag& cancel) : cancel_(cancel), outer_(innermost) {
    innermost = this;
}

InterruptibleRun::~InterruptibleRun() { innermost = outer_; }

bool InterruptibleRun::interrupt(const nb::python_error& error) {
    if (innermost == nullptr || !error.matches(PyExc_KeyboardInterrupt)) return false;
    for (InterruptibleRun* run = innermost; run != nullptr; run = run->outer_) run->cancel_.request();
    return true;
}

void throw_python_error() {
    const nb::python_error error;
    if (InterruptibleRun::interrupt(error)) throw IntegrandInterrupted{};
    throw error;
}

} // namespace montelux::python
