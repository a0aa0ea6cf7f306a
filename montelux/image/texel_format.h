// Texel formats of graphics processors: linear light as halves, floats, shared exponents, small floats, RGBM.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "montelux/image/image.h"

namespace montelux {

enum class TexelFormat {
    rgba16f,    // R, G, B, A as halves; 8 bytes
    rgba32f,    // R, G, B, A as floats; 16 bytes
    rg16f,      // R, G as halves; 4 bytes
    rg32f,      // R, G as floats; 8 bytes
    rgb9e5,     // R, G, B: 9 bits each with one exponent of 5 bits; 4 bytes, nothing negative, up to 65408
    r11g11b10f, // R, G, B as floats without sign of 11, 11, 10 bits; 4 bytes, up to 65024, 65024, 64512
    rgbm8       // R, G, B and a common factor M, 8 bits each; see RgbmScale
};

// "rgba16f", ...
std::string_view name_of(TexelFormat format);
std::optional<TexelFormat> texel_format_named(std::string_view name);
std::size_t bytes_per_texel(TexelFormat format);

// The bytes (r, g, b, m) mean the light (range * r/255 * m/255)^power, likewise for g and b.
// Power 2 keeps more of the dark and reaches range^2.
struct RgbmScale {
    double range = 16;
    int power = 1; // or 2
};
// Throws Error, which begins with `where`, unless the range is in [1, 65536] and the power is 1 or 2.
void check_rgbm_scale(std::string_view where, const RgbmScale& scale);

// How a texture is stored in a file (ktx1_write.h, ktx2_write.h).
struct TextureOptions {
    TexelFormat format = TexelFormat::rgba16f;
    RgbmScale rgbm{}; // where the format is rgbm8
    // Metadata of the file: key to text, without zero bytes. Keys that begin with "KTX" or "ktx" belong to
    // the file format.
    std::map<std::string, std::string> notes{};
};

// Values that a format could not hold, in samples (not texels).
struct TexelLosses {
    std::uint64_t too_large = 0;  // became the largest number of the format, infinities included
    std::uint64_t negative = 0;   // became 0, where the format has no sign
    std::uint64_t not_number = 0; // NaN; became 0
    float largest = 0;            // of those too large

    bool any() const { return too_large + negative + not_number > 0; }
    TexelLosses& operator+=(const TexelLosses& other);
    // One sentence, such as "3 values were larger than rgba16f can hold (up to 1e+06) and became its
    // largest"; empty without losses.
    std::string sentence(TexelFormat format) const;
};

// Appends the texels of the image, row by row from the top, little-endian and without padding.
// Linear light of R, G, B (Y three times where there is Y alone), A or 1 for rgba; of R, G for rg.
// Rounds to nearest: halves and small floats to even, RGBM by the nearest byte under the smallest M that
// fits. Throws Error, which begins with `where`, when the channels are missing.
void append_texels(std::vector<std::uint8_t>& bytes, std::string_view where, const Image& image,
                   TexelFormat format, const RgbmScale& scale, TexelLosses& losses);

// An 8-bit picture R, G, B, A whose A is M. It is marked as sRGB so that write_image puts the bytes into a
// PNG as they are; they are not sRGB-encoded.
Image rgbm_picture(const Image& image, const RgbmScale& scale, TexelLosses& losses);

} // namespace montelux
