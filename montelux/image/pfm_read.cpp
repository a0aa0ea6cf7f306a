#include <bit>
#include <cmath>
#include <cstring>

#include "montelux/image/decoders.h"
#include "montelux/image/text_cursor.h"
#include "montelux/mc/math/error.h"

namespace montelux {

// "Portable FloatMap Image Format" (pauldebevec.com/Research/HDR/PFM): "PF" colour or "Pf" grey, width,
// height, a scale whose sign gives the byte order (negative: little-endian) and whose size multiplies the
// samples; then rows from the bottom up.
Image decode_pfm(const EncodedImage& file) {
    TextCursor cursor(file.bytes);
    std::string magic = cursor.word();
    int channels = magic == "PF" ? 3 : 1;
    auto take = [&](const char* what) {
        cursor.skip_space_and_comments();
        std::string word = cursor.word();
        if (auto v = parse_number<double>(word); v && std::isfinite(*v)) return *v;
        throw Error(file.name,
                    "the PFM file is damaged: its " + std::string(what) + " is '" + printable(word) + "'");
    };
    double width = take("width"), height = take("height"), scale = take("scale");
    if (width < 1 || height < 1 || width > 1e9 || height > 1e9 || width != std::floor(width) ||
        height != std::floor(height) || scale == 0)
        throw Error(file.name, "the PFM file is damaged: its size or scale is wrong");
    if (!TextCursor::is_space(cursor.next()))
        throw Error(file.name, "the PFM file is damaged: its header has no end");
    check_image_size(file, static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height), channels,
                     4);
    Image image(static_cast<int>(width), static_cast<int>(height),
                channels == 3 ? std::vector<std::string>{"R", "G", "B"} : std::vector<std::string>{"Y"});
    if (cursor.remaining() < image.byte_count())
        throw Error(file.name, "the PFM file is damaged: it has " + std::to_string(cursor.remaining()) +
                                   " bytes of pixels instead of " + std::to_string(image.byte_count()));
    bool swap = (scale < 0) != (std::endian::native == std::endian::little);
    float factor = static_cast<float>(std::abs(scale));
    std::size_t row = static_cast<std::size_t>(image.width()) * channels;
    const std::uint8_t* source = cursor.rest().data();
    for (int y = image.height() - 1; y >= 0; --y)
        for (std::size_t i = 0; i < row; ++i, source += 4) {
            std::uint32_t bits;
            std::memcpy(&bits, source, 4);
            if (swap) bits = __builtin_bswap32(bits);
            float v = std::bit_cast<float>(bits);
            image.f32()[y * row + i] = factor == 1 ? v : v * factor;
        }
    return image;
}

} // namespace montelux
