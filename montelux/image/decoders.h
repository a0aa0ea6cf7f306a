// One decoder per file format, internal to the image room: bytes in, Image out, Error for anything damaged.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "montelux/image/image.h"
#include "montelux/image/image_read.h"

namespace montelux {

// Everything a decoder needs; `name` begins each message.
struct EncodedImage {
    std::span<const std::uint8_t> bytes;
    const std::string& name;
    const ReadOptions& options;
};

Image decode_exr(const EncodedImage& file);
Image decode_png(const EncodedImage& file);
Image decode_jpeg(const EncodedImage& file);
Image decode_hdr(const EncodedImage& file);
Image decode_pfm(const EncodedImage& file);
Image decode_pnm(const EncodedImage& file);
Image decode_webp(const EncodedImage& file);
Image decode_stb(const EncodedImage& file); // TGA and BMP

// Throws unless an image of this size is allowed; every decoder checks before it allocates.
void check_image_size(const EncodedImage& file, std::uint64_t width, std::uint64_t height,
                      std::uint64_t channels, std::uint64_t sample_bytes);

// Text from a file, safe for a message: bytes other than plain characters become '?'.
inline std::string printable(std::string text) {
    for (char& c : text)
        if (c < 0x20 || c > 0x7e) c = '?';
    return text;
}

} // namespace montelux
