// thread_cpu_seconds: CPU time of the calling thread; other programs do not affect it.
#pragma once

#include <ctime>

namespace montelux {

inline double thread_cpu_seconds() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

} // namespace montelux
