// How often the truth lies within the errors that were reported: what must hold for honest standard errors.
#pragma once

#include <gtest/gtest.h>

#include "montelux/mc/math/special.h"

namespace montelux {

// Of `judged` results with independent seeds, those whose truth lies within one standard error, and within
// two. The shares must lie in 60-80 % and 90-99 %: the normal law has 68 and 95 %, errors from few replicates
// a little less. If the true shares do, the check fails with a probability of 1e-6 at most.
inline void expect_honest_errors(int within_one, int within_two, int judged) {
    constexpr double least = 1e-6 / 4;
    EXPECT_GT(binomial_cdf(within_one, judged, 0.60), least)
        << "too few within one standard error: " << within_one << " of " << judged;
    EXPECT_GT(binomial_upper(within_one, judged, 0.80), least)
        << "too many within one standard error: " << within_one << " of " << judged;
    EXPECT_GT(binomial_cdf(within_two, judged, 0.90), least)
        << "too few within two standard errors: " << within_two << " of " << judged;
    EXPECT_GT(binomial_upper(within_two, judged, 0.99), least)
        << "too many within two standard errors: " << within_two << " of " << judged;
}

} // namespace montelux
