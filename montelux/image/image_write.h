// Writing pictures: EXR, PNG, JPEG, Radiance HDR and PFM files that appear complete or not at all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "montelux/image/image.h"
#include "montelux/image/tone_curve.h"

namespace montelux {

enum class ExrCompression { uncompressed, rle, zips, zip, piz };

struct WriteOptions {
    ExrCompression exr_compression = ExrCompression::zip;
    // EXR: channels of a 32-bit image that are written as 16-bit floats, rounded to nearest even; finite values
    // beyond 65504 become that (half_overflows).
    std::vector<std::string> exr_half{};
    // PNG: 8 or 16.
    int png_bits = 8;
    // JPEG: 1 to 100, libjpeg's scale; colours keep their full resolution.
    int jpeg_quality = 95;
    // PNG and JPEG.
    ToneCurve tone{};
};

// The format is that of the extension: .exr, .png, .jpg (.jpeg), .hdr or .pfm.
// EXR: all channels and attributes; 16-bit float images as such, all others as 32-bit linear float, but for
// WriteOptions::exr_half.
// PNG, JPEG, HDR, PFM: the colour channels R, G, B (or Y; R, G, B and A for PNG) and nothing else. An 8-bit or 16-bit
// sRGB image goes into a PNG of as many bits, or a JPEG, uncurved when the exposure is 0 and the tone curve sRGB. HDR clamps negative values and NaN to 0 and
// has 8-bit mantissas; PFM keeps every bit. Throws Error when the file cannot be written; then nothing is
// left behind and an older file is untouched.
void write_image(const std::filesystem::path& path, const Image& image, const WriteOptions& options = {});

// Finite values of these channels that 16-bit floats cannot hold. Names without a channel are ignored.
std::uint64_t half_overflows(const Image& image, const std::vector<std::string>& channels);

// Whether WriteOptions::tone matters for a file of this name. Throws Error on an unknown extension.
bool takes_tone_curve(const std::filesystem::path& path);

// Throws the Error that write_image would meet for a reason known now: an unknown extension, a missing or
// read-only folder, a path that is a folder. A renderer calls it before it spends hours.
void check_writable(const std::filesystem::path& path);

} // namespace montelux
