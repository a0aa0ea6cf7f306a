// Writing pictures: EXR, PNG, Radiance HDR and PFM files that appear complete or not at all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "montelux/image/image.h"

namespace montelux {

enum class ExrCompression { uncompressed, rle, zips, zip, piz };

struct WriteOptions {
    ExrCompression exr_compression = ExrCompression::zip;
    // EXR: channels of a 32-bit image that are written as 16-bit floats, rounded to nearest even; finite values
    // beyond 65504 become that (half_overflows).
    std::vector<std::string> exr_half{};
    // PNG: 8 or 16.
    int png_bits = 8;
    // PNG: light is multiplied by 2^exposure before the sRGB curve (tone_curve.h).
    float exposure = 0;
};

// The format is that of the extension: .exr, .png, .hdr or .pfm.
// EXR: all channels and attributes; 16-bit float images as such, all others as 32-bit linear float, but for
// WriteOptions::exr_half.
// PNG, HDR, PFM: the colour channels R, G, B (or Y; R, G, B and A for PNG) and nothing else. An 8-bit sRGB
// image goes into an 8-bit PNG unchanged when the exposure is 0. HDR clamps negative values and NaN to 0 and
// has 8-bit mantissas; PFM keeps every bit. Throws Error when the file cannot be written; then nothing is
// left behind and an older file is untouched.
void write_image(const std::filesystem::path& path, const Image& image, const WriteOptions& options = {});

// Finite values of these channels that 16-bit floats cannot hold. Names without a channel are ignored.
std::uint64_t half_overflows(const Image& image, const std::vector<std::string>& channels);

// Throws the Error that write_image would meet for a reason known now: an unknown extension, a missing or
// read-only folder, a path that is a folder. A renderer calls it before it spends hours.
void check_writable(const std::filesystem::path& path);

} // namespace montelux
