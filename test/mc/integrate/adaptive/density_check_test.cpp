#include <cmath>
#include <gtest/gtest.h>
#include <utility>

#include "montelux/mc/integrate/adaptive/density_check.h"

namespace montelux {
namespace {

// A thin half-ring, explored by uniform points.
struct HalfRing {
    Evaluator evaluator{Integrand::batch([](const PointBatch& x, ValueBatch y) {
                            for (std::size_t i = 0; i < x.count(); ++i) {
                                const double off = std::hypot(x(i, 0) - 0.5, x(i, 1) - 0.5) - 0.35;
                                y(i, 0) = x(i, 1) > 0.5 ? std::exp(-off * off / (2 * 0.008 * 0.008)) : 0;
                            }
                        }),
                        Domain::unit_cube(2)};
    DensityTrainer trainer{{evaluator, 5}, 4};
    MixtureEstimate estimate{16, 1};

    HalfRing() {
        const MixtureDensity uniform(2);
        SamplePoints drawn;
        EXPECT_TRUE(sample_mixture(evaluator, uniform, 1, 1, 0, 4096, &drawn, nullptr));
        trainer.start(std::move(drawn));
        trainer.find_peaks(100);
    }
    void sample(std::uint64_t points) {
        const std::uint64_t first = estimate.points();
        estimate.grow(*sample_mixture(evaluator, trainer.density(), 3, 16, first, points, nullptr, nullptr),
                      points);
    }
};

TEST(DensityCheck, IsDueBeforeAClaimAndWhenPointsHaveGrown) {
    HalfRing ring;
    ring.sample(64);
    ring.sample(128);
    DensityCheck check;
    const StepRequest loose{100'000, 10, 0, nullptr}, tight{100'000, 1e-6, 0, nullptr};
    EXPECT_TRUE(check.due(ring.trainer, ring.estimate, loose, 1024));
    EXPECT_FALSE(check.due(ring.trainer, ring.estimate, tight, 1024));
    EXPECT_TRUE(check.due(ring.trainer, ring.estimate, tight, 128));
    EXPECT_FALSE(check.due(ring.trainer, ring.estimate, {100'000, 0, 0, nullptr}, 128)); // no target
    EXPECT_TRUE(check.run(ring.trainer, ring.estimate, loose, false));
    EXPECT_FALSE(check.due(ring.trainer, ring.estimate, loose, 128));
    EXPECT_TRUE(check.covers(ring.trainer, 512));
    EXPECT_FALSE(check.covers(ring.trainer, 513));
}

TEST(DensityCheck, WarnsOfWhatIsHardlySampledUntilTheDensityIsFitted) {
    HalfRing ring;
    ring.sample(16);
    DensityCheck check;
    const StepRequest walks{8192, 1e-2, 0, nullptr};
    ASSERT_TRUE(check.run(ring.trainer, ring.estimate, walks, true));
    EXPECT_GT(check.unseen(), 0.1);
    Tally tally;
    check.warn(tally);
    ASSERT_EQ(tally.warnings.size(), 1u);
    EXPECT_NE(tally.warnings[0].find("hardly samples"), std::string::npos);

    StateWriter state, again;
    check.save(state);
    StateReader reader({state.words().begin(), state.words().end()});
    DensityCheck loaded;
    loaded.load(reader);
    EXPECT_TRUE(reader.at_end());
    loaded.save(again);
    EXPECT_TRUE(std::ranges::equal(state.words(), again.words()));

    for (int i = 0; i < 8; ++i) ASSERT_TRUE(ring.trainer.round(4096, {}));
    ring.estimate = MixtureEstimate(16, 1);
    ring.sample(512);
    ASSERT_TRUE(check.run(ring.trainer, ring.estimate, walks, true));
    EXPECT_EQ(check.unseen(), 0);
    Tally silent;
    check.warn(silent);
    EXPECT_TRUE(silent.warnings.empty());
}

TEST(DensityCheck, OnlyConcentratedIntegrandsNeedIt) {
    const Evaluator wide(Integrand([](std::span<const double> x) { return x[0] + x[1]; }),
                         Domain::unit_cube(2));
    DensityTrainer trainer({wide, 5}, 4);
    SamplePoints drawn;
    ASSERT_TRUE(sample_mixture(wide, MixtureDensity(2), 1, 1, 0, 4096, &drawn, nullptr));
    trainer.start(std::move(drawn));
    EXPECT_TRUE(DensityCheck().covers(trainer, 1 << 20));
    EXPECT_FALSE(DensityCheck().covers(HalfRing().trainer, 1));
}

// Evaluations are those of the walk, within what is left.
TEST(DensityCheck, KeepsToItsEvaluations) {
    HalfRing ring;
    ring.sample(64);
    for (std::uint64_t left : {0, 100, 1000, 100'000}) {
        const std::uint64_t before = ring.trainer.evaluations();
        DensityCheck check;
        EXPECT_EQ(check.run(ring.trainer, ring.estimate, {left, 1e-2, 0, nullptr}, true), left >= 1000);
        EXPECT_EQ(check.covers(ring.trainer, 64), left >= 1000);
        EXPECT_LE(ring.trainer.evaluations() - before, std::min<std::uint64_t>(left, 4096));
        EXPECT_EQ(ring.trainer.evaluations() > before, left >= 1000);
    }
}

} // namespace
} // namespace montelux
