// The table of --memory: what the parts of a scene take.
#pragma once

#include <span>
#include <string>

#include "montelux/scene/memory_use.h"

namespace montelux::app {

// A line for each kind, their sum, and the peak of the process, in bytes; lines end in a line break.
std::string memory_text(std::span<const MemoryUse> table, std::size_t peak);
// Largest resident memory of this process so far, bytes.
std::size_t peak_memory();

} // namespace montelux::app
