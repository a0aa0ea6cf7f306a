// Tiles of a live picture as a binary message of docs/view-protocol.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "montelux/view/live_picture.h"

namespace montelux {

// `index`: of the layer among those of the picture.
std::string tile_message(std::size_t index, const ViewLayer& layer, std::uint32_t epoch,
                         std::span<const LiveTile> tiles);

} // namespace montelux
