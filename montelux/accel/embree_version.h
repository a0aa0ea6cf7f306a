// The Embree that the program was built for.
#pragma once

#include "montelux/mc/math/library_version.h"

namespace montelux {

LibraryVersion embree_version();

} // namespace montelux
