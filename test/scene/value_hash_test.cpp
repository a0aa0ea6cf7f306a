// ValueHash: every byte counts, however the values are cut into pieces.
#include <cstdint>
#include <gtest/gtest.h>
#include <vector>

#include "montelux/scene/value_hash.h"

namespace montelux {
namespace {

// Pieces are gathered before they are hashed: lengths around the size of the buffer.
TEST(ValueHash, EveryByteCountsAtAnyLength) {
    for (const std::size_t size : {0, 1, 4095, 4096, 4097, 10000}) {
        std::vector<std::uint8_t> bytes(size, 7);
        auto hash = [&](std::size_t first) {
            ValueHash h;
            h.add(1.5f);
            h.add_bytes(bytes.data(), first);
            h.add_bytes(bytes.data() + first, size - first);
            h.add(true);
            return h.value();
        };
        const ContentDigest before = hash(size);
        EXPECT_EQ(hash(size), before);
        for (std::size_t at : {std::size_t{0}, size / 2, size - 1}) {
            if (at >= size) continue;
            bytes[at] ^= 1;
            EXPECT_NE(hash(size), before) << size << ' ' << at;
            bytes[at] ^= 1;
        }
        bytes.push_back(7);
        ValueHash longer;
        longer.add(1.5f);
        longer.add_bytes(bytes.data(), bytes.size());
        longer.add(true);
        EXPECT_NE(longer.value(), before) << size;
    }
}

} // namespace
} // namespace montelux
