#include "sampler_kinds.h"
#include <algorithm>
#include <array>
#include <gtest/gtest.h>
#include <vector>

#include "montelux/mc/random/lane_stream.h"

namespace montelux {
namespace {

constexpr int lanes = 8;
class LaneStreamOf : public ::testing::TestWithParam<SamplerKind> {};
INSTANTIATE_TEST_SUITE_P(Kinds, LaneStreamOf, ::testing::ValuesIn(testing::all_kinds), testing::kind_name);

std::vector<SampleStream> streams(SamplerKind kind, int count) {
    std::vector<SampleStream> r;
    for (int i = 0; i < count; ++i) {
        const SamplerSettings settings{kind, 11, 64, 1};
        SampleStream& s = r.emplace_back(settings, 3 + i % 2, 5, static_cast<std::uint64_t>(i));
        if (kind == SamplerKind::independent && i % 2 == 1) s = s.branch(7); // with a key of its own
        for (int k = 0; k < i; ++k) s.next_1d(); // as paths that have taken different turns
    }
    return r;
}

// Every stream goes on by itself as if it had never been drawn from with others, and the numbers are its own;
// lanes that are not active draw nothing.
TEST_P(LaneStreamOf, EachLaneHasTheNumbersOfItsStream) {
    for (int count : {1, 3, lanes}) {
        std::vector<SampleStream> together = streams(GetParam(), count), alone = together;
        std::array<SampleStream*, lanes> pointers;
        for (int i = 0; i < lanes; ++i) pointers[i] = &together[std::min(i, count - 1)];
        LaneStream<lanes> wide(pointers, count);
        const auto expect = [&](int draw, auto&& found, auto&& expected) {
            for (int i = 0; i < count; ++i) {
                if (!wide.active[i]) continue;
                ASSERT_EQ(found(i), expected(alone[i])) << "lane " << i << " draw " << draw;
            }
        };
        const LaneMask<lanes> everyone = wide.active;
        for (int draw = 0; draw < 40; ++draw) {
            wide.active = everyone;
            for (int i = 0; i < count; ++i)
                if ((draw * 7 + i) % 5 == 0) wide.active.set(i, false);
            if (draw % 3 == 0) {
                const auto u = wide.next_2d();
                ASSERT_NO_FATAL_FAILURE(expect(
                    draw, [&](int i) { return std::pair(u.x[i], u.y[i]); },
                    [](SampleStream& s) {
                        const Vec2f pair = s.next_2d();
                        return std::pair(pair.x, pair.y);
                    }));
            } else if (draw % 3 == 1) {
                const auto u = wide.next_1d();
                ASSERT_NO_FATAL_FAILURE(expect(
                    draw, [&](int i) { return u[i]; }, [](SampleStream& s) { return s.next_1d(); }));
            } else {
                const auto refined = wide.refined(Lanes<lanes>(0.25f));
                ASSERT_NO_FATAL_FAILURE(expect(
                    draw, [&](int i) { return refined[i]; },
                    [](SampleStream& s) { return s.refined(0.25f); }));
            }
        }
        wide.store();
        for (int i = 0; i < count; ++i)
            for (int draw = 0; draw < 9; ++draw) ASSERT_EQ(together[i].next_1d(), alone[i].next_1d());
    }
}

} // namespace
} // namespace montelux
