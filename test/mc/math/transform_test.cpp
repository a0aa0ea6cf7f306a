#include "test/near.h"
#include <gtest/gtest.h>
#include <utility>

#include "montelux/mc/math/transform.h"

namespace montelux {
namespace {

TEST(Transform, InverseUndoesAComposition) {
    Transform t =
        Transform::translate({1, -2, 3}) * Transform::rotate(37, {1, 2, -1}) * Transform::scale({2, -3, 0.5});
    Vec3d p{0.3, 0.7, -1.1};
    expect_near(t.inverse().point(t.point(p)), p);
    expect_near(t.inverse().vector(t.vector(p)), p);
    auto numeric = Transform::from_matrix(t.matrix());
    ASSERT_TRUE(numeric);
    expect_near(numeric->inverse().point(t.point(p)), p);
    EXPECT_TRUE(t.swaps_handedness());
}

TEST(Transform, NormalsStayOrthogonalToTangents) {
    Transform t = Transform::rotate(20, {0, 1, 1}) * Transform::scale({1, 5, 0.2});
    Vec3d tangent{1, -1, 0.5}, normal = cross(tangent, Vec3d{0.2, 0.4, 1});
    EXPECT_NEAR(dot(t.vector(tangent), t.normal(normal)), 0, 1e-12);
}

TEST(Transform, LookAtPutsTheTargetOnTheAxis) {
    auto t = Transform::look_at({1, 2, 3}, {4, 6, 3}, {0, 0, 1});
    ASSERT_TRUE(t);
    expect_near(t->point(Vec3d{4, 6, 3}), {0, 0, 5});
    EXPECT_FALSE(Transform::look_at({0, 0, 0}, {0, 0, 1}, {0, 0, 2}));
}

// Distinct primes, so that each entry counts; the last row and column do not.
TEST(Transform, DeterminantOfTheLinearPart) {
    Matrix4 m;
    m.m = {{{2, 3, 5, 29}, {7, 11, 13, 31}, {17, 19, 23, 37}, {41, 43, 47, 53}}};
    EXPECT_EQ(m.linear_determinant(), -78);
    EXPECT_EQ(m.transposed().linear_determinant(), -78);
    std::swap(m.m[0], m.m[1]);
    EXPECT_EQ(m.linear_determinant(), 78);
    const Matrix4 scaled = (Transform::rotate(37, {1, 2, -1}) * Transform::scale({2, -3, 0.5})).matrix();
    EXPECT_NEAR(scaled.linear_determinant(), -3, 1e-12);
}

TEST(Transform, SingularMatrixHasNoInverse) {
    Matrix4 m;
    m.m[1][1] = 0;
    EXPECT_FALSE(Transform::from_matrix(m));
}

} // namespace
} // namespace montelux
