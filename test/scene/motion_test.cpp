// Motions: ends, speed of rotation, the path between, and what has no path.
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/error.h"
#include "montelux/scene/shape/motion.h"
#include "montelux/scene/shape/motion_path.h"

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

// Also of what is long in one direction and grows in another.
TEST(Motion, LeavesThePathOfStretchesByItsToleranceAtMost) {
    const Transform turn = Transform::rotate(70, {0, 0, 1}), tilt = Transform::rotate(35, {1, 2, 0});
    const auto tilted = [&](const Transform& t) { return tilt * t * tilt.inverse(); };
    const Transform bar = Transform::scale({10, 1, 1}), thicker = Transform::scale({10, 3, 1});
    const Transform cases[][2] = {{bar, turn * thicker},
                                  {turn * thicker, bar},
                                  {tilted(bar), turn * tilted(thicker)},
                                  {Transform::scale({3, 0.1, 1}), turn * Transform::scale({3, 0.2, 1})}};
    for (const auto& [start, end] : cases) {
        const Motion motion(start, end);
        const MotionPath path(start, end);
        ASSERT_LT(motion.keys().size(), 129u); // Embree's limit
        double worst = 0;
        for (int i = 0; i <= 2000; ++i) {
            const double t = i / 2000.0;
            const Transform truth(path.at(t), Matrix4{});
            for (const Vec3d direction : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}, Vec3d{1, 1, 1}})
                for (const Vec3d p : {direction, tilt.point(direction)})
                    worst =
                        std::max(worst, distance(motion.at(static_cast<float>(t)).point(p), truth.point(p)) /
                                            length(truth.point(p)));
        }
        EXPECT_LT(worst, 1.21e-4) << &start - &cases[0][0];
    }
}

TEST(MotionPath, IsExactAtAllScalesOfFloats) {
    for (const double scale : {1e-37, 1e-31, 1e-20, 1.0, 1e20, 1e31, 1e37}) {
        const auto turned = [&](double degrees) {
            return Transform::rotate(degrees, {1, 2, 3}) * Transform::scale({scale, 2 * scale, scale});
        };
        const MotionPath path(turned(20), turned(80));
        for (const double t : {0.0, 0.25, 0.5, 1.0})
            for (std::size_t r = 0; r < 3; ++r)
                for (std::size_t c = 0; c < 3; ++c)
                    EXPECT_NEAR(path.at(t).m[r][c] / scale, turned(20 + 60 * t).matrix().m[r][c] / scale,
                                1e-9)
                        << scale << " " << t;
    }
}

const Transform stretched =
    Transform::translate({3, -1, 2}) * Transform::rotate(70, {1, 1, 0}) * Transform::scale({4, 0.5, 1});
const Transform mirrored = Transform::translate({0, 1, 0}) * Transform::scale({1, -2, 1});

// The keys of the inner motion, each placed by the outer transformation.
TEST(MotionProduct, OfAStillTransformationPlacesTheMotion) {
    const Motion inner(Transform::translate({1, 0, 0}),
                       Transform::translate({0, 2, 1}) * Transform::rotate(100, {0, 1, 1}));
    for (const Transform& outer : {stretched, mirrored, mirrored * stretched}) {
        const Motion motion = Motion::product(outer, inner);
        EXPECT_TRUE(motion.is_product());
        EXPECT_EQ(motion.keys().size(), inner.keys().size());
        EXPECT_EQ(motion.at(0.3f).swaps_handedness(), outer.swaps_handedness());
        for (int i = 0; i <= 50; ++i)
            for (const Vec3d p : {Vec3d{0, 0, 0}, Vec3d{1, -2, 0.5}}) {
                const float t = static_cast<float>(i) / 50;
                EXPECT_LT(distance(motion.at(t).point(p), outer.point(inner.at(t).point(p))), 1e-5) << t;
            }
    }
    // Shears have another path than the one between their products, rigid transformations the same.
    const Transform sheared = Transform::scale({4, 1, 1});
    const auto far_from_direct = [&](const Transform& outer) {
        const Motion direct(outer * inner.start(), outer * inner.end());
        return distance(direct.at(0.5f).point(Vec3d{1, 1, 1}),
                        Motion::product(outer, inner).at(0.5f).point(Vec3d{1, 1, 1}));
    };
    EXPECT_GT(far_from_direct(sheared), 0.05);
    EXPECT_LT(far_from_direct(Transform::translate({1, 2, 3}) * Transform::rotate(50, {1, 0, 1})), 1e-5);
    EXPECT_LT(far_from_direct(Transform::scale({-1, 1, 1})), 1e-5);
}

// Of the worst of some points, as a share of their distance from the inner axis and of that axis from the outer one.
double worst_deviation(const Motion& motion, const Transform& a, const Transform& b, const Transform& c,
                       const Transform& d) {
    const MotionPath outer(a, b), inner(c, d);
    double worst = 0;
    for (const Vec3d p : {Vec3d{0, 0, 0}, Vec3d{1, 0, 0}, Vec3d{-1, 2, 0.5}, Vec3d{0, 0, 3}}) {
        double off = 0, from_inner = 0, from_outer = 0;
        for (int i = 0; i <= 2000; ++i) {
            const double t = i / 2000.0;
            const Transform placed(outer.at(t), Matrix4{}), truth(outer.at(t) * inner.at(t), Matrix4{});
            const Vec3d axis = truth.point(Vec3d{0, 0, 0});
            off = std::max(off, distance(motion.at(static_cast<float>(t)).point(p), truth.point(p)));
            from_inner = std::max(from_inner, distance(truth.point(p), axis));
            from_outer = std::max(from_outer, distance(axis, placed.point(Vec3d{0, 0, 0})));
        }
        worst =
            std::max(worst, (off - 5e-6) / std::max(from_inner + from_outer, 1e-3)); // less what floats round
    }
    return worst;
}

TEST(MotionProduct, OfTwoMotionsFollowsBoth) {
    struct Case {
        Transform start, end;
    };
    const Case cases[] = {
        {{}, Transform::translate({5, 1, 0})},
        {{}, Transform::rotate(90, {0, 0, 1})},
        {Transform::translate({2, 0, 0}), Transform::rotate(-60, {1, 2, 0})},
        {Transform::scale({1, 2, 1}), Transform::rotate(40, {1, 0, 0}) * Transform::scale({3, 1, 1})},
        {mirrored, Transform::rotate(80, {0, 1, 0}) * mirrored},
        {stretched, Transform::translate({0, 0, 9}) * stretched}};
    for (const auto& [a, b] : cases)
        for (const auto& [c, d] : cases) {
            const Motion motion = Motion::product(Motion(a, b), Motion(c, d));
            EXPECT_LE(motion.keys().size(), 129u);
            EXPECT_EQ(motion.start(), a * c);
            EXPECT_EQ(motion.end(), b * d);
            EXPECT_LT(worst_deviation(motion, a, b, c, d), 1.21e-4)
                << (&a - &cases[0].start) << " " << (&c - &cases[0].start);
        }
    // Twice half a turn would need 204 chords.
    const Transform half = Transform::rotate(179.9, {0, 0, 1});
    EXPECT_LT(worst_deviation(Motion::product(Motion({}, half), Motion({}, half)), {}, half, {}, half),
              3.2e-4);
}

TEST(MotionProduct, NeedsNoMoreKeysThanItsCurvature) {
    const Motion line(Transform(), Transform::translate({1, 2, 3})),
        turn({}, Transform::rotate(90, {0, 0, 1}));
    EXPECT_EQ(Motion::product(line, line).keys().size(), 2u);
    EXPECT_EQ(Motion::product(line, turn).keys().size(), turn.keys().size());
    // An arm that grows while it turns bends more than the turn alone.
    const Motion arm(Transform(), Transform::translate({3, 0, 0}));
    EXPECT_GT(Motion::product(turn, arm).keys().size(), turn.keys().size());
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
