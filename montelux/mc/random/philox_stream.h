// A stream of independent uniform numbers, for draws of unknown number or without a point set.
#pragma once

#include <array>
#include <cstdint>

#include "montelux/mc/math/vec.h"
#include "montelux/mc/random/hash.h"
#include "montelux/mc/random/philox.h"
#include "montelux/mc/random/uniform_bits.h"

namespace montelux {

// Numbers in [0, 1), a pure function of key and counter. Streams that differ in any word of either never
// share a block: up to 2^34 numbers from each.
class PhiloxStream {
  public:
    explicit PhiloxStream(std::uint64_t key, std::array<std::uint32_t, 3> counter = {})
        : counter_{0, counter[0], counter[1], counter[2]}, key_{static_cast<std::uint32_t>(key),
                                                                static_cast<std::uint32_t>(key >> 32)} {}

    // A stream of its own for a nested estimate (a random walk inside a layered surface, say), so that it
    // takes one pair of numbers from its parent however long it runs. A parent may tell such pairs from numbers
    // that a sample varies with smoothly.
    template <typename Stream>
    static PhiloxStream split(Stream& parent) {
        if constexpr (requires { parent.next_key(); })
            return of_pair(parent.next_key());
        else
            return of_pair(parent.next_2d());
    }
    // The same for a pair that was drawn already.
    static PhiloxStream of_pair(Vec2f u) {
        const auto high = static_cast<std::uint64_t>(u.x * 0x1p24f);
        const auto low = static_cast<std::uint64_t>(u.y * 0x1p24f);
        return PhiloxStream(hash_key((high << 24) | low), {0, 0, 1});
    }

    std::uint32_t next_bits() {
        const std::uint32_t at = used_++ & 3;
        if (at == 0) {
            block_ = philox4x32<>(counter_, key_);
            ++counter_[0];
        }
        return block_[at];
    }
    float next_1d() { return unit_float(next_bits()); }
    Vec2f next_2d() {
        const float x = next_1d();
        const float y = next_1d();
        return {x, y};
    }
    // 53 random bits.
    double next_double() {
        const std::uint64_t high = next_bits();
        const std::uint64_t low = next_bits();
        return unit_double((high << 32) | low);
    }

  private:
    std::array<std::uint32_t, 4> counter_;
    std::array<std::uint32_t, 2> key_;
    std::array<std::uint32_t, 4> block_;
    std::uint32_t used_ = 0;
};

} // namespace montelux
