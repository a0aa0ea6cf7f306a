// The level of the statistical tests.
#pragma once

namespace montelux {

// Smaller p-values fail. Seeds are fixed, so a test that has passed always passes; the level bounds the false
// alarms of new tests and of changes in the order of random numbers.
inline constexpr double significance = 1e-6;

} // namespace montelux
