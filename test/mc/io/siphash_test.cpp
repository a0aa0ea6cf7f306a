#include <gtest/gtest.h>
#include <numeric>
#include <vector>

#include "montelux/mc/io/siphash.h"

namespace montelux {
namespace {

constexpr std::uint64_t key0 = 0x0706050403020100, key1 = 0x0f0e0d0c0b0a0908;

std::array<std::uint64_t, 2> digest(std::span<const std::uint8_t> bytes) {
    SipHash128 hash(key0, key1);
    hash.add(bytes);
    return hash.digest();
}

// vectors_sip128 of the authors' reference code: nothing, and the byte 0, under the key 00 01 ... 0f.
TEST(SipHash128, GivesThePublishedValues) {
    using Digest = std::array<std::uint64_t, 2>;
    EXPECT_EQ(digest({}), (Digest{0xe6a825ba047f81a3, 0x930255c71472f66d}));
    const std::vector<std::uint8_t> zero{0};
    EXPECT_EQ(digest(zero), (Digest{0x44af996bd8c187da, 0x45fc229b11597634}));
}

TEST(SipHash128, DoesNotDependOnThePieces) {
    std::vector<std::uint8_t> bytes(100);
    std::iota(bytes.begin(), bytes.end(), std::uint8_t{3});
    const auto whole = digest(bytes);
    for (std::size_t a = 0; a <= bytes.size(); ++a)
        for (std::size_t b = a; b <= bytes.size(); ++b) {
            const std::span<const std::uint8_t> all(bytes);
            SipHash128 hash(key0, key1);
            hash.add(all.first(a));
            hash.add(all.subspan(a, b - a));
            hash.add(all.subspan(b));
            ASSERT_EQ(hash.digest(), whole) << a << ' ' << b;
        }
}

} // namespace
} // namespace montelux
