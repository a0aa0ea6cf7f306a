// The tree of one NanoVDB grid: a walk that trusts no offset.
#pragma once

#include <cstdint>
#include <span>

#include "montelux/formats/nanovdb_file.h"

namespace montelux {

// Copies the grid of floats, doubles or quantised floats that fills `bytes`. Values and blocks that are equal
// throughout become constants. Throws Error without the name of the file.
PlacedSparseGrid copy_nanovdb_grid(std::span<const std::uint8_t> bytes);

} // namespace montelux
