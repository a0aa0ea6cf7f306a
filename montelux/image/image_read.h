// Reading pictures: untrusted EXR, PNG, JPEG, Radiance HDR, PFM, PNM, WebP, TGA and BMP files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "montelux/image/image.h"

namespace montelux {

struct ReadOptions {
    // A picture that needs more memory for its pixels is refused before reading them.
    std::size_t max_pixel_bytes = std::size_t{768} << 20;
    std::size_t max_file_bytes = std::size_t{1} << 30;
};

// The format is recognised by the first bytes, and for TGA, which has no signature, by the extension. Integer
// formats come as u8 or u16 with the sRGB encoding (a PNG's own gamma is kept as the attribute "png.gamma"
// and not applied); float formats as f16 or f32, linear. Channels: "R", "G", "B", "A", or "Y" for grey; an
// EXR file gives all channels of its first part, R, G, B and A first. Row 0 is the top one. EXR: the image is
// the data window; attributes contain its position (placement.h). Throws Error, with the path and what is
// wrong, on anything that cannot be read whole.
Image read_image(const std::filesystem::path& path, const ReadOptions& options = {});

// The same for a picture in memory (embedded in another file); `name` is used in messages, and its extension.
Image read_image(std::span<const std::uint8_t> bytes, const std::string& name,
                 const ReadOptions& options = {});

// Whether Montelux was built with libwebp.
bool reads_webp();

// Whether a file begins as those of a format that read_image knows by its content (all but TGA).
bool is_picture(std::span<const std::uint8_t> bytes);

} // namespace montelux
