// Motions: ends, speed of rotation, the path between, and what has no path.
#include <cmath>
#include <gtest/gtest.h>

#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/error.h"
#include "montelux/scene/shape/motion.h"

namespace montelux::testing {
namespace {

double distance(Vec3d a, Vec3d b) { return length(a - b); }

TEST(Motion, BeginsAndEndsAsGiven) {
    const Transform start =
        Transform::translate({1, 2, 3}) * Transform::rotate(20, {1, 2, 0}) * Transform::scale({1, 2, 0.5});
    const Transform end = Transform::translate({-4, 0, 7}) * Transform::rotate(-130, {0, 1, 3}) *
                          Transform::scale({3, 1, 1}) * Transform::rotate(40, {1, 0, 0});
    const Motion motion(start, end);
    for (const Vec3d p : {Vec3d{0, 0, 0}, Vec3d{1, -2, 3}, Vec3d{-5, 1, 0.5}}) {
        EXPECT_LT(distance(motion.at(0).point(p), start.point(p)), 1e-5);
        EXPECT_LT(distance(motion.at(1).point(p), end.point(p)), 1e-5);
        EXPECT_LT(distance(motion.at(-3).point(p), start.point(p)), 1e-5);
        EXPECT_LT(distance(motion.at(7).point(p), end.point(p)), 1e-5);
        EXPECT_LT(distance(motion.at(0.37f).inverse_point(motion.at(0.37f).point(p)), p), 1e-9);
    }
}

// About the axis, at constant speed, within 1.1e-4 of the radius; the length of the axis changes linearly.
TEST(Motion, TurnsAtConstantSpeedAndMovesLinearly) {
    for (const double degrees : {1.0, 30.0, 90.0, 179.0, -120.0}) {
        const Vec3d axis = normalize(Vec3d{1, 2, -0.5});
        const Transform end =
            Transform::translate({10, 0, 0}) * Transform::rotate(degrees, axis) * Transform::scale({3, 3, 3});
        const Motion motion(Transform(), end);
        for (int i = 0; i <= 100; ++i) {
            const double t = i / 100.0;
            const Transform truth = Transform::translate({10 * t, 0, 0}) *
                                    Transform::rotate(degrees * t, axis) *
                                    Transform::scale(Vec3d{1, 1, 1} * (1 + 2 * t));
            for (const Vec3d p : {Vec3d{1, 0, 0}, Vec3d{0, -1, 1}})
                EXPECT_LT(distance(motion.at(static_cast<float>(t)).point(p), truth.point(p)), 1e-3)
                    << degrees << " " << t;
        }
    }
}

TEST(Motion, TakesTheShorterWay) {
    // 170 and -170 degrees are 20 degrees apart.
    const Motion motion(Transform::rotate(170, {0, 0, 1}), Transform::rotate(-170, {0, 0, 1}));
    EXPECT_LT(distance(motion.at(0.5f).point(Vec3d{1, 0, 0}), {-1, 0, 0}), 2e-4);
}

TEST(Motion, TranslationsNeedTwoKeysAndRotationsEnough) {
    EXPECT_EQ(Motion(Transform(), Transform::translate({1, 2, 3})).keys().size(), 2u);
    const auto keys = Motion(Transform(), Transform::rotate(180, {0, 0, 1})).keys().size();
    EXPECT_GT(keys, 100u);
    EXPECT_LE(keys, 129u); // Embree's limit
}

TEST(Motion, KeepsMirrorsAndRefusesToBecomeOne) {
    const Transform mirror = Transform::scale({-1, 1, 1});
    const Motion motion(mirror, Transform::rotate(90, {0, 0, 1}) * mirror);
    for (const float t : {0.0f, 0.3f, 0.5f, 1.0f}) {
        EXPECT_TRUE(motion.at(t).swaps_handedness());
        EXPECT_NEAR(length(motion.at(t).vector(Vec3d{1, 0, 0})), 1, 2e-4);
    }
    EXPECT_THROW(Motion(Transform(), mirror), Error);
}

} // namespace
} // namespace montelux::testing
