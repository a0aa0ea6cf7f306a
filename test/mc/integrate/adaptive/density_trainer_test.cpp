#include <atomic>
#include <chrono>
#include <cmath>
#include <gtest/gtest.h>
#include <memory>
#include <utility>
#include <vector>

#include "montelux/mc/integrate/adaptive/density_trainer.h"

namespace montelux {
namespace {

struct Stopped {};

// A problem whose evaluations are counted, and that throws Stopped on request.
struct Watched {
    explicit Watched(const Integrand& f, int dimensions)
        : evaluator(f.with_function([this, f](const PointBatch& x, ValueBatch y) {
              if (stop) throw Stopped();
              evaluations += x.count();
              f(x, y);
          }),
                    Domain::unit_cube(dimensions)) {}

    Problem problem() const { return {evaluator, 5}; }

    std::atomic<std::uint64_t> evaluations = 0;
    std::atomic<bool> stop = false;
    Evaluator evaluator;
};

double peak(std::span<const double> x, double centre, double narrowness) {
    double squares = 0;
    for (double v : x) squares += (v - centre) * (v - centre);
    return std::exp(-narrowness * squares);
}

void explore(DensityTrainer& trainer, const Watched& watched, std::uint64_t points = 2048) {
    SamplePoints drawn;
    const MixtureDensity uniform(watched.evaluator.dimensions());
    ASSERT_TRUE(sample_mixture(watched.evaluator, uniform, 1, 1, 0, points, &drawn, nullptr));
    trainer.start(std::move(drawn));
}
double pdf_at(const MixtureDensity& density, double coordinate) {
    PointBuffer point(1, density.dimensions());
    for (int d = 0; d < density.dimensions(); ++d) point(0, d) = coordinate;
    double p;
    density.pdf(point, {&p, 1});
    return p;
}
std::vector<std::uint64_t> words_of(const DensityTrainer& trainer) {
    StateWriter state;
    trainer.save(state);
    return {state.words().begin(), state.words().end()};
}

TEST(DensityTrainer, UsesTheExploration) {
    const Watched half([](std::span<const double> x) { return x[0] < 0.5 ? -3.0 : 0.0; }, 2);
    DensityTrainer trainer(half.problem(), 4);
    explore(trainer, half);
    EXPECT_EQ(trainer.nonzero(), 1024u); // Sobol' points
    EXPECT_NEAR(trainer.effective_share(), 0.5, 1e-12);
    const Watched flat([](std::span<const double>) { return 2.0; }, 2);
    DensityTrainer other(flat.problem(), 4);
    explore(other, flat);
    EXPECT_NEAR(other.effective_share(), 1, 1e-12);
}

// A box at a corner, greatest at its far end: Gaussians around the peak lie outside the cube or beyond the
// jump.
TEST(DensityTrainer, PeaksThatSeeLessThanTheExplorationAreGivenUp) {
    const Watched watched(
        [](std::span<const double> x) {
            double sum = 0;
            for (double v : x) sum += v;
            return x[0] < 0.1 && x[1] < 0.1 ? std::exp(5 * sum) : 0.0;
        },
        8);
    DensityTrainer trainer(watched.problem(), 4);
    explore(trainer, watched, 8192);
    ASSERT_GE(trainer.nonzero(), 16u);
    trainer.find_peaks(5000);
    ASSERT_FALSE(trainer.density().gaussians().empty());
    ASSERT_TRUE(trainer.round(1024, {}));
    EXPECT_TRUE(trainer.density().gaussians().empty());
    for (int i = 0; i < 6; ++i) ASSERT_TRUE(trainer.round(2048, {}));
    EXPECT_LT(trainer.relative_variance(), 1);
}

TEST(DensityTrainer, RoundsMakeTheWeightsEven) {
    // A ridge across the diagonal, which maps of single coordinates cannot follow.
    const Watched watched(
        [](std::span<const double> x) {
            return std::exp(-200 * (x[0] - x[1]) * (x[0] - x[1])) * std::exp(-20 * std::pow(x[2] - 0.5, 2));
        },
        3);
    DensityTrainer trainer(watched.problem(), 4);
    explore(trainer, watched);
    const std::uint64_t before = watched.evaluations;
    ASSERT_TRUE(trainer.round(4096, {}));
    const double uniform = trainer.relative_variance();
    for (int i = 0; i < 9; ++i) ASSERT_TRUE(trainer.round(4096, {}));
    EXPECT_EQ(trainer.rounds(), 10);
    EXPECT_GT(uniform, 2);
    EXPECT_LT(trainer.relative_variance(), 0.25 * uniform);
    EXPECT_EQ(trainer.evaluations(), watched.evaluations - before);
    EXPECT_GE(trainer.density().shares()[0], 4);
    // The rounds' own estimates, of the integral over the cube.
    double truth = 0;
    const int cells = 2000;
    for (int i = 0; i < cells; ++i) { // of the difference t, whose density is 2 (1 - t)
        const double t = (i + 0.5) / cells;
        truth += 2 * (1 - t) * std::exp(-200 * t * t) / cells;
    }
    truth *= std::sqrt(3.14159265358979323846 / 20) * std::erf(0.5 * std::sqrt(20.0));
    ASSERT_EQ(trainer.checks().size(), 2u);
    for (const DensityTrainer::Check& c : trainer.checks()) {
        EXPECT_GT(c.variance, 0);
        EXPECT_LT(std::abs(c.value - truth), 5 * std::sqrt(c.variance));
    }
}

TEST(DensityTrainer, ComponentsOfVeryDifferentSizeCountAlike) {
    const Watched watched(Integrand::vector_valued(2,
                                                   [](std::span<const double> x, std::span<double> y) {
                                                       y[0] = 1e9 * peak(x, 0.25, 40);
                                                       y[1] = 1e-9 * peak(x, 0.75, 40);
                                                   }),
                          2);
    DensityTrainer trainer(watched.problem(), 4);
    explore(trainer, watched);
    for (int i = 0; i < 4; ++i) ASSERT_TRUE(trainer.round(4096, {}));
    EXPECT_NEAR(pdf_at(trainer.density(), 0.25) / pdf_at(trainer.density(), 0.75), 1, 0.4);
    EXPECT_GT(pdf_at(trainer.density(), 0.25), 3 * pdf_at(trainer.density(), 0.5));
}

TEST(DensityTrainer, PeaksBecomeGaussians) {
    const Watched watched([](std::span<const double> x) { return peak(x, 0.3, 300) + peak(x, 0.7, 300); }, 6);
    DensityTrainer trainer(watched.problem(), 4);
    explore(trainer, watched);
    const std::uint64_t before = watched.evaluations;
    trainer.find_peaks(5000);
    EXPECT_LE(watched.evaluations - before, 5000u);
    EXPECT_EQ(trainer.evaluations(), watched.evaluations - before);
    EXPECT_EQ(trainer.density().gaussians().size(), 2u);
    EXPECT_GT(pdf_at(trainer.density(), 0.3), 1e3);
    EXPECT_GT(pdf_at(trainer.density(), 0.7), 1e3);
    ASSERT_TRUE(trainer.round(4096, {}));
    EXPECT_LT(trainer.relative_variance(), 2);
}

// Half of a thin ring: at first there are Gaussians for a part of it, after some rounds for all.
TEST(DensityTrainer, WalkersTellWhatIsHardlySampled) {
    const Watched watched(
        [](std::span<const double> x) {
            const double off = std::hypot(x[0] - 0.5, x[1] - 0.5) - 0.35;
            return x[1] > 0.5 ? std::exp(-off * off / (2 * 0.008 * 0.008)) : 0.0;
        },
        2);
    DensityTrainer trainer(watched.problem(), 4);
    explore(trainer, watched, 4096);
    trainer.find_peaks(100);
    ASSERT_GE(trainer.density().gaussians().size(), 1u);
    ASSERT_LE(trainer.density().gaussians().size(), 3u);
    const std::uint64_t before = watched.evaluations, counted = trainer.evaluations();
    EXPECT_GT(trainer.unseen_share(300, 8192).value(), 0.3);
    EXPECT_LE(watched.evaluations - before, 8192u);
    EXPECT_GT(watched.evaluations - before, 8000u);
    EXPECT_EQ(trainer.evaluations() - counted, watched.evaluations - before);
    // So many points hit every part of the ring.
    EXPECT_LT(trainer.unseen_share(1e8, 8192).value(), 1e-3);
    for (int i = 0; i < 8; ++i) ASSERT_TRUE(trainer.round(4096, {}));
    EXPECT_LT(trainer.unseen_share(3000, 8192).value(), 3e-3);
    // A walk that cannot be afforded gives no answer.
    const std::uint64_t after = watched.evaluations;
    EXPECT_FALSE(trainer.unseen_share(3000, 64));
    EXPECT_EQ(watched.evaluations, after);
}

TEST(DensityTrainer, CancelledOrInterruptedStepsChangeNothing) {
    Watched watched([](std::span<const double> x) { return peak(x, 0.4, 50); }, 3);
    DensityTrainer trainer(watched.problem(), 4);
    explore(trainer, watched);
    ASSERT_TRUE(trainer.round(2048, {}));
    const std::vector<std::uint64_t> before = words_of(trainer);
    CancelFlag cancel;
    cancel.request();
    EXPECT_FALSE(trainer.round(2048, {.cancel = &cancel}));
    EXPECT_EQ(words_of(trainer), before);
    watched.stop = true;
    EXPECT_THROW(trainer.round(2048, {}), Stopped);
    EXPECT_EQ(words_of(trainer), before);
    EXPECT_THROW(trainer.find_peaks(2000), Stopped);
    EXPECT_EQ(words_of(trainer), before);
    EXPECT_THROW(trainer.unseen_share(1e4, 4096), Stopped);
    EXPECT_EQ(words_of(trainer), before);
}

TEST(DensityTrainer, RoundsThatRunOutOfTimeChangeNothing) {
    using Clock = std::chrono::steady_clock;
    const Watched ring(
        [](std::span<const double> x) {
            return std::exp(-2000 * std::pow(std::hypot(x[0] - 0.5, x[1] - 0.5) - 0.3, 2));
        },
        2);
    DensityTrainer trainer(ring.problem(), 4);
    explore(trainer, ring);
    for (int i = 0; i < 4; ++i) ASSERT_TRUE(trainer.round(4096, {}));
    ASSERT_GT(trainer.density().gaussians().size(), 0u);
    const std::vector<std::uint64_t> before = words_of(trainer);
    EXPECT_FALSE(trainer.round(4096, {.deadline = Clock::now()}));
    EXPECT_EQ(words_of(trainer), before);
    // Deadlines throughout a round.
    const Clock::time_point begin = Clock::now();
    constexpr int parts = 24;
    auto loaded = [&] {
        StateReader reader(before);
        DensityTrainer copy(ring.problem(), 4);
        copy.load(reader);
        return copy;
    };
    DensityTrainer whole = loaded();
    ASSERT_TRUE(whole.round(4096, {}));
    const Clock::duration duration = Clock::now() - begin;
    for (int k = 1; k < parts; ++k) {
        DensityTrainer late = loaded();
        const bool done = late.round(4096, {.deadline = Clock::now() + k * duration / parts});
        EXPECT_EQ(words_of(late), done ? words_of(whole) : before) << k << " of " << parts;
    }
}

TEST(DensityTrainer, RoundsThatWouldBeLateAreNotBegun) {
    using Clock = std::chrono::steady_clock;
    const Watched watched([](std::span<const double> x) { return peak(x, 0.4, 50); }, 3);
    DensityTrainer trainer(watched.problem(), 4);
    explore(trainer, watched);
    const StepRequest soon{.deadline = Clock::now() + std::chrono::hours(1)};
    constexpr std::uint64_t many = std::uint64_t{1} << 62;
    EXPECT_TRUE(trainer.has_time_for(many, soon)); // nothing is known yet
    ASSERT_TRUE(trainer.round(2048, soon));
    EXPECT_TRUE(trainer.has_time_for(2048, soon));
    EXPECT_FALSE(trainer.has_time_for(many, soon));
    EXPECT_TRUE(trainer.has_time_for(many, {}));
}

TEST(DensityTrainer, LoadedOneResumesWithTheSameBits) {
    const Watched watched([](std::span<const double> x) { return peak(x, 0.4, 300); }, 3);
    DensityTrainer trainer(watched.problem(), 4);
    explore(trainer, watched);
    for (int i = 0; i < 5; ++i) {
        const std::vector<std::uint64_t> saved = words_of(trainer);
        StateReader reader(saved);
        DensityTrainer loaded(watched.problem(), 4);
        loaded.load(reader);
        EXPECT_TRUE(reader.at_end());
        EXPECT_EQ(words_of(loaded), saved);
        if (i == 0) {
            trainer.find_peaks(2000);
            loaded.find_peaks(2000);
        } else {
            ASSERT_TRUE(trainer.round(2048, {}));
            ASSERT_TRUE(loaded.round(2048, {}));
        }
        EXPECT_EQ(words_of(loaded), words_of(trainer)) << "round " << i;
    }
}

} // namespace
} // namespace montelux
