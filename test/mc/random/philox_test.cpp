#include "uniformity.h"
#include <array>
#include <cstdint>
#include <gtest/gtest.h>
#include <set>
#include <vector>

#include "montelux/mc/random/permutation.h"
#include "montelux/mc/random/philox.h"
#include "montelux/mc/random/philox_stream.h"

namespace montelux {
namespace {

// Known answers: Random123, kat_vectors.
TEST(Philox, KnownAnswers) {
    using Block = std::array<std::uint32_t, 4>;
    constexpr std::uint32_t ones = 0xffffffffu;
    constexpr Block pi_counter = {0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344};
    constexpr std::array<std::uint32_t, 2> pi_key = {0xa4093822, 0x299f31d0};
    EXPECT_EQ(philox4x32<10>({0, 0, 0, 0}, {0, 0}), (Block{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
    EXPECT_EQ(philox4x32<10>({ones, ones, ones, ones}, {ones, ones}),
              (Block{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
    EXPECT_EQ(philox4x32<10>(pi_counter, pi_key), (Block{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
    EXPECT_EQ(philox4x32<7>({0, 0, 0, 0}, {0, 0}), (Block{0x5f6fb709, 0x0d893f64, 0x4f121f81, 0x4f730a48}));
    EXPECT_EQ(philox4x32<7>({ones, ones, ones, ones}, {ones, ones}),
              (Block{0x5207ddc2, 0x45165e59, 0x4d8ee751, 0x8c52f662}));
    EXPECT_EQ(philox4x32<7>(pi_counter, pi_key), (Block{0x4dfccaba, 0x190a87f0, 0xc47362ba, 0xb6b5242a}));
}

TEST(PhiloxStream, PairsAreUniformAndStreamsDiffer) {
    PhiloxStream stream(1), other(2);
    std::vector<Vec2d> along, across;
    for (int i = 0; i < 100000; ++i) {
        const Vec2f pair = stream.next_2d();
        along.emplace_back(pair);
        across.emplace_back(pair.x, other.next_double());
    }
    EXPECT_GT(testing::uniform_square_p_value(along, 32, 32), 1e-9);
    EXPECT_GT(testing::uniform_square_p_value(across, 32, 32), 1e-9);
}

TEST(PhiloxStream, SplitStreamsOfOneParentDiffer) {
    PhiloxStream parent(3);
    PhiloxStream first = PhiloxStream::split(parent);
    PhiloxStream second = PhiloxStream::split(parent);
    EXPECT_NE(first.next_bits(), second.next_bits());
}

TEST(Permute, IsABijectionWithUniformImages) {
    for (std::uint32_t n : {1u, 2u, 3u, 7u, 64u, 100u}) {
        std::set<std::uint32_t> images;
        for (std::uint32_t i = 0; i < n; ++i) images.insert(permute(i, n, 0x123456789abcdefu));
        EXPECT_EQ(images.size(), n);
        EXPECT_LT(*images.rbegin(), n);
    }
    // Images of two elements of ten: all 90 ordered pairs alike. False alarm 1e-9.
    std::vector<double> observed(100, 0.0), expected(100, 45000 / 90.0);
    for (int i = 0; i < 10; ++i) expected[11 * i] = 0;
    for (std::uint32_t s = 0; s < 45000; ++s) {
        const std::uint64_t key = mix64(s);
        ++observed[permute(3, 10, key) * 10 + permute(4, 10, key)];
    }
    EXPECT_GT(chi_squared_test(observed, expected).p_value, 1e-9);
}

} // namespace
} // namespace montelux
