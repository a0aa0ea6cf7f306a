// Checkpoints of integrations: resumed runs equal uninterrupted ones bit for bit, wrong files are refused.
#include "test/mc/integrate/integrate_testing.h"
#include "test/temporary_folder.h"
#include <atomic>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <limits>
#include <string>
#include <string_view>

namespace montelux {
namespace {

using std::chrono::duration;

class CheckpointFile {
  public:
    std::string path() const { return (folder_ / "state").string(); }
    std::string bytes() const {
        std::ifstream in(path(), std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    void replace(const std::string& bytes) const { folder_.write("state", bytes); }

  private:
    TemporaryFolder folder_;
};

TEST(IntegrateCheckpoint, ResumedRunHasTheBitsOfAnUninterruptedOne) {
    const Budget budget{.evaluations = 400'000};
    const Integrand f = Integrand::vector_valued(2, [](std::span<const double> x, std::span<double> y) {
        y[0] = product(x);
        y[1] = x[0] < 0.001 ? std::numeric_limits<double>::quiet_NaN() : x[1];
    });
    const IntegrationResult uninterrupted = integrate(f, Domain::unit_cube(2), basic, budget, {.seed = 3});
    for (std::uint64_t stop_at : {1u, 10'000u, 100'000u, 250'000u}) {
        const CheckpointFile file;
        CancelFlag cancel;
        IntegrationOptions options{.seed = 3, .cancel = &cancel, .checkpoint = file.path()};
        options.progress = [&](const IntegrationResult& r) {
            if (r.evaluations >= stop_at) cancel.request();
        };
        const IntegrationResult part = integrate(f, Domain::unit_cube(2), basic, budget, options);
        EXPECT_EQ(part.stop, StopReason::interrupted);
        EXPECT_LT(part.evaluations, budget.evaluations);
        const IntegrationResult rest =
            integrate(f, Domain::unit_cube(2), basic, budget,
                      {.seed = 3, .threads = 3, .checkpoint = file.path(), .resume = true});
        EXPECT_TRUE(same_but_for_time(rest, uninterrupted)) << "stopped at " << stop_at;
        // The state was saved with the time until then; writing it may take longer than all the rest.
        ASSERT_FALSE(part.history.empty());
        EXPECT_GE(rest.seconds, part.history.back().seconds);
        // Once more from the end: nothing is left to do.
        const IntegrationResult end = integrate(f, Domain::unit_cube(2), basic, budget,
                                                {.seed = 3, .checkpoint = file.path(), .resume = true});
        EXPECT_TRUE(same_but_for_time(end, uninterrupted));
    }
}
// Values that are noise near zero are left out in the rest of the run, too, and a fifth is imprecise there.
TEST(IntegrateCheckpoint, NoiseIsLeftOutAfterAResumption) {
    const auto value = [](double x) { return (std::exp(x) - 1 - x) / std::pow(x, 2.8); };
    const Integrand f = Integrand(value).with_rounding([value](const PointBatch& x, ValueBatch y) {
        for (std::size_t i = 0; i < x.count(); ++i) {
            y(i, 0) = value(x(i, 0));
            y(i, 1) = y(i, 0) * (x(i, 0) < 1e-4 ? 2 : 1);
        }
    });
    const Domain unit = Domain::interval(0, 1);
    const Budget budget{.evaluations = 200'000};
    const IntegrationResult uninterrupted = integrate(f, unit, Method::named("vegas"), budget, {.seed = 3});
    EXPECT_LT(std::abs(uninterrupted.value[0] - 2.660806), 4 * uninterrupted.standard_error[0]);
    EXPECT_NEAR(uninterrupted.standard_error[0], 0.33, 0.05); // 2.5 1e-4^0.2 - 2.5 1e-8^0.2
    const CheckpointFile file;
    CancelFlag cancel;
    IntegrationOptions options{.seed = 3, .cancel = &cancel, .checkpoint = file.path()};
    options.progress = [&](const IntegrationResult& r) {
        if (r.evaluations >= 10'000) cancel.request();
    };
    EXPECT_LT(integrate(f, unit, Method::named("vegas"), budget, options).evaluations, budget.evaluations);
    const IntegrationResult rest = integrate(f, unit, Method::named("vegas"), budget,
                                             {.seed = 3, .checkpoint = file.path(), .resume = true});
    EXPECT_TRUE(same_but_for_time(rest, uninterrupted));
}
// Cancelled in the middle of a step, by the integrand itself, at calls of all kinds: pilots, training,
// sampling.
TEST(IntegrateCheckpoint, EveryMethodResumesToTheSameBits) {
    auto peak = [](std::span<const double> x) {
        return std::exp(-40 * ((x[0] - 0.3) * (x[0] - 0.3) + x[1] * x[1]));
    };
    const Budget budget{.evaluations = 60'000};
    for (std::string_view name : Method::names()) {
        const Method method = Method::named(name);
        const IntegrationResult uninterrupted =
            integrate(peak, Domain::unit_cube(2), method, budget, {.seed = 4});
        EXPECT_LE(uninterrupted.evaluations, budget.evaluations) << name;
        for (int stop_at : {500, 5000, 20'000, 45'000}) {
            const CheckpointFile file;
            CancelFlag cancel;
            std::atomic<int> calls{0};
            auto f = [&](std::span<const double> x) {
                if (++calls == stop_at) cancel.request();
                return peak(x);
            };
            const IntegrationResult part =
                integrate(f, Domain::unit_cube(2), method, budget,
                          {.seed = 4, .cancel = &cancel, .checkpoint = file.path()});
            if (part.stop != StopReason::interrupted) continue; // had done all it wanted
            const IntegrationResult rest = integrate(peak, Domain::unit_cube(2), method, budget,
                                                     {.seed = 4, .checkpoint = file.path(), .resume = true});
            EXPECT_TRUE(same_but_for_time(rest, uninterrupted)) << name << " stopped at " << stop_at;
        }
    }
}
TEST(IntegrateCheckpoint, IsWrittenDuringTheRun) {
    const CheckpointFile file;
    std::size_t times = 0;
    IntegrationOptions options{.checkpoint = file.path(), .checkpoint_every = duration<double>(0)};
    options.progress = [&](const IntegrationResult&) { times += std::filesystem::exists(file.path()); };
    integrate(product, Domain::unit_cube(2), basic, {.evaluations = 50'000}, options);
    EXPECT_GE(times, 2u);
}
TEST(IntegrateCheckpoint, ResumeWithoutAFileBeginsAnew) {
    const CheckpointFile file;
    const IntegrationResult r = integrate(product, Domain::unit_cube(2), basic, {.evaluations = 10'000},
                                          {.checkpoint = file.path(), .resume = true});
    EXPECT_EQ(r.evaluations, 10'000u);
    EXPECT_TRUE(std::filesystem::exists(file.path()));
}
TEST(IntegrateCheckpoint, OfAnotherProblemIsRefused) {
    const CheckpointFile file;
    const Domain square = Domain::unit_cube(2);
    integrate(product, square, basic, {.evaluations = 5000}, {.seed = 1, .checkpoint = file.path()});
    const IntegrationOptions resume{.seed = 1, .checkpoint = file.path(), .resume = true};
    const Budget budget{.evaluations = 9000};
    const std::string text = "belongs to another integrand, domain, method or seed";
    IntegrationOptions other_seed = resume;
    other_seed.seed = 2;
    expect_error(text, [&] { integrate(product, square, basic, budget, other_seed); });
    expect_error(text, [&] {
        integrate([](std::span<const double> x) { return x[0]; }, square, basic, budget, resume);
    });
    expect_error(text, [&] { integrate(product, Domain({{0, 1}, {0, 1 + 1e-12}}), basic, budget, resume); });
    expect_error(text, [&] { integrate(product, square, TenSteps{}, budget, resume); });
    EXPECT_EQ(integrate(product, square, basic, budget, resume).evaluations, 9000u);
}
TEST(IntegrateCheckpoint, OfAnotherComponentIsRefused) {
    auto pair = [](double first, double second) {
        return Integrand::vector_valued(2, [=](std::span<const double> x, std::span<double> y) {
            y[0] = first * x[0];
            y[1] = second * x[0];
        });
    };
    const CheckpointFile file;
    const Domain line = Domain::unit_cube(1);
    integrate(pair(1, 2), line, basic, {.evaluations = 5000}, {.checkpoint = file.path()});
    const IntegrationOptions resume{.checkpoint = file.path(), .resume = true};
    for (const Integrand& other : {pair(3, 2), pair(1, 3), pair(2, 1)})
        expect_error("belongs to another integrand, domain, method or seed",
                     [&] { integrate(other, line, basic, {.evaluations = 9000}, resume); });
    EXPECT_EQ(integrate(pair(1, 2), line, basic, {.evaluations = 9000}, resume).evaluations, 9000u);
}
TEST(IntegrateCheckpoint, OfAnotherVersionIsRefused) {
    const CheckpointFile file;
    const Domain square = Domain::unit_cube(2);
    integrate(product, square, basic, {.evaluations = 5000}, {.checkpoint = file.path()});
    SavedState saved = read_state(file.path(), "integration");
    const std::uint64_t version = saved.reader.get_word();
    const std::vector<std::uint64_t> rest = saved.reader.rest();
    for (std::uint64_t other : {version + 1, version}) {
        StateWriter state;
        state.put(other);
        for (std::uint64_t word : rest) state.put(word);
        write_state(file.path(), "integration", state);
        const auto resume = [&] {
            return integrate(product, square, basic, {.evaluations = 9000},
                             {.checkpoint = file.path(), .resume = true});
        };
        if (other == version)
            EXPECT_EQ(resume().evaluations, 9000u);
        else
            expect_error("was saved by another version of Montelux", resume);
    }
}
TEST(IntegrateCheckpoint, DamagedFilesAreRefused) {
    const CheckpointFile file;
    const IntegrationOptions resume{.checkpoint = file.path(), .resume = true};
    auto run = [&] { integrate(product, Domain::unit_cube(2), basic, {.evaluations = 9000}, resume); };
    integrate(product, Domain::unit_cube(2), basic, {.evaluations = 5000}, {.checkpoint = file.path()});
    const std::string whole = file.bytes();
    // Cut short anywhere.
    for (std::size_t size = 0; size < whole.size(); size += size < 96 ? 1 : 13) {
        file.replace(whole.substr(0, size));
        expect_error(file.path() + ": is ", run);
    }
    // One wrong bit anywhere.
    for (std::size_t at = 0; at < whole.size(); at += at < 96 ? 1 : 5) {
        std::string wrong = whole;
        wrong[at] = static_cast<char>(wrong[at] ^ 16);
        file.replace(wrong);
        expect_error(file.path() + ": ", run);
    }
    file.replace(whole + "12345678");
    expect_error("is damaged", run);
    file.replace("A text that is no state of anything.");
    expect_error("is not a saved state of Montelux", run);
    file.replace(whole);
    EXPECT_NO_THROW(run());
}
TEST(IntegrateCheckpoint, ADamagedFileGivesAWarningAndThePreviousOneIsUsed) {
    const CheckpointFile file;
    const IntegrationOptions begin{.checkpoint = file.path()};
    const IntegrationOptions resume{.checkpoint = file.path(), .resume = true};
    const Domain square = Domain::unit_cube(2);
    const IntegrationResult uninterrupted = integrate(product, square, basic, {.evaluations = 90'000});
    integrate(product, square, basic, {.evaluations = 16'384}, begin);
    EXPECT_EQ(integrate(product, square, basic, {.evaluations = 32'768}, resume).checkpoint_refused_because,
              "");
    file.replace(file.bytes().substr(0, 200));
    const IntegrationResult rest = integrate(product, square, basic, {.evaluations = 90'000}, resume);
    EXPECT_EQ(rest.value, uninterrupted.value);
    EXPECT_EQ(rest.standard_error, uninterrupted.standard_error);
    EXPECT_EQ(rest.checkpoint_refused_because.find(file.path() + ": is cut short"), 0U);
}
TEST(IntegrateCheckpoint, UnwritableFileIsAnErrorBeforeTheRun) {
    std::atomic<int> calls{0};
    auto f = [&](double x) {
        ++calls;
        return x;
    };
    expect_error("/no/such/folder/state", [&] {
        integrate(f, Domain::interval(0, 1), basic, {}, {.checkpoint = "/no/such/folder/state"});
    });
    EXPECT_EQ(calls, 0);
}

// Reads the state that is written below.
std::vector<double> read_all(StateReader& state) {
    EXPECT_EQ(state.get_word(), 7u);
    EXPECT_EQ(state.get_text(), "twelve bytes");
    return state.get_doubles();
}

TEST(StateReader, EveryStateThatIsCutShortIsRefused) {
    StateWriter written;
    written.put(7u);
    written.put("twelve bytes");
    written.put(std::vector<double>{0.5, -2});
    const std::vector<std::uint64_t> words(written.words().begin(), written.words().end());
    StateReader whole(words);
    EXPECT_EQ(read_all(whole), (std::vector<double>{0.5, -2}));
    EXPECT_TRUE(whole.at_end());
    expect_error("ends too early", [&] { whole.get_word(); });
    for (std::size_t size = 0; size < words.size(); ++size)
        expect_error("ends too early", [&] {
            StateReader cut({words.begin(), words.begin() + static_cast<std::ptrdiff_t>(size)});
            read_all(cut);
        });
}

} // namespace
} // namespace montelux
