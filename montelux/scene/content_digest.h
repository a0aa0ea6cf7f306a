// ContentDigest: a 128-bit hash of values.
#pragma once

#include <cstdint>

namespace montelux {

struct ContentDigest {
    std::uint64_t high = 0, low = 0;
    bool operator==(const ContentDigest&) const = default;
    // For ordered containers.
    bool operator<(const ContentDigest& other) const {
        return high != other.high ? high < other.high : low < other.low;
    }
};

} // namespace montelux
