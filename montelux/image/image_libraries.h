// The libraries by which pictures are read and written; libwebp is optional.
#pragma once

#include <vector>

#include "montelux/mc/math/library_version.h"

namespace montelux {

std::vector<LibraryVersion> image_libraries();

} // namespace montelux
