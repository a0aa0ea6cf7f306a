// TexelLevel: where the texels of one level of a pyramid are: by rows in memory, or by tiles in a file.
#pragma once

#include <cstddef>

#include "montelux/image/image.h"

namespace montelux {

// Samples of a texel are adjacent.
struct TexelLevel {
    const void* samples = nullptr;
    PixelFormat format = PixelFormat::f32;
    int width = 0, height = 0;
    int stride = 1; // samples per texel
    // Of TileLayout. Tiles have 2^x_bits by 2^y_bits texels.
    int x_bits = 0, y_bits = 0;
    int tiles_x = 0;

    template <typename T>
    const T* at(std::size_t texel) const {
        return static_cast<const T*>(samples) + texel * static_cast<std::size_t>(stride);
    }
    std::size_t texel_bytes() const { return static_cast<std::size_t>(stride) * bytes_per_sample(format); }
};

// Places of texels.
struct RowLayout {
    static std::size_t index(const TexelLevel& l, int x, int y) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(l.width) + static_cast<std::size_t>(x);
    }
};

// Tiles follow one another by rows, texels within a tile likewise; those at the right and lower edge are filled
// up. A look-up makes a neighbourhood of 64 KiB resident, 16 pages, so a tile has about this size: pictures of a
// large texture touch up to eight times more neighbourhoods where texels lie by rows, and twice as many with tiles
// of one page (docs/measurements/performance.md).
struct TileLayout {
    static constexpr std::size_t most_bytes = std::size_t{1} << 16;

    // Sets the tiles of a level whose other values are set; its bytes are returned.
    static std::size_t arrange(TexelLevel& level);
    static int tiles_y(const TexelLevel& l) { return ((l.height - 1) >> l.y_bits) + 1; }
    static std::size_t tile_texels(const TexelLevel& l) { return std::size_t{1} << (l.x_bits + l.y_bits); }

    static std::size_t index(const TexelLevel& l, int x, int y) {
        const auto tile = static_cast<std::size_t>(y >> l.y_bits) * static_cast<std::size_t>(l.tiles_x) +
                          static_cast<std::size_t>(x >> l.x_bits);
        const int within = ((y & ((1 << l.y_bits) - 1)) << l.x_bits) | (x & ((1 << l.x_bits) - 1));
        return (tile << (l.x_bits + l.y_bits)) + static_cast<std::size_t>(within);
    }
};

inline std::size_t TileLayout::arrange(TexelLevel& l) {
    l.x_bits = l.y_bits = 0;
    const auto fits = [&](int bits) { return l.texel_bytes() << bits <= most_bytes; };
    // Square, but no longer than the level.
    for (bool grown = true; grown;) {
        grown = false;
        for (const bool along_x : {true, false}) {
            int& bits = along_x ? l.x_bits : l.y_bits;
            if (1 << bits >= (along_x ? l.width : l.height) || !fits(l.x_bits + l.y_bits + 1)) continue;
            ++bits;
            grown = true;
        }
    }
    l.tiles_x = ((l.width - 1) >> l.x_bits) + 1;
    return static_cast<std::size_t>(l.tiles_x) * static_cast<std::size_t>(tiles_y(l)) * tile_texels(l) *
           l.texel_bytes();
}

} // namespace montelux
