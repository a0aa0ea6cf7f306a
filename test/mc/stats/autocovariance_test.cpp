#include <cmath>
#include <gtest/gtest.h>

#include "montelux/mc/stats/autocovariance.h"

namespace montelux {
namespace {

TEST(Autocovariance, IsTheSumOfProductsAtEveryLag) {
    for (std::size_t n : {1u, 2u, 3u, 64u, 1000u}) {
        std::vector<double> x;
        for (std::size_t i = 0; i < n; ++i) x.push_back(100 + std::sin(static_cast<double>(i * i)));
        double mean = 0;
        for (double v : x) mean += v / static_cast<double>(n);
        const std::vector<double> found = autocovariance(x);
        ASSERT_EQ(found.size(), n);
        for (std::size_t lag = 0; lag < n; ++lag) {
            double sum = 0;
            for (std::size_t i = 0; i + lag < n; ++i) sum += (x[i] - mean) * (x[i + lag] - mean);
            EXPECT_NEAR(found[lag], sum / static_cast<double>(n), 1e-12) << n << " " << lag;
        }
    }
    EXPECT_TRUE(autocovariance({}).empty());
}

} // namespace
} // namespace montelux
