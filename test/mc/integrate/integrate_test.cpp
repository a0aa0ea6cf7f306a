// The driver of integrations: when it stops and says so, limits, non-finite values, exceptions, checkpoints.
#include <atomic>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <limits>
#include <stdexcept>
#include <sys/resource.h>
#include <thread>

#include "montelux/mc/integrate/basic_monte_carlo.h"
#include "montelux/mc/integrate/integrate.h"
#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

using std::chrono::duration;
using std::chrono::steady_clock;

const Method basic = BasicMonteCarlo{};

double product(std::span<const double> x) { return 4 * x[0] * x[1]; } // 1 over the unit square

double seconds_of(const std::function<void()>& work) {
    const auto begin = steady_clock::now();
    work();
    return duration<double>(steady_clock::now() - begin).count();
}
// The shortest of a few attempts: on a busy machine a run may be kept waiting by others.
double least_seconds_of(double enough, const std::function<void()>& work) {
    double least = seconds_of(work);
    for (int again = 0; again < 4 && least > enough; ++again) least = std::min(least, seconds_of(work));
    return least;
}

// Calls f and expects an Error that contains the text.
void expect_error(const std::string& text, const std::function<void()>& f) {
    try {
        f();
        ADD_FAILURE() << "no error; expected one that says '" << text << "'";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find(text), std::string::npos) << error.what();
    }
}

bool same_but_for_time(const IntegrationResult& a, const IntegrationResult& b) {
    if (a.history.size() != b.history.size()) return false;
    for (std::size_t i = 0; i < a.history.size(); ++i)
        if (a.history[i].evaluations != b.history[i].evaluations ||
            a.history[i].value != b.history[i].value ||
            a.history[i].standard_error != b.history[i].standard_error)
            return false;
    return a.value == b.value && a.standard_error == b.standard_error && a.covariance == b.covariance &&
           a.evaluations == b.evaluations && a.non_finite == b.non_finite &&
           a.first_non_finite_point == b.first_non_finite_point && a.stop == b.stop && a.doubts == b.doubts;
}

// A file name in the folder for temporary files, removed before and after.
class TemporaryFile {
  public:
    explicit TemporaryFile(const std::string& name) : path_(testing::TempDir() + "montelux_" + name) {
        std::filesystem::remove(path_);
    }
    ~TemporaryFile() { std::filesystem::remove(path_); }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    const std::string& path() const { return path_; }

    std::string bytes() const {
        std::ifstream in(path_, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    void replace(const std::string& bytes) const { std::ofstream(path_, std::ios::binary) << bytes; }

  private:
    std::string path_;
};

TEST(IntegrateStop, RelativeError) {
    const IntegrationResult r = integrate(product, Domain::unit_cube(2), basic, {.relative_error = 1e-2});
    EXPECT_EQ(r.stop, StopReason::error_target);
    EXPECT_TRUE(r.converged());
    EXPECT_LE(r.standard_error[0], 1e-2 * r.value[0]);
    EXPECT_LT(std::abs(r.estimate().z_score(1)), 5.5);
    // No later than the step that reached it.
    ASSERT_GE(r.history.size(), 2u);
    const IterationRecord& before = r.history[r.history.size() - 2];
    EXPECT_GT(before.standard_error, 1e-2 * before.value);
}
TEST(IntegrateStop, AbsoluteErrorAndTheLargerOfBoth) {
    auto large = [](std::span<const double> x) { return 100 * product(x); };
    const IntegrationResult a = integrate(large, Domain::unit_cube(2), basic, {.absolute_error = 0.5});
    EXPECT_EQ(a.stop, StopReason::error_target);
    EXPECT_LE(a.standard_error[0], 0.5);
    const IntegrationResult both =
        integrate(large, Domain::unit_cube(2), basic, {.relative_error = 1e-9, .absolute_error = 0.5});
    EXPECT_EQ(both.evaluations, a.evaluations);
}
TEST(IntegrateStop, EveryComponentReachesTheTarget) {
    auto f = Integrand::vector_valued(2, [](std::span<const double> x, std::span<double> y) {
        y[0] = 1;
        y[1] = product(x);
    });
    const IntegrationResult r = integrate(f, Domain::unit_cube(2), basic, {.relative_error = 5e-3});
    EXPECT_EQ(r.stop, StopReason::error_target);
    EXPECT_LE(r.standard_error[1], 5e-3 * r.value[1]);
    EXPECT_GT(r.evaluations, 4096u);
}
TEST(IntegrateStop, EvaluationsAreNeverMoreThanAllowed) {
    for (std::uint64_t limit : {1u, 2u, 3u, 1000u, 4096u, 4097u, 100003u}) {
        std::atomic<std::uint64_t> calls{0};
        auto f = [&](double x) {
            ++calls;
            return x;
        };
        const IntegrationResult r = integrate(f, Domain::interval(0, 1), basic, {.evaluations = limit});
        EXPECT_EQ(r.stop, StopReason::evaluations);
        EXPECT_EQ(r.evaluations, limit);
        EXPECT_EQ(calls, limit);
        EXPECT_FALSE(r.converged());
    }
}
TEST(IntegrateStop, AMillionEvaluationsWhereNothingIsAskedFor) {
    const IntegrationResult r = integrate([](double x) { return x; }, Domain::interval(0, 1), basic);
    EXPECT_EQ(r.evaluations, 1'000'000u);
    EXPECT_EQ(r.stop, StopReason::evaluations);
}
TEST(IntegrateStop, TimeWithAFastIntegrand) {
    IntegrationResult r;
    const double seconds = least_seconds_of(0.7, [&] {
        r = integrate([](double x) { return x; }, Domain::interval(0, 1), basic,
                      {.time = duration<double>(0.5)});
    });
    EXPECT_EQ(r.stop, StopReason::time);
    EXPECT_GE(seconds, 0.3);
    EXPECT_LE(seconds, 0.7);
    EXPECT_GT(r.evaluations, 100'000u);
    EXPECT_LT(std::abs(r.estimate().z_score(0.5)), 5.5);
}
// A step of basic Monte Carlo takes 4096 evaluations at least: here twenty seconds and more.
TEST(IntegrateStop, TimeWithASlowIntegrandShortensTheFirstStep) {
    std::atomic<std::uint64_t> calls{0};
    auto slow = [&](double x) {
        ++calls;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        return x;
    };
    IntegrationResult r;
    const double seconds = least_seconds_of(1.2, [&] {
        calls = 0;
        r = integrate(slow, Domain::interval(0, 1), basic, {.time = duration<double>(1)}, {.threads = 2});
    });
    EXPECT_EQ(r.stop, StopReason::time);
    EXPECT_LE(seconds, 1.2);
    EXPECT_LE(r.evaluations, calls);
    EXPECT_LT(calls, 250u);
    EXPECT_TRUE(std::isfinite(r.standard_error[0]));
    EXPECT_LT(std::abs(r.value[0] - 0.5), 0.25);
}
TEST(IntegrateStop, CancelFromAnotherThread) {
    for (int milliseconds : {0, 10}) { // the time of an evaluation
        auto f = [=](double x) {
            if (milliseconds > 0) std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
            return x;
        };
        IntegrationResult r;
        const double seconds = least_seconds_of(0.6, [&] {
            CancelFlag cancel;
            std::jthread canceller([&] {
                std::this_thread::sleep_for(std::chrono::milliseconds(300));
                cancel.request();
            });
            r = integrate(f, Domain::interval(0, 1), basic, {.relative_error = 1e-9}, {.cancel = &cancel});
        });
        EXPECT_EQ(r.stop, StopReason::cancelled);
        EXPECT_LE(seconds, 0.6);
        if (milliseconds == 0) {
            EXPECT_GT(r.evaluations, 0u);
        } else { // ended within its first step
            EXPECT_EQ(r.evaluations, 0u);
            EXPECT_TRUE(std::isinf(r.standard_error.at(0)));
        }
    }
}
TEST(IntegrateStop, CancelFromProgress) {
    CancelFlag cancel;
    std::uint64_t seen = 0;
    IntegrationOptions options;
    options.cancel = &cancel;
    options.progress = [&](const IntegrationResult& r) {
        EXPECT_GT(r.evaluations, seen);
        EXPECT_EQ(r.history.back().evaluations, r.evaluations);
        seen = r.evaluations;
        if (seen > 50'000) cancel.request();
    };
    const IntegrationResult r = integrate([](double x) { return x; }, Domain::interval(0, 1), basic,
                                          {.relative_error = 1e-9}, options);
    EXPECT_EQ(r.stop, StopReason::cancelled);
    EXPECT_EQ(r.evaluations, seen);
}

// An estimator of a fixed number of steps of ten evaluations.
struct TenSteps {
    static constexpr std::string_view name = "ten steps";
    std::uint64_t evaluations_of_a_step = 10;

    class Steps final : public Estimator {
      public:
        explicit Steps(std::uint64_t size) : size_(size) {}
        StepOutcome step(const StepRequest& request) override {
            if (done_ == 10) return StepOutcome::finished;
            if (request.max_evaluations < size_) return StepOutcome::exhausted;
            ++done_;
            return StepOutcome::advanced;
        }
        Tally tally() const override {
            Tally t;
            t.value = {7};
            t.standard_error = {1};
            t.evaluations = done_ * size_;
            return t;
        }
        void save(StateWriter& state) const override { state.put(done_); }
        void load(StateReader& state) override { done_ = state.get_word(); }

      private:
        std::uint64_t size_, done_ = 0;
    };
    std::unique_ptr<Estimator> estimator(const Problem&) const {
        return std::make_unique<Steps>(evaluations_of_a_step);
    }
};

TEST(IntegrateStop, FinishedAndExhausted) {
    const Domain domain = Domain::interval(0, 1);
    auto f = [](double x) { return x; };
    const IntegrationResult all = integrate(f, domain, TenSteps{}, {.relative_error = 1e-6});
    EXPECT_EQ(all.stop, StopReason::finished);
    EXPECT_EQ(all.evaluations, 100u);
    EXPECT_EQ(all.history.size(), 10u);
    EXPECT_FALSE(all.converged());
    const IntegrationResult some = integrate(f, domain, TenSteps{}, {.evaluations = 55});
    EXPECT_EQ(some.stop, StopReason::evaluations);
    EXPECT_EQ(some.evaluations, 50u);
    expect_error("takes more than 9 evaluations for its first step",
                 [&] { integrate(f, domain, TenSteps{}, {.evaluations = 9}); });
}
TEST(IntegrateStop, ZerosAreNoReasonToBelieveInZero) {
    // A peak that one point in ten thousand hits: the first 4096 points miss it.
    auto peak = [](double x) { return x > 0.6 && x < 0.6001 ? 1e4 : 0.0; };
    std::uint64_t zeros = 0;
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
        const IntegrationResult r =
            integrate(peak, Domain::interval(0, 1), basic, {.relative_error = 0.1}, {.seed = seed});
        EXPECT_NEAR(r.value[0], 1, 0.6);
        zeros += r.history.front().value == 0;
    }
    EXPECT_GE(zeros, 3u);
    const IntegrationResult zero =
        integrate([](double) { return 0.0; }, Domain::interval(0, 1), basic, {.relative_error = 0.1});
    EXPECT_GE(zero.evaluations, 1'000'000u);
    EXPECT_EQ(zero.value[0], 0);
    EXPECT_FALSE(zero.converged());
    ASSERT_EQ(zero.doubts.size(), 1u);
    EXPECT_NE(zero.doubts[0].find("narrow peak"), std::string::npos);
}

TEST(IntegrateThreads, NumberOfThreadsChangesNoBit) {
    IntegrationResult one;
    for (int threads : {1, 2, 3, 8}) {
        const IntegrationResult r = integrate(product, Domain::unit_cube(2), basic, {.evaluations = 300'000},
                                              {.seed = 5, .threads = threads});
        if (threads == 1)
            one = r;
        else
            EXPECT_TRUE(same_but_for_time(one, r)) << threads << " threads";
    }
    const IntegrationResult other =
        integrate(product, Domain::unit_cube(2), basic, {.evaluations = 300'000}, {.seed = 6});
    EXPECT_NE(one.value, other.value);
}

// One evaluation a step.
struct ManySteps {
    static constexpr std::string_view name = "many steps";
    class Many final : public Estimator {
      public:
        StepOutcome step(const StepRequest&) override { return ++done_, StepOutcome::advanced; }
        Tally tally() const override {
            Tally t;
            t.value = {static_cast<double>(done_)};
            t.standard_error = {1};
            t.evaluations = done_;
            return t;
        }
        void save(StateWriter&) const override {}
        void load(StateReader&) override {}

      private:
        std::uint64_t done_ = 0;
    };
    std::unique_ptr<Estimator> estimator(const Problem&) const { return std::make_unique<Many>(); }
};

TEST(IntegrateHistory, IsBounded) {
    const IntegrationResult r =
        integrate([](double x) { return x; }, Domain::interval(0, 1), ManySteps{}, {.evaluations = 100'000});
    EXPECT_LE(r.history.size(), 4096u);
    EXPECT_GE(r.history.size(), 1024u);
    for (std::size_t i = 1; i < r.history.size(); ++i)
        ASSERT_GT(r.history[i].evaluations, r.history[i - 1].evaluations);
    EXPECT_EQ(r.history.back().evaluations, 100'000u);
}

TEST(IntegrateNonFinite, SkippedCountedAndTold) {
    // NaN on a quarter of the square.
    auto f = [](std::span<const double> x) {
        return x[0] < 0.5 && x[1] < 0.5 ? std::numeric_limits<double>::quiet_NaN() : 1.0;
    };
    const IntegrationResult r = integrate(f, Domain::unit_cube(2), basic, {.evaluations = 100'000});
    EXPECT_NEAR(static_cast<double>(r.non_finite), 25'000, 5.5 * std::sqrt(100'000 * 0.25 * 0.75));
    EXPECT_LT(std::abs(r.estimate().z_score(0.75)), 5.5);
    ASSERT_EQ(r.first_non_finite_point.size(), 2u);
    EXPECT_TRUE(std::isnan(f(r.first_non_finite_point)));
    ASSERT_EQ(r.doubts.size(), 1u);
    EXPECT_NE(r.doubts[0].find(std::to_string(r.non_finite) + " of 100000 values"), std::string::npos);
    EXPECT_FALSE(r.converged());
    const IntegrationResult again =
        integrate(f, Domain::unit_cube(2), basic, {.evaluations = 100'000}, {.threads = 1});
    EXPECT_EQ(r.first_non_finite_point, again.first_non_finite_point);
}
TEST(IntegrateNonFinite, OnePointCountsOnceAndInNoComponent) {
    auto f = Integrand::vector_valued(2, [](std::span<const double> x, std::span<double> y) {
        y[0] = x[0] < 0.5 ? std::numeric_limits<double>::infinity() : 1;
        y[1] = x[0] < 0.5 ? std::numeric_limits<double>::quiet_NaN() : 1;
    });
    const IntegrationResult r = integrate(f, Domain::unit_cube(1), basic, {.evaluations = 10'000});
    EXPECT_EQ(r.value[0], r.value[1]);
    EXPECT_NEAR(r.value[0], 0.5, 5.5 * 0.005);
    EXPECT_NEAR(static_cast<double>(r.non_finite), 5000, 5.5 * 50);
}
TEST(IntegrateNonFinite, ThrowingPolicyNamesThePoint) {
    auto f = [](double x) { return x > 0.5 ? std::numeric_limits<double>::infinity() : 1.0; };
    expect_error("the integrand is inf at (0.", [&] {
        integrate(f, Domain::interval(0, 1), basic, {}, {.non_finite = NonFinitePolicy::throw_error});
    });
}
TEST(IntegrateNonFinite, NowhereFiniteIsAnError) {
    expect_error("none of the 4096 values of the integrand is a finite number", [] {
        integrate([](double x) { return std::sqrt(-1 - x); }, Domain::interval(0, 1), basic);
    });
}

struct Oops : std::runtime_error {
    using std::runtime_error::runtime_error;
};

TEST(IntegrateExceptions, PassThroughFromAnyThread) {
    for (int threads : {1, 4})
        for (double where : {0.0, 0.9999}) { // at once, and after a while
            auto f = [=](double x) -> double {
                if (x > where) throw Oops("from the integrand");
                return 1;
            };
            try {
                integrate(f, Domain::interval(0, 1), basic, {}, {.threads = threads});
                ADD_FAILURE() << "nothing was thrown";
            } catch (const Oops& e) {
                EXPECT_STREQ(e.what(), "from the integrand");
            }
        }
    EXPECT_THROW(integrate(
                     [](double x) -> double {
                         if (x > 0.5) throw 3;
                         return x;
                     },
                     Domain::interval(0, 1), basic),
                 int);
}
TEST(IntegrateExceptions, OfProgressPassToo) {
    EXPECT_THROW(integrate([](double x) { return x; }, Domain::interval(0, 1), basic, {},
                           {.progress = [](const IntegrationResult&) { throw Oops("from progress"); }}),
                 Oops);
}
TEST(IntegrateExceptions, AnIntegrandMayIntegrate) {
    auto inner = [](double x) {
        return integrate([x](double y) { return x * y; }, Domain::interval(0, 2), basic, {.evaluations = 64})
            .value[0];
    };
    const IntegrationResult r = integrate(inner, Domain::interval(0, 1), basic, {.evaluations = 4096});
    EXPECT_NEAR(r.value[0], 1, 0.3); // 64 points in each of the inner ones, always the same
}

TEST(IntegrateArguments, ThatMakeNoSenseAreRefused) {
    const Domain line = Domain::interval(0, 1);
    auto f = [](double x) { return x; };
    const double nan = std::numeric_limits<double>::quiet_NaN(),
                 inf = std::numeric_limits<double>::infinity();
    expect_error("relative error asked for is -1",
                 [&] { integrate(f, line, basic, {.relative_error = -1}); });
    expect_error("relative error asked for is nan",
                 [&] { integrate(f, line, basic, {.relative_error = nan}); });
    expect_error("absolute error asked for is inf",
                 [&] { integrate(f, line, basic, {.absolute_error = inf}); });
    expect_error("time", [&] { integrate(f, line, basic, {.time = duration<double>(-1)}); });
    expect_error("threads", [&] { integrate(f, line, basic, {}, {.threads = -1}); });
    expect_error("without a checkpoint", [&] { integrate(f, line, basic, {}, {.resume = true}); });
    expect_error("has 2 dimensions", [&] { integrate(f, Domain::unit_cube(2), basic); });
    expect_error("at least one component", [&] {
        integrate(Integrand::vector_valued(0, [](std::span<const double>, std::span<double>) {}), line,
                  basic);
    });
    expect_error("there is no method 'vegsa'; expected one of", [] { Method::named("vegsa"); });
    EXPECT_GE(Method::names().size(), 1u);
    for (std::string_view name : Method::names()) EXPECT_EQ(Method::named(name).name(), name);
}

TEST(IntegrateCheckpoint, ResumedRunHasTheBitsOfAnUnbrokenOne) {
    const Budget budget{.evaluations = 400'000};
    const Integrand f = Integrand::vector_valued(2, [](std::span<const double> x, std::span<double> y) {
        y[0] = product(x);
        y[1] = x[0] < 0.001 ? std::numeric_limits<double>::quiet_NaN() : x[1];
    });
    const IntegrationResult unbroken = integrate(f, Domain::unit_cube(2), basic, budget, {.seed = 3});
    for (std::uint64_t stop_at : {1u, 10'000u, 100'000u, 250'000u}) {
        const TemporaryFile file("resume");
        CancelFlag cancel;
        IntegrationOptions options{.seed = 3, .cancel = &cancel, .checkpoint = file.path()};
        options.progress = [&](const IntegrationResult& r) {
            if (r.evaluations >= stop_at) cancel.request();
        };
        const IntegrationResult part = integrate(f, Domain::unit_cube(2), basic, budget, options);
        EXPECT_EQ(part.stop, StopReason::cancelled);
        EXPECT_LT(part.evaluations, budget.evaluations);
        const IntegrationResult rest =
            integrate(f, Domain::unit_cube(2), basic, budget,
                      {.seed = 3, .threads = 3, .checkpoint = file.path(), .resume = true});
        EXPECT_TRUE(same_but_for_time(rest, unbroken)) << "stopped at " << stop_at;
        // The state was saved with the time until then; writing it may take longer than all the rest.
        ASSERT_FALSE(part.history.empty());
        EXPECT_GE(rest.seconds, part.history.back().seconds);
        // Once more from the end: nothing is left to do.
        const IntegrationResult end = integrate(f, Domain::unit_cube(2), basic, budget,
                                                {.seed = 3, .checkpoint = file.path(), .resume = true});
        EXPECT_TRUE(same_but_for_time(end, unbroken));
    }
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
        const IntegrationResult unbroken = integrate(peak, Domain::unit_cube(2), method, budget, {.seed = 4});
        EXPECT_LE(unbroken.evaluations, budget.evaluations) << name;
        for (int stop_at : {500, 5000, 20'000, 45'000}) {
            const TemporaryFile file("every_method");
            CancelFlag cancel;
            std::atomic<int> calls{0};
            auto f = [&](std::span<const double> x) {
                if (++calls == stop_at) cancel.request();
                return peak(x);
            };
            const IntegrationResult part =
                integrate(f, Domain::unit_cube(2), method, budget,
                          {.seed = 4, .cancel = &cancel, .checkpoint = file.path()});
            if (part.stop != StopReason::cancelled) continue; // had done all it wanted
            const IntegrationResult rest = integrate(peak, Domain::unit_cube(2), method, budget,
                                                     {.seed = 4, .checkpoint = file.path(), .resume = true});
            EXPECT_TRUE(same_but_for_time(rest, unbroken)) << name << " stopped at " << stop_at;
        }
    }
}
TEST(IntegrateCheckpoint, IsWrittenWhileTheRunGoesOn) {
    const TemporaryFile file("periodic");
    std::size_t times = 0;
    IntegrationOptions options{.checkpoint = file.path(), .checkpoint_every = duration<double>(0)};
    options.progress = [&](const IntegrationResult&) { times += std::filesystem::exists(file.path()); };
    integrate(product, Domain::unit_cube(2), basic, {.evaluations = 50'000}, options);
    EXPECT_GE(times, 2u);
}
TEST(IntegrateCheckpoint, ResumeWithoutAFileBeginsAnew) {
    const TemporaryFile file("fresh");
    const IntegrationResult r = integrate(product, Domain::unit_cube(2), basic, {.evaluations = 10'000},
                                          {.checkpoint = file.path(), .resume = true});
    EXPECT_EQ(r.evaluations, 10'000u);
    EXPECT_TRUE(std::filesystem::exists(file.path()));
}
TEST(IntegrateCheckpoint, OfAnotherProblemIsRefused) {
    const TemporaryFile file("other");
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
TEST(IntegrateCheckpoint, DamagedFilesAreRefused) {
    const TemporaryFile file("damaged");
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
TEST(IntegrateCheckpoint, UnwritableFileIsToldBeforeTheWork) {
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

double peak_mebibytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) / 1024;
}

TEST(IntegrateSlowTest, ABillionEvaluationsInConstantMemory) {
    auto f = Integrand::batch([](const PointBatch& x, ValueBatch y) {
        for (std::size_t i = 0; i < x.count(); ++i) y(i) = x(i, 0);
    });
    integrate(f, Domain::interval(0, 1), basic, {.evaluations = 10'000'000});
    const double before = peak_mebibytes();
    const IntegrationResult r = integrate(f, Domain::interval(0, 1), basic, {.evaluations = 1'000'000'000});
    EXPECT_EQ(r.evaluations, 1'000'000'000u);
    EXPECT_LT(std::abs(r.estimate().z_score(0.5)), 5.5);
    EXPECT_NEAR(r.standard_error[0], std::sqrt(1.0 / 12 / 1e9), 1e-9);
    EXPECT_LT(peak_mebibytes() - before, 8);
    EXPECT_LE(r.history.size(), 4096u);
}

} // namespace
} // namespace montelux
