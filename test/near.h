// Matchers that compare vectors by component.
#pragma once

#include <concepts>
#include <gtest/gtest.h>

#include "montelux/mc/math/vec.h"

namespace montelux {

template <typename T>
void expect_near(Vec3<T> a, Vec3<T> b, double tolerance = std::same_as<T, float> ? 1e-5 : 1e-12) {
    EXPECT_NEAR(double(a.x), double(b.x), tolerance);
    EXPECT_NEAR(double(a.y), double(b.y), tolerance);
    EXPECT_NEAR(double(a.z), double(b.z), tolerance);
}

} // namespace montelux
