// The level of the statistical tests.
#pragma once

namespace montelux {

// A p-value below it fails. Seeds are fixed, so that a test that passed once always does; the level bounds
// what new tests, and changes of the order of random numbers, may fail of by chance.
inline constexpr double significance = 1e-6;

} // namespace montelux
