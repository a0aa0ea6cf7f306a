// ContentDigest: a 128-bit hash that identifies what a scene was read from.
#pragma once

#include <cstdint>

namespace montelux {

// 0 for a scene that was not read from files.
struct ContentDigest {
    std::uint64_t high = 0, low = 0;
    bool operator==(const ContentDigest&) const = default;
};

} // namespace montelux
