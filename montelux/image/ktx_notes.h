// Key/value data of KTX files, versions 1 and 2; internal to the image room.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "montelux/image/texel_format.h"

namespace montelux {

// The notes of the options and those that the writers add. Throws Error on a key that is empty, is reserved,
// or holds a zero byte, and on a text with one.
std::map<std::string, std::string> ktx_notes(std::string_view where, const TextureOptions& options,
                                             const std::string& orientation);

// Each as length, key, 0, text, 0 and zeros up to a multiple of 4; sorted by key.
std::vector<std::uint8_t> ktx_key_values(const std::map<std::string, std::string>& notes);

} // namespace montelux
