#include <gtest/gtest.h>
#include <vector>

#include "montelux/mc/integrate/adaptive/balanced_points.h"

namespace montelux {
namespace {

TEST(BalancedPoints, ArePowersOfTwoAndThreeHalvesOfThem) {
    std::vector<std::uint64_t> found;
    for (std::uint64_t n = 1; n < 100; n = next_balanced(n)) found.push_back(n);
    EXPECT_EQ(found, (std::vector<std::uint64_t>{1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96}));
    for (std::uint64_t n = 2; n < 1000; ++n) {
        EXPECT_GT(next_balanced(n), n);
        EXPECT_LE(last_balanced(n), n);
        EXPECT_GT(next_balanced(last_balanced(n)), n);
    }
}

} // namespace
} // namespace montelux
