// The driver of integrations: threads, history, non-finite values, exceptions, arguments, memory.
#include "test/mc/integrate/integrate_testing.h"
#include <chrono>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <string_view>
#include <sys/resource.h>
#include <tuple>
#include <vector>

#include "montelux/mc/integrate/adaptive/adaptive.h"

namespace montelux {
namespace {

using std::chrono::duration;

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

TEST(IntegrateNonFinite, SkippedCountedAndReported) {
    // NaN on a quarter of the square.
    auto f = [](std::span<const double> x) {
        return x[0] < 0.5 && x[1] < 0.5 ? std::numeric_limits<double>::quiet_NaN() : 1.0;
    };
    const IntegrationResult r = integrate(f, Domain::unit_cube(2), basic, {.evaluations = 100'000});
    EXPECT_NEAR(static_cast<double>(r.non_finite), 25'000, 5.5 * std::sqrt(100'000 * 0.25 * 0.75));
    EXPECT_LT(std::abs(r.estimate().z_score(0.75)), 5.5);
    ASSERT_EQ(r.first_non_finite_point.size(), 2u);
    EXPECT_TRUE(std::isnan(f(r.first_non_finite_point)));
    ASSERT_EQ(r.warnings.size(), 1u);
    EXPECT_NE(r.warnings[0].find(std::to_string(r.non_finite) + " of 100000 values"), std::string::npos);
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
TEST(IntegrateNonFinite, OneBadComponentTakesItsPointOutOfAll) {
    auto f = Integrand::vector_valued(3, [](std::span<const double> x, std::span<double> y) {
        y[0] = 1;
        y[1] = x[0] < 0.5 ? std::numeric_limits<double>::quiet_NaN() : 2;
        y[2] = 4;
    });
    const IntegrationResult r = integrate(f, Domain::unit_cube(1), basic, {.evaluations = 10'000});
    EXPECT_EQ(2 * r.value[0], r.value[1]);
    EXPECT_EQ(4 * r.value[0], r.value[2]);
    EXPECT_NEAR(r.value[0], 0.5, 5.5 * 0.005);
}
// Overflow far out, where the integrand has underflowed or almost: in one variable and two, from a finite end and from none.
TEST(IntegrateNonFinite, CountsAsZeroWhereTheIntegrandHasVanishedOnTheWayOut) {
    const double inf = std::numeric_limits<double>::infinity();
    const auto debye = [](double x) { return std::pow(x, 4) * std::exp(x) / std::pow(std::exp(x) - 1, 2); };
    const auto logistic = [](double x) { return std::exp(-x) / std::pow(1 + std::exp(-x), 2); };
    const auto gumbel = [](double x) { return std::exp(x) * std::exp(-std::exp(x)); };
    const auto lognormal = [](std::span<const double> x) {
        return std::exp(x[0] + 2 * x[1]) * std::exp(-0.5 * (x[0] * x[0] + x[1] * x[1]));
    };
    const double exact = 2 * std::numbers::pi * std::exp(2.5);
    for (const auto& [f, domain, value] :
         {std::tuple(Integrand(debye), Domain::interval(0, inf), 4 * std::pow(std::numbers::pi, 4) / 15),
          std::tuple(Integrand(logistic), Domain::interval(-inf, inf), 1.0),
          std::tuple(Integrand(gumbel), Domain::interval(-inf, inf), 1.0),
          std::tuple(Integrand(lognormal), Domain({{-inf, inf}, {-inf, inf}}), exact)})
        for (const Method& method : {Method(), Method(Adaptive())}) {
            const IntegrationResult r = integrate(f, domain, method, {.relative_error = 1e-3});
            EXPECT_TRUE(r.converged()) << r;
            EXPECT_EQ(r.non_finite, 0u);
            EXPECT_LT(std::abs(r.estimate().z_score(value)), 5.5) << r;
        }
    const IntegrationResult noted =
        integrate(debye, Domain::interval(0, inf), basic, {.evaluations = 100'000});
    ASSERT_EQ(noted.notes.size(), 1u);
    EXPECT_TRUE(
        noted.notes[0].starts_with("values far out, where the integrand has vanished, are no numbers"));
}
// NaN that more than nothing may lie behind: a constant, a power, a domain that ends; infinity; a finite range.
TEST(IntegrateNonFinite, IsAWarningWhereTheIntegrandHasNotVanished) {
    const double inf = std::numeric_limits<double>::infinity();
    for (const Integrand& f :
         {Integrand([](double x) { return std::exp(x) / (1 + std::exp(x)); }),
          Integrand([](double x) { return std::exp(x) / (1 + std::exp(x)) / (1 + x * x); }),
          Integrand([](double x) { return std::exp(-x * x) * std::log(5 - x); }),
          Integrand([](double x) { return std::exp(x); })}) {
        const IntegrationResult r = integrate(f, Domain::interval(0, inf), basic, {.evaluations = 100'000});
        EXPECT_GT(r.non_finite, 0u);
        EXPECT_FALSE(r.warnings.empty());
    }
    const auto cut = [](double x) { return x > 1 ? std::numeric_limits<double>::quiet_NaN() : 0.0; };
    EXPECT_GT(integrate(cut, Domain::interval(0, 4), basic, {.evaluations = 1000}).non_finite, 0u);
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
            } catch (const Oops& oops) {
                EXPECT_STREQ(oops.what(), "from the integrand");
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
