// Formulas of scenes for many paths at a time: each lane has the bits of one path.
#include <array>
#include <bit>
#include <cstdint>
#include <gtest/gtest.h>

#include "montelux/mc/math/lane_functions.h"
#include "montelux/mc/math/vec_lanes.h"
#include "montelux/mc/random/sample_stream.h"
#include "montelux/scene/bsdf/diffuse.h"
#include "montelux/scene/shape/surface_point.h"
#include "montelux/spectrum/spectrum_lanes.h"

namespace montelux {
namespace {

constexpr int W = 8;
using T = Lanes<W>;

SampleStream numbers(int seed) {
    return {SamplerSettings{SamplerKind::independent, static_cast<std::uint64_t>(seed), 64, 1}, 1, 2, 3};
}
Vec3f any_vector(SampleStream& stream) {
    const Vec2f u = stream.next_2d();
    return {4 * u.x - 2, 4 * u.y - 2, 4 * stream.next_1d() - 2};
}
bool same_bits(Vec3f a, Vec3f b) {
    return std::bit_cast<std::array<std::uint32_t, 3>>(a) == std::bit_cast<std::array<std::uint32_t, 3>>(b);
}

TEST(LaneFormulas, PointsOfTriangles) {
    struct Corner {
        Vec3f p0, p1, p2, normal;
        float b1, b2;
        bool flipped;
    };
    for (int round = 0; round < 200; ++round) {
        SampleStream stream = numbers(round);
        std::array<Corner, W> corners;
        Vec3<T> p0, p1, p2, normal;
        T b1, b2;
        LaneMask<W> flipped(false);
        for (int i = 0; i < W; ++i) {
            Corner& c = corners[static_cast<std::size_t>(i)];
            c.p0 = any_vector(stream);
            c.p1 = any_vector(stream);
            c.p2 = i == 0 ? c.p1 : any_vector(stream); // without area
            c.normal = i % 2 == 0 ? Vec3f{} : any_vector(stream);
            c.b1 = stream.next_1d() / 2;
            c.b2 = stream.next_1d() / 2;
            c.flipped = i % 3 == 0;
            set_lane(p0, i, c.p0);
            set_lane(p1, i, c.p1);
            set_lane(p2, i, c.p2);
            set_lane(normal, i, c.normal);
            b1.set(i, c.b1);
            b2.set(i, c.b2);
            flipped.set(i, c.flipped);
        }
        const TrianglePoint<T> found = triangle_point(p0, p1, p2, b1, b2, flipped, normal);
        const Vec3<T> start = offset_origin(found.p, found.ng, found.error, p0);
        for (int i = 1; i < W; ++i) {
            const Corner& c = corners[static_cast<std::size_t>(i)];
            const auto expected = triangle_point(c.p0, c.p1, c.p2, c.b1, c.b2, c.flipped, c.normal);
            ASSERT_TRUE(same_bits(lane_of(found.p, i), expected.p));
            ASSERT_TRUE(same_bits(lane_of(found.ng, i), expected.ng));
            ASSERT_TRUE(same_bits(lane_of(found.ns, i), expected.ns));
            ASSERT_EQ(found.error[i], expected.error);
            ASSERT_TRUE(
                same_bits(lane_of(start, i), offset_origin(expected.p, expected.ng, expected.error, c.p0)));
        }
        // Without area there is no normal, in any number type.
        ASSERT_TRUE(std::isnan(found.ng.x[0]));
        ASSERT_TRUE(std::isnan(triangle_point(corners[0].p0, corners[0].p1, corners[0].p2, corners[0].b1,
                                              corners[0].b2, corners[0].flipped, corners[0].normal)
                                   .ng.x));
    }
}

// Gives the same pair whenever it is asked.
template <Number N>
struct OnePair {
    Vec2<N> u;
    Vec2<N> next_2d() const { return u; }
};

TEST(LaneFormulas, DiffuseBsdf) {
    for (int round = 0; round < 200; ++round) {
        SampleStream stream = numbers(round);
        std::array<SampledSpectrum, W> reflectance;
        std::array<Vec3f, W> wo, wi;
        std::array<Vec2f, W> u;
        DiffuseBsdfOf<T> wide;
        Vec3<T> wide_wo, wide_wi;
        OnePair<T> pairs;
        for (std::size_t i = 0; i < W; ++i) {
            const int k = static_cast<int>(i);
            const Vec3f r = any_vector(stream);
            reflectance[i] = {r.x, r.y, r.z, r.x * r.y};
            wo[i] = normalize(any_vector(stream));
            wi[i] = normalize(any_vector(stream));
            u[i] = stream.next_2d();
            wide.reflectance.set_lane(k, reflectance[i]);
            set_lane(wide_wo, k, wo[i]);
            set_lane(wide_wi, k, wi[i]);
            pairs.u.x.set(k, u[i].x);
            pairs.u.y.set(k, u[i].y);
        }
        const auto evaluated = wide.evaluate(wide_wo, wide_wi, TransportMode::radiance, pairs);
        const auto sampled = wide.sample(wide_wo, TransportMode::radiance, pairs);
        for (std::size_t i = 0; i < W; ++i) {
            const int k = static_cast<int>(i);
            const DiffuseBsdf one{reflectance[i]};
            OnePair<float> pair{u[i]};
            const BsdfEvaluation e = one.evaluate(wo[i], wi[i], TransportMode::radiance, pair);
            ASSERT_EQ(evaluated.pdf[k], e.pdf);
            for (int s = 0; s < spectrum_samples; ++s) ASSERT_EQ(evaluated.f[s][k], e.f[s]);
            const auto expected = one.sample(wo[i], TransportMode::radiance, pair);
            ASSERT_EQ(sampled.found[k], expected.has_value());
            if (!expected) continue;
            ASSERT_TRUE(same_bits(lane_of(sampled.sample.wi, k), expected->wi));
            ASSERT_EQ(sampled.sample.pdf[k], expected->pdf);
            for (int s = 0; s < spectrum_samples; ++s)
                ASSERT_EQ(sampled.sample.weight[s][k], expected->weight[s]);
        }
    }
}

TEST(LaneFormulas, Spectra) {
    SampleStream stream = numbers(1);
    SpectrumLanes<W> a, b;
    for (int i = 0; i < W; ++i) {
        const Vec3f r = any_vector(stream), q = any_vector(stream);
        a.set_lane(i, i == 0 ? SampledSpectrum(0) : SampledSpectrum(r.x, r.y, r.z, q.x));
        b.set_lane(i, {q.y, q.z, r.x, r.y});
    }
    const SpectrumLanes<W> mixed = (a * b + a / T(3)) - b * T(0.25f), inside = clamp(a, -0.5f, 0.5f);
    const LaneMask<W> black = is_black(a);
    for (int i = 0; i < W; ++i) {
        const SampledSpectrum p = a.lane(i), q = b.lane(i), m = (p * q + p / 3) - q * 0.25f,
                              c = clamp(p, -0.5f, 0.5f);
        EXPECT_EQ(black[i], is_black(p));
        EXPECT_EQ(max_value(a)[i], max_value(p));
        for (int s = 0; s < spectrum_samples; ++s) {
            EXPECT_EQ(mixed[s][i], m[s]);
            EXPECT_EQ(inside[s][i], c[s]);
        }
    }
}

} // namespace
} // namespace montelux
