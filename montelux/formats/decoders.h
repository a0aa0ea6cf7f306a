// The optional libraries that unpack compressed glTF and NanoVDB files.
#pragma once

#include <vector>

#include "montelux/mc/math/library_version.h"

namespace montelux {

std::vector<LibraryVersion> decoders();

} // namespace montelux
