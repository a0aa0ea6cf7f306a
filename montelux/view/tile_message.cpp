#include "montelux/view/tile_message.h"

#include "montelux/image/half.h"
#include "montelux/view/little_endian.h"

namespace montelux {

std::string tile_message(std::size_t index, const ViewLayer& layer, std::uint32_t epoch,
                         std::span<const LiveTile> tiles) {
    std::string message;
    append(message, std::uint8_t{1});
    append(message, static_cast<std::uint8_t>(index));
    append(message, static_cast<std::uint8_t>(layer.channels));
    append(message, static_cast<std::uint8_t>(layer.exact ? sizeof(float) : sizeof(std::uint16_t)));
    append(message, epoch);
    for (const LiveTile& tile : tiles) {
        const PixelBounds& b = tile.bounds;
        for (const int v : {b.x0, b.y0, b.width(), b.height()})
            append(message, static_cast<std::uint16_t>(v));
        for (const float v : tile.values) {
            if (layer.exact)
                append(message, v);
            else
                append(message, clamped_half(v));
        }
    }
    return message;
}

} // namespace montelux
