// The outer structure of an OpenEXR file, checked before any library sees it.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "montelux/image/exr_header.h"
#include "montelux/image/placement.h"

namespace montelux {

// Layout of the first part, as parse_exr finds it.
struct ExrLayout {
    int min_x = 0, min_y = 0; // of the data window
    int width = 0, height = 0;
    PixelWindow display;
    std::vector<ExrChannel> channels;
    Attributes attributes;
};

// Follows "Technical Introduction to OpenEXR" and "OpenEXR File Layout" (openexr.com): headers, chunk offset
// tables and, for the first part, the frame of every chunk. Refuses what is damaged, incomplete, deep,
// subsampled or out of proportion to the file with an Error; changes `bytes` as parse_exr_headers does.
ExrLayout parse_exr(std::span<std::uint8_t> bytes, const std::string& name, const ReadOptions& options);

} // namespace montelux
