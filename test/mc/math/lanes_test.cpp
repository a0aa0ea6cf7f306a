#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <gtest/gtest.h>
#include <limits>
#include <vector>

#include "montelux/mc/integrate/mis.h"
#include "montelux/mc/math/frame.h"
#include "montelux/mc/math/lane_functions.h"
#include "montelux/mc/math/sin_cos.h"
#include "montelux/mc/random/philox.h"
#include "montelux/mc/warp/disk.h"
#include "montelux/mc/warp/hemisphere.h"
#include "montelux/mc/warp/triangle.h"

namespace montelux {
namespace {

// Each lane must have the bits that the same formula has for one float. NaN is as good as NaN.
bool same(float a, float b) {
    return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b) ||
           (std::isnan(a) && std::isnan(b));
}

std::vector<float> odd_values() {
    constexpr float inf = std::numeric_limits<float>::infinity();
    std::vector<float> values{0,        -0.0f,     1,   -1,   0x1p-149f,     -0x1p-140f,
                              0x1p127f, -0x1p127f, inf, -inf, std::nanf(""), 3.1f,
                              -0.7f,    1e-20f};
    std::uint32_t state = 7;
    for (int i = 0; i < 50; ++i) {
        state = state * 747796405u + 2891336453u;
        values.push_back((static_cast<float>(state >> 8) * 0x1p-23f - 1) *
                         std::ldexp(1.0f, static_cast<int>(state % 21) - 10));
    }
    return values;
}

// A formula of W lanes against that of one float.
template <int W>
struct LanesAgainstFloat {
    using T = Lanes<W>;

    // f(T) against f(float), of every odd value.
    template <typename F>
    static void expect_same(F f) {
        const std::vector<float> values = odd_values();
        for (std::size_t at = 0; at < values.size(); ++at) {
            const auto value = [&](int i) { return values[(at + i) % values.size()]; };
            const T found = f(T::from(value));
            for (int i = 0; i < W; ++i) ASSERT_TRUE(same(found[i], f(value(i)))) << value(i);
        }
    }
    // f(T, T) against f(float, float), of every pair.
    template <typename F>
    static void expect_same_of_pairs(F f) {
        const std::vector<float> values = odd_values();
        for (float b : values)
            ASSERT_NO_FATAL_FAILURE(expect_same([&](auto a) { return f(a, decltype(a)(b)); })) << b;
    }
    // f(Vec2<T>) gives a vector or a number; of pairs from [0, 1).
    template <typename F>
    static void expect_same_of_square(F f) {
        for (int at = 0; at < 32 * 32; ++at) {
            auto u = [&](int i) {
                const int k = at + i;
                return Vec2f(static_cast<float>(k % 32) / 32, static_cast<float>(k / 32 % 32) / 32);
            };
            Vec2<T> wide;
            for (int i = 0; i < W; ++i) {
                wide.x.set(i, u(i).x);
                wide.y.set(i, u(i).y);
            }
            const auto found = f(wide);
            for (int i = 0; i < W; ++i) {
                const auto expected = f(u(i));
                ASSERT_TRUE(same(found.x[i], expected.x)) << u(i).x << " " << u(i).y;
                ASSERT_TRUE(same(found.y[i], expected.y)) << u(i).x << " " << u(i).y;
                if constexpr (requires { expected.z; }) {
                    ASSERT_TRUE(same(found.z[i], expected.z)) << u(i).x << " " << u(i).y;
                }
            }
        }
    }
};
template <typename Width>
class LanesOf : public ::testing::Test {};
using Widths = ::testing::Types<std::integral_constant<int, 4>, std::integral_constant<int, 8>,
                                std::integral_constant<int, 16>>;
TYPED_TEST_SUITE(LanesOf, Widths);

TYPED_TEST(LanesOf, ArithmeticIsThatOfOneFloat) {
    using Check = LanesAgainstFloat<TypeParam::value>;
    using std::abs, std::copysign, std::max, std::min, std::sqrt;
    Check::expect_same_of_pairs([](auto a, auto b) { return a + b; });
    Check::expect_same_of_pairs([](auto a, auto b) { return a - b; });
    Check::expect_same_of_pairs([](auto a, auto b) { return a * b; });
    Check::expect_same_of_pairs([](auto a, auto b) { return a / b; });
    Check::expect_same_of_pairs([](auto a, auto b) { return a * b + b; });
    Check::expect_same_of_pairs([](auto a, auto b) { return min(a, b); });
    Check::expect_same_of_pairs([](auto a, auto b) { return max(a, b); });
    Check::expect_same_of_pairs([](auto a, auto b) { return copysign(a, b); });
    Check::expect_same([](auto a) { return -a; });
    Check::expect_same([](auto a) { return abs(a); });
    Check::expect_same([](auto a) { return sqrt(a); });
}

TYPED_TEST(LanesOf, ComparisonsSelectLaneByLane) {
    using Check = LanesAgainstFloat<TypeParam::value>;
    Check::expect_same_of_pairs([](auto a, auto b) { return select(a < b, a, b); });
    Check::expect_same_of_pairs([](auto a, auto b) { return select(a > b, a, b); });
    Check::expect_same_of_pairs([](auto a, auto b) { return select(a <= b, a, b); });
    Check::expect_same_of_pairs([](auto a, auto b) { return select(a >= b, a, b); });
    Check::expect_same_of_pairs([](auto a, auto b) { return select(a == b, a, b); });
    Check::expect_same_of_pairs([](auto a, auto b) { return select(a != b, a, b); });
    Check::expect_same_of_pairs([](auto a, auto b) { return select(!(a < b), a, b); });
    Check::expect_same_of_pairs([](auto a, auto b) { return select((a < b) & (b > 0), a, b); });
    Check::expect_same_of_pairs([](auto a, auto b) { return select((a < b) | (b > 0), a, b); });
}

TYPED_TEST(LanesOf, AnyAndAllAskEveryLane) {
    constexpr int W = TypeParam::value;
    EXPECT_FALSE(any(LaneMask<W>(false)));
    EXPECT_TRUE(all(LaneMask<W>(true)));
    for (int i = 0; i < W; ++i) {
        LaneMask<W> one(false);
        one.set(i, true);
        EXPECT_TRUE(any(one) && !all(one) && one[i]);
        EXPECT_TRUE(any(!one) && !all(!one));
    }
    for (int n = 0; n <= W; ++n)
        for (int i = 0; i < W; ++i) EXPECT_EQ(LaneMask<W>::first(n)[i], i < n);
}

TYPED_TEST(LanesOf, BitsAreThoseOfOneInteger) {
    constexpr int W = TypeParam::value;
    std::vector<float> table(257);
    for (std::size_t i = 0; i < table.size(); ++i) table[i] = std::sqrt(static_cast<float>(i));
    std::uint32_t state = 1;
    for (int round = 0; round < 200; ++round) {
        LaneBits<W> a, b;
        for (int i = 0; i < W; ++i) {
            a.set(i, state = state * 747796405u + 2891336453u);
            b.set(i, state = state * 747796405u + 2891336453u);
        }
        const std::uint32_t factor = b[0];
        const auto product = wide_product(a, factor);
        const Lanes<W> number = to_float(a >> 8), looked_up = gather(table.data(), a & 0xffu);
        const LaneBits<W> whole = to_bits(number), mixed = ((a + b) * a ^ (b << 3)) | (a & b);
        const LaneBits<W> chosen = select(a == b, a, b);
        for (int i = 0; i < W; ++i) {
            const auto expected = wide_product(a[i], factor);
            ASSERT_EQ(product.high[i], expected.high);
            ASSERT_EQ(product.low[i], expected.low);
            ASSERT_EQ(number[i], static_cast<float>(a[i] >> 8));
            ASSERT_EQ(whole[i], a[i] >> 8);
            ASSERT_EQ(looked_up[i], table[a[i] & 0xffu]);
            ASSERT_EQ(mixed[i], ((a[i] + b[i]) * a[i] ^ (b[i] << 3)) | (a[i] & b[i]));
            ASSERT_EQ(chosen[i], b[i]);
        }
    }
}

TYPED_TEST(LanesOf, PhiloxGivesTheSameWords) {
    constexpr int W = TypeParam::value;
    using Bits = LaneBits<W>;
    std::array<Bits, 4> counter;
    std::array<Bits, 2> key;
    std::uint32_t state = 3;
    for (int i = 0; i < W; ++i) {
        for (Bits& c : counter) c.set(i, state = state * 747796405u + 2891336453u);
        for (Bits& k : key) k.set(i, state = state * 747796405u + 2891336453u);
    }
    const std::array<Bits, 4> found = philox4x32<7, Bits>(counter, key);
    for (int i = 0; i < W; ++i) {
        const auto expected = philox4x32<>({counter[0][i], counter[1][i], counter[2][i], counter[3][i]},
                                           {key[0][i], key[1][i]});
        for (int k = 0; k < 4; ++k) EXPECT_EQ(found[k][i], expected[k]);
    }
}

TYPED_TEST(LanesOf, WarpsGiveTheSameBits) {
    using Check = LanesAgainstFloat<TypeParam::value>;
    Check::expect_same_of_square([](auto u) { return sample_uniform_disk_concentric(u); });
    Check::expect_same_of_square([](auto u) { return sample_cosine_hemisphere(u); });
    Check::expect_same_of_square([](auto u) { return sample_uniform_triangle(u); });
    Check::expect_same([](auto c) { return cosine_hemisphere_pdf(c); });
    Check::expect_same([](auto x) { return sin_cos_octant(x).sine + sin_cos_octant(x).cosine; });
}

TYPED_TEST(LanesOf, FramesAndVectorsGiveTheSameBits) {
    using Check = LanesAgainstFloat<TypeParam::value>;
    const auto normal = [](auto u) { return sample_cosine_hemisphere(u); };
    Check::expect_same_of_square([&](auto u) {
        using T = decltype(u.x);
        const Vec3<T> n = normal(u);
        const auto f = FrameOf<T>::from_normal(n);
        return f.to_world(f.to_local(Vec3<T>(u.x, 0.3f, u.y)) + cross(f.s, f.t));
    });
    // Some tangents are parallel to the normal.
    Check::expect_same_of_square([&](auto u) {
        using T = decltype(u.x);
        const Vec3<T> n = normal(u), x(1, 0, 0);
        const auto f = FrameOf<T>::from_normal_and_tangent(n, select(u.x > u.y, n, x));
        return f.s - 2 * f.t;
    });
    Check::expect_same_of_square([&](auto u) {
        using T = decltype(u.x);
        const Vec3<T> n = normal(u), v(u.y, T(-0.5f), u.x);
        return min(abs(v), max(n, v)) * max_component(n) + normalize(v) * abs_dot(n, v);
    });
}

TYPED_TEST(LanesOf, WeightsOfMisAreTheSame) {
    using Check = LanesAgainstFloat<TypeParam::value>;
    Check::expect_same_of_pairs([](auto f, auto g) { return balance_heuristic(1, f, 1, g); });
    Check::expect_same_of_pairs([](auto f, auto g) { return power_heuristic(1, f, 2, g); });
}

TEST(SinCosOctant, IsWithinAFewRoundingsOfSineAndCosine) {
    for (int i = -1000; i <= 1000; ++i) {
        const float x = 0.7853982f * static_cast<float>(i) / 1000;
        const auto [sine, cosine] = sin_cos_octant(x);
        EXPECT_NEAR(double(sine), std::sin(double(x)), 1e-7) << x;
        EXPECT_NEAR(double(cosine), std::cos(double(x)), 1e-7) << x;
    }
}

} // namespace
} // namespace montelux
