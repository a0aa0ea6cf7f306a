// The oneTBB that the process has loaded.
#pragma once

#include <tbb/version.h>

#include "montelux/mc/math/library_version.h"

namespace montelux {

inline LibraryVersion tbb_version() { return {"oneTBB", TBB_runtime_version()}; }

} // namespace montelux
