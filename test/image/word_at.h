// The little-endian 32-bit number at a place in a file.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>

namespace montelux::testing {

inline std::uint32_t word_at(const std::string& bytes, std::size_t at) {
    std::uint32_t v = 0;
    // The last half has no four bytes left.
    std::memcpy(&v, bytes.data() + at, std::min(sizeof v, bytes.size() - at));
    return v;
}

} // namespace montelux::testing
