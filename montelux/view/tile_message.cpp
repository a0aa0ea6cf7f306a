#include "montelux/view/tile_message.h"

#include <algorithm>
#include <vector>

#include "montelux/image/half.h"
#include "montelux/view/little_endian.h"

namespace montelux {

std::string tile_message(std::size_t index, const ViewLayer& layer, std::uint32_t epoch,
                         std::span<const LiveTile> tiles) {
    const std::size_t bytes = layer.exact ? sizeof(float) : sizeof(std::uint16_t);
    std::size_t size = 8;
    for (const LiveTile& tile : tiles) size += 8 + bytes * tile.values.size();
    std::string message;
    message.reserve(size);
    append(message, std::uint8_t{1});
    append(message, static_cast<std::uint8_t>(index));
    append(message, static_cast<std::uint8_t>(layer.channels));
    append(message, static_cast<std::uint8_t>(bytes));
    append(message, epoch);
    std::vector<std::uint16_t> halves;
    for (const LiveTile& tile : tiles) {
        const PixelBounds& b = tile.bounds;
        for (const int v : {b.x0, b.y0, b.width(), b.height()})
            append(message, static_cast<std::uint16_t>(v));
        if (layer.exact) {
            append(message, std::span<const float>(tile.values));
        } else {
            halves.resize(tile.values.size());
            std::ranges::transform(tile.values, halves.begin(), clamped_half);
            append(message, std::span<const std::uint16_t>(halves));
        }
    }
    return message;
}

} // namespace montelux
