// WorkBudget: repeated work keeps to its share.
#include <gtest/gtest.h>

#include "montelux/view/work_budget.h"

namespace montelux::testing {
namespace {

TEST(WorkBudget, KeepsToItsShare) {
    WorkBudget budget(0.01);
    EXPECT_TRUE(budget.allows_work(0));
    double spent = 0;
    for (int i = 10000; i < 110000; ++i) {
        const double now = 1e-3 * i;
        if (!budget.allows_work(now)) continue;
        budget.spend(0.005, now);
        spent += 0.005;
    }
    EXPECT_NEAR(spent, 0.01 * 100, 0.006);
}

} // namespace
} // namespace montelux::testing
