// UnguidedSquare on paths whose squares are computed by hand.
#include <gtest/gtest.h>
#include <limits>

#include "montelux/transport/guiding/unguided_square.h"

namespace montelux {
namespace {

TEST(UnguidedSquare, LightIsWeightedByTheDensitiesBeforeIt) {
    UnguidedSquare s;
    s.arrive(1);           // emission 1
    s.sample_light(2);     // its MIS weight doubles without the guide
    s.scatter(4);          // does not concern the light sample
    s.go_on(1, 100, true); // Russian roulette certainly survives
    s.arrive(1.5);         // the light sample: 0.5, counts as 1
    s.meet_light(0.25);    // more without the guide
    // 1, 1 and 1, the last with a density 4 times as high: (1 + 4) + (1 + 2) + 4.
    EXPECT_DOUBLE_EQ(s.square(2.25), 12);
    s.clear();
    EXPECT_DOUBLE_EQ(s.square(3), 9);
}

TEST(UnguidedSquare, RouletteWithoutTheGuideReplacesThatWithIt) {
    for (const bool plays : {false, true}) {
        UnguidedSquare s;
        s.survive(0.5);
        s.go_on(0, 0.4, plays); // throughput without the guide: 0.4 * 0.5
        EXPECT_DOUBLE_EQ(s.square(2), 4 * (plays ? 0.5 / 0.2 : 0.5));
    }
}

// A path that cannot exist without the guide counts nothing; a ratio that overflows does not make the sum NaN.
TEST(UnguidedSquare, ExtremeRatios) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    UnguidedSquare never, rare, nothing;
    never.scatter(0);
    EXPECT_EQ(never.square(2), 0);
    rare.scatter(infinity);
    EXPECT_EQ(rare.square(2), 4);
    nothing.arrive(2);
    nothing.scatter(infinity);
    EXPECT_EQ(nothing.square(2), 4);
}

} // namespace
} // namespace montelux
