#include <algorithm>

#include "montelux/image/decoders.h"
#include "montelux/image/text_cursor.h"
#include "montelux/mc/math/error.h"

namespace montelux {

// Netpbm's formats (netpbm.sourceforge.net/doc: pbm, pgm, ppm): P1 to P3 as text, P4 to P6 binary; bitmaps
// (1 is black), grey, colour. Samples with a maximum other than 255 or 65535 are scaled up to the next one.
Image decode_pnm(const EncodedImage& file) {
    TextCursor cursor(file.bytes);
    int kind = cursor.word().at(1) - '0';
    bool text = kind <= 3, bitmap = kind == 1 || kind == 4, color = kind == 3 || kind == 6;
    auto damaged = [&](const std::string& what) {
        return Error(file.name, "the PNM file is damaged: " + what);
    };
    auto take = [&](const char* what) {
        cursor.skip_space_and_comments();
        std::string word = cursor.word();
        if (auto v = parse_number<std::uint32_t>(word)) return *v;
        throw damaged("its " + std::string(what) + " is '" + printable(word) + "'");
    };
    std::uint32_t width = take("width"), height = take("height");
    std::uint32_t maximum = bitmap ? 1 : take("maximum");
    if (maximum < 1 || maximum > 65535) throw damaged("its maximum is " + std::to_string(maximum));
    bool wide = maximum > 255;
    std::size_t channels = color ? 3 : 1;
    check_image_size(file, width, height, channels, wide ? 2 : 1);
    if (!TextCursor::is_space(cursor.next())) throw damaged("its header has no end");

    std::size_t row_samples = width * channels;
    std::size_t file_row = kind == 4 ? (width + 7) / 8 : row_samples * (wide ? 2 : 1);
    // A sample in text is a digit and a space; a bitmap's spaces may be left out.
    std::size_t needed = text ? row_samples * height * (bitmap ? 1 : 2) - 1 : file_row * height;
    if (cursor.remaining() < needed)
        throw damaged("it has " + std::to_string(cursor.remaining()) + " bytes of pixels instead of " +
                      std::to_string(needed));
    Image image(static_cast<int>(width), static_cast<int>(height),
                color ? std::vector<std::string>{"R", "G", "B"} : std::vector<std::string>{"Y"},
                wide ? PixelFormat::u16 : PixelFormat::u8, ColorEncoding::srgb());
    std::uint32_t full = wide ? 65535 : 255;
    const std::uint8_t* bytes = cursor.rest().data();
    for (std::size_t y = 0; y < height; ++y)
        for (std::size_t i = 0; i < row_samples; ++i) {
            std::uint32_t v;
            if (kind == 1) {
                cursor.skip_space_and_comments();
                int digit = cursor.next();
                if (digit != '0' && digit != '1') throw damaged("a bit is neither 0 nor 1");
                v = digit == '0';
            } else if (kind == 4) {
                v = ((bytes[y * file_row + i / 8] >> (7 - i % 8)) & 1) == 0;
            } else if (text) {
                v = take("sample");
            } else if (wide) {
                v = std::uint32_t{bytes[y * file_row + 2 * i]} << 8 | bytes[y * file_row + 2 * i + 1];
            } else {
                v = bytes[y * file_row + i];
            }
            if (v > maximum) throw damaged("sample " + std::to_string(v) + " exceeds its maximum");
            std::uint32_t scaled = (v * full + maximum / 2) / maximum;
            if (wide)
                image.u16()[y * row_samples + i] = static_cast<std::uint16_t>(scaled);
            else
                image.u8()[y * row_samples + i] = static_cast<std::uint8_t>(scaled);
        }
    return image;
}

} // namespace montelux
