#include "test/mc/integrate/witness/shell_values.h"
#include <cmath>
#include <gtest/gtest.h>

#include "montelux/mc/integrate/infinity.h"
#include "montelux/mc/integrate/witness/lost_digits.h"

namespace montelux {
namespace {

// Below r = 2^-26.5 the cosine is one: 1 - cos r over r^p misses 2^(-26.5 (3 - p)) / (2 (3 - p)) there.
TEST(LostDigits, MassOfWhatIsRoundedToZero) {
    struct Case {
        double power, constant, slope;
    };
    for (const Case& c :
         {Case{2.2, 0, 0}, Case{2.5, 0, 0}, Case{2.8, 0, 0}, Case{2.8, 10, 0}, Case{2.8, 0, 1000}}) {
        const ShellValues g =
            of([=](double r) { return (1 - std::cos(r)) / std::pow(r, c.power) + c.constant + c.slope * r; });
        const double missing = std::exp2(-26.5 * (3 - c.power)) / (2 * (3 - c.power));
        EXPECT_NEAR(mass_of_lost_digits(g, 24, 36, 1) / missing, 1, 0.1) << c.power;
    }
    const auto mass = [](auto f) { return mass_of_lost_digits(of(f), 15, 24, 1); };
    EXPECT_EQ(mass([](double r) { return r > 1e-6 ? 1 / std::sqrt(r) : 0; }), 0);
    EXPECT_EQ(mass([](double r) { return 1 / std::sqrt(r); }), 0);
    EXPECT_EQ(mass([](double r) { return std::exp(-1e-6 / r) / r; }), 0);
    const auto diverges = [](double r) { return (1 - std::cos(r)) / std::pow(r, 3.5) + 1; };
    EXPECT_EQ(mass_of_lost_digits(of(diverges), 24, 36, 1), infinity);
}

// Masses of 1 / r are ln 2 an octave: without an end they are infinite, up to one they are not.
TEST(LostDigits, MassUpToAnEnd) {
    const ShellValues g = of([](double r) { return 1 / r; });
    EXPECT_EQ(mass_beyond(g, 20, 1), infinity);
    EXPECT_NEAR(mass_beyond(g, 20, 1, 30), 10 * std::log(2.0), 1e-9);
    EXPECT_EQ(mass_beyond(g, 20, 1, 19), 0);
    const ShellValues falls = of([](double r) { return 1 / std::sqrt(r); });
    EXPECT_NEAR(mass_beyond(falls, 20, 1, 30), 2 * (std::exp2(-10) - std::exp2(-15)), 1e-9);
}

// Noise is as large as the value where the terms that cancel have lost all digits of it: at exp r - 1 - r = 2^-53.
TEST(LostDigits, NoiseBeginsWhereTermsHaveCancelled) {
    for (double finest : {46.0, finest_at_origin}) {
        const auto from = [=](auto f) { return noise_from(of(f), finest); };
        EXPECT_NEAR(from([](double r) { return std::abs(std::exp(r) - 1 - r) / std::pow(r, 2.5); }), 26, 2);
        EXPECT_NEAR(from([](double r) { return std::abs(std::exp(r) - std::exp(-r) - 2 * r) / r; }), 17, 2);
        EXPECT_NEAR(from([](double r) { return std::abs(1 / std::log(1 + r) - 1 / r); }), 26, 2);
    }
}

TEST(LostDigits, OscillationsAndJumpsAreNoNoise) {
    for (double finest : {46.0, finest_at_origin}) {
        const auto from = [=](auto f) { return noise_from(of(f), finest); };
        for (double power : {0.5, 0.99, 1.0, 3.0})
            EXPECT_EQ(from([=](double r) { return std::pow(r, -power); }), infinity) << power;
        EXPECT_EQ(from([](double r) { return std::abs(std::log(r)) / r; }), infinity);
        EXPECT_EQ(from([](double r) { return (2 + std::cos(20 * std::log(r))) / r; }), infinity);
        EXPECT_EQ(from([](double r) { return std::floor(1 / r); }), infinity);
        EXPECT_EQ(from([](double r) { return r > 1e-6 ? 1 / r : 0; }), infinity);
        EXPECT_EQ(from([](double r) { return std::exp(-1e-6 / r) / r; }), infinity);
        for (double frequency : {1e-6, 1e-3, 1.0, 1e3, 1e6})
            for (double power : {0.5, 1.0, 2.0, 4.0}) {
                const auto phase = [=](double r) { return frequency * std::pow(r, -power); };
                EXPECT_EQ(from([=](double r) { return std::abs(std::sin(phase(r))) / r; }), infinity)
                    << frequency << " " << power;
                EXPECT_EQ(from([=](double r) { return (phase(r) - std::floor(phase(r))) / r; }), infinity)
                    << frequency << " " << power;
            }
    }
}

} // namespace
} // namespace montelux
