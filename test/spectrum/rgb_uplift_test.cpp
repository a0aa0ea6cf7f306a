#include <gtest/gtest.h>

#include "montelux/mc/math/error.h"
#include "montelux/mc/stats/chi_squared.h"
#include "montelux/spectrum/rgb_uplift.h"
#include "montelux/spectrum/rgb_uplift_solver.h"

namespace montelux {
namespace {

double largest_error(Vec3d a, Vec3d b) {
    return std::max({std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.z - b.z)});
}

// The colour, under the white of the space, of the spectrum that the table gives for `rgb`.
Vec3d round_trip(const RgbUpliftTable& table, const RgbUpliftSolver& solver, Vec3d rgb) {
    SigmoidPolynomial p = table(Vec3f(rgb));
    return solver.rgb({p.a, p.b, p.c});
}

TEST(RgbUplift, EveryColourComesBackWithinAThousandth) {
    const RgbColorSpace& space = RgbColorSpace::srgb();
    const RgbUpliftTable& table = rgb_uplift_table(space);
    const RgbUpliftSolver solver(space);
    TestUniforms uniforms(3);
    for (int i = 0; i < 100000; ++i) {
        Vec3d rgb;
        for (int k = 0; k < 3; ++k) {
            double u = uniforms.next(), choice = uniforms.next();
            if (i % 4 == 0) rgb[k] = u;                                          // anywhere
            if (i % 4 == 1) rgb[k] = u * u * u * u;                              // dark
            if (i % 4 == 2) rgb[k] = choice < 0.5 ? u : 0.02 * u;                // saturated
            if (i % 4 == 3) rgb[k] = choice < 0.3 ? 0 : (choice < 0.65 ? 1 : u); // faces and corners
        }
        if (i % 8 == 2) rgb = rgb * std::pow(uniforms.next(), 3.0); // dark and saturated
        ASSERT_LT(largest_error(round_trip(table, solver, rgb), rgb), 1e-3)
            << rgb.x << " " << rgb.y << " " << rgb.z;
    }
}

TEST(RgbUplift, EightBitColoursNearWhiteAndBlackComeBack) {
    const RgbUpliftTable& table = rgb_uplift_table(RgbColorSpace::srgb());
    const RgbUpliftSolver solver(RgbColorSpace::srgb());
    for (int base : {0, 248})
        for (int r = 0; r < 8; ++r)
            for (int g = 0; g < 8; ++g)
                for (int b = 0; b < 8; ++b) {
                    Vec3d rgb = Vec3d(base + r, base + g, base + b) / 255.0;
                    ASSERT_LT(largest_error(round_trip(table, solver, rgb), rgb), 1e-3)
                        << base + r << " " << base + g << " " << base + b;
                }
}

TEST(RgbUplift, OtherSpacesRoundTripWhereReflectancesReach) {
    // Lights and unbounded colours look up half their value, which reflectances reach.
    for (const RgbColorSpace* space : {&RgbColorSpace::dci_p3(), &RgbColorSpace::rec2020()}) {
        const RgbUpliftTable& table = rgb_uplift_table(*space);
        const RgbUpliftSolver solver(*space);
        TestUniforms uniforms(5);
        for (int i = 0; i < 20000; ++i) {
            double r = uniforms.next(), g = uniforms.next(), b = uniforms.next();
            Vec3d rgb = Vec3d(0.05 + 0.95 * r, 0.05 + 0.95 * g, 0.05 + 0.95 * b) * 0.5;
            ASSERT_LT(largest_error(round_trip(table, solver, rgb), rgb), 5e-3)
                << space->name() << " " << rgb.x << " " << rgb.y << " " << rgb.z;
        }
    }
}

TEST(RgbUplift, GreysAreConstantSpectra) {
    const RgbUpliftTable& table = rgb_uplift_table(RgbColorSpace::srgb());
    for (float v : {0.0f, 0.001f, 0.18f, 0.5f, 0.73f, 1.0f}) {
        SigmoidPolynomial p = table({v, v, v});
        for (float lambda : {360.0f, 500.0f, 830.0f}) EXPECT_NEAR(p(lambda), v, 1e-6);
    }
    EXPECT_EQ(table({0, 0, 0})(550), 0);
    EXPECT_EQ(table({1, 1, 1})(550), 1);
}

TEST(RgbUplift, ComponentsOutsideTheUnitCubeAreClamped) {
    const RgbUpliftTable& table = rgb_uplift_table(RgbColorSpace::srgb());
    float nan = std::numeric_limits<float>::quiet_NaN();
    for (float lambda : {400.0f, 550.0f, 700.0f}) {
        EXPECT_EQ(table({2, -1, 0.5f})(lambda), table({1, 0, 0.5f})(lambda));
        EXPECT_NEAR(table({1e-39f, 0, 2e-40f})(lambda), 0, 1e-5);
        EXPECT_EQ(table({nan, 0.5f, 0.2f})(lambda), table({0, 0.5f, 0.2f})(lambda));
    }
}

TEST(RgbUplift, TheMapIsContinuousWhereTheLargestComponentChanges) {
    const RgbUpliftTable& table = rgb_uplift_table(RgbColorSpace::srgb());
    TestUniforms uniforms(9);
    for (int i = 0; i < 2000; ++i) {
        float v = 0.02f + 0.96f * uniforms.next_float(), low = v * uniforms.next_float();
        SigmoidPolynomial a = table({v * 1.00001f, v, low}), b = table({v, v * 1.00001f, low});
        for (float lambda = 360; lambda <= 830; lambda += 10)
            ASSERT_NEAR(a(lambda), b(lambda), 0.02) << v << " " << low << " at " << lambda;
    }
}

TEST(RgbUplift, SpacesWithoutATableAreRefused) {
    RgbColorSpace own("mine", {0.6, 0.3}, {0.3, 0.6}, {0.15, 0.06}, RgbColorSpace::srgb().illuminant());
    EXPECT_THROW(rgb_uplift_table(own), Error);
}

TEST(RgbUpliftSolver, SolvesToAMillionth) {
    const RgbUpliftSolver solver(RgbColorSpace::srgb());
    for (Vec3d rgb : {Vec3d(0.8, 0.1, 0.1), Vec3d(0.02, 0.3, 0.7), Vec3d(0.95, 0.9, 0.2), Vec3d(1, 0, 0),
                      Vec3d(1e-3, 2e-3, 5e-4)})
        EXPECT_LT(largest_error(solver.rgb(solver.solve(rgb, {0, 0, 0})), rgb), 1e-5);
}

TEST(SigmoidPolynomial, LargestValueIsFound) {
    for (SigmoidPolynomial p : {SigmoidPolynomial{-8, 7, 0}, SigmoidPolynomial{3, -1, 0.2f},
                                SigmoidPolynomial{-1, 5, 0}, SigmoidPolynomial{0, -2, 1}}) {
        float largest = 0;
        for (float lambda = 360; lambda <= 830; lambda += 0.25f) largest = std::max(largest, p(lambda));
        EXPECT_NEAR(p.max_value(), largest, 1e-5);
        auto w = SampledWavelengths::sample_visible(0.37f);
        for (int k = 0; k < 4; ++k) EXPECT_NEAR(p.sample(w)[k], p(w.lambda[k]), 1e-6);
    }
}

} // namespace
} // namespace montelux
