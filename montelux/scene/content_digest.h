// ContentDigest: a 128-bit hash of values.
#pragma once

#include <compare>
#include <cstdint>

namespace montelux {

struct ContentDigest {
    std::uint64_t high = 0, low = 0;
    auto operator<=>(const ContentDigest&) const = default;
};

} // namespace montelux
