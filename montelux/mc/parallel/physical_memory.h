// The memory of this machine, for refusing in advance what does not fit.
#pragma once

#include <limits>
#include <unistd.h>

namespace montelux {

// In bytes; infinite where the system does not tell.
inline double physical_memory() {
    const auto pages = static_cast<double>(sysconf(_SC_PHYS_PAGES));
    if (!(pages > 0)) return std::numeric_limits<double>::infinity();
    return pages * static_cast<double>(sysconf(_SC_PAGESIZE));
}

} // namespace montelux
