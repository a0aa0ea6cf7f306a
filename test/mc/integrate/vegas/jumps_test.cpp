// Jumps of functions of one variable, of which most boxes of Vegas see one side alone.
#include "test/mc/integrate/integrate_testing.h"
#include <cmath>
#include <gtest/gtest.h>

#include "montelux/mc/integrate/integrate.h"
#include "montelux/mc/integrate/vegas/vegas.h"
#include "montelux/mc/math/constants.h"

namespace montelux {
namespace {

TEST(VegasJumps, ErrorsCoverThem) {
    int beyond_two = 0, runs = 0;
    for (double at : {0.1, 0.3, 0.57, 0.9}) {
        const Integrand f = [at](double x) { return x < at ? 1.0 : 2 * x; };
        const double exact = at + 1 - at * at;
        for (std::uint64_t seed = 1; seed <= 25; ++seed, ++runs) {
            const IntegrationResult r = integrate(f, Domain::interval(0, 1), Vegas{},
                                                  {.relative_error = 1e-3}, {.seed = seed, .threads = 1});
            const double errors = std::abs(r.value[0] - exact) / r.standard_error[0];
            EXPECT_LT(errors, 4) << at << " " << seed << ": " << to_string(r);
            beyond_two += errors > 2 ? 1 : 0;
        }
    }
    EXPECT_LE(beyond_two, 12) << "of " << runs;
}

TEST(VegasJumps, SlopesAndPeaksHaveNone) {
    // Errors are those of the values within boxes: with jumps they would be far larger than the differences.
    for (double width : {1.0, 0.1, 0.01}) {
        const Integrand f = [width](double x) {
            return std::exp(-(x - 0.4) * (x - 0.4) / (width * width)) + 0.1 * x;
        };
        double squares = 0, errors = 0;
        const double exact =
            width * std::sqrt(pi) / 2 * (std::erf(0.6 / width) + std::erf(0.4 / width)) + 0.05;
        constexpr int seeds = 400;
        for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
            const IntegrationResult r = integrate(f, Domain::interval(0, 1), Vegas{}, {.evaluations = 10'000},
                                                  {.seed = seed, .threads = 1});
            squares += std::pow(r.value[0] - exact, 2);
            errors += r.standard_error[0] * r.standard_error[0];
        }
        EXPECT_LT(errors, 1.4 * squares) << width << " " << errors / squares;
    }
}

} // namespace
} // namespace montelux
