// What a texture file for graphics processors says of itself: KTX 2, KTX 1 and DDS. The texels are not read.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace montelux {

struct TextureHeader {
    std::string container;                          // "KTX 2.0"
    std::string format;                             // of the texels, by the container's name or number
    std::string supercompression{};                 // empty: none
    std::uint32_t width = 0, height = 0, depth = 0; // 0: no such dimension
    std::uint32_t levels = 1, layers = 1, faces = 1;
    std::vector<std::uint64_t> level_bytes{};   // of KTX 2, level 0 first
    std::map<std::string, std::string> notes{}; // keys and texts of KTX files
};

// Empty for other files. Sizes and offsets are checked against the file. Throws Error, with `name`.
std::optional<TextureHeader> texture_header(std::span<const std::uint8_t> bytes, const std::string& name);

} // namespace montelux
