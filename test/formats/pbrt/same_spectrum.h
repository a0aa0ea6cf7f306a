// expect_same_values: spectra of any kinds that are equal at all visible wavelengths.
#pragma once

#include <gtest/gtest.h>

#include "montelux/spectrum/spectrum.h"

namespace montelux::test {

inline void expect_same_values(const Spectrum& a, const Spectrum& b) {
    for (float lambda = 370; lambda < 820; lambda += 25) EXPECT_FLOAT_EQ(a(lambda), b(lambda)) << lambda;
}

} // namespace montelux::test
