// Integrals whose points are dealt out to ranks: the digits of one process, errors passed on, ranks that
// hang.
#include "test/cluster/local_job.h"
#include <cmath>
#include <gtest/gtest.h>
#include <thread>

#include "montelux/cluster/shared_integrand.h"
#include "montelux/mc/integrate/integrate.h"
#include "montelux/mc/math/error.h"

namespace montelux::testing {
namespace {

void wavy(const PointBatch& x, ValueBatch y) {
    for (std::size_t i = 0; i < x.count(); ++i) {
        y(i, 0) = std::sin(3 * x(i, 0)) * std::exp(-x(i, 1));
        y(i, 1) = x(i, 0) * x(i, 1);
    }
}

struct Ranks {
    Ranks(LocalJob& job, const BatchFunction& f, int ranks) {
        for (int r = 1; r < ranks; ++r)
            threads.emplace_back([&job, f, r] { serve_integrand(job.mailbox(r), f, 2, r, nullptr, 60); });
    }
    ~Ranks() {
        for (std::thread& t : threads) t.join();
    }
    std::vector<std::thread> threads;
};

TEST(SharedIntegrand, AnyNumberOfRanksGivesTheSameDigits) {
    const Domain domain{{0, 2}, {0, 1}};
    for (const char* name : {"basic", "vegas", "cubature", "quasi", "adaptive"}) {
        const Method method = Method::named(name);
        const Budget budget{.evaluations = 60'000};
        const IntegrationResult alone =
            integrate(Integrand::batch(wavy, 2), domain, method, budget, {.seed = 5, .threads = 1});
        for (int ranks = 1; ranks <= 4; ++ranks) {
            LocalJob job(ranks);
            std::atomic<std::uint64_t> elsewhere{0};
            const auto counted = [&](const PointBatch& x, ValueBatch y) {
                elsewhere += x.count();
                wavy(x, y);
            };
            const Ranks helpers(job, counted, ranks);
            SharedIntegrand shared(job.mailbox(0), wavy, 2, 0);
            EXPECT_EQ(shared.threads(), ranks * (ranks - 1) / 2);
            IntegrationResult result;
            shared.lead([&] {
                result =
                    integrate(Integrand::batch([&](const PointBatch& x, ValueBatch y) { shared(x, y); }, 2),
                              domain, method, budget, {.seed = 5, .threads = shared.threads()});
            });
            EXPECT_EQ(result.value, alone.value) << name << " on " << ranks;
            EXPECT_EQ(result.standard_error, alone.standard_error) << name << " on " << ranks;
            EXPECT_EQ(result.evaluations, alone.evaluations);
            // With no thread of its own the first rank has all done elsewhere, but where it is alone.
            EXPECT_EQ(elsewhere > 0, ranks > 1);
        }
    }
}

TEST(SharedIntegrand, ErrorsOfRanksArePassedOn) {
    LocalJob job(2);
    const Ranks helpers(
        job, [](const PointBatch&, ValueBatch) { throw Error("formula", "no value here"); }, 2);
    SharedIntegrand shared(job.mailbox(0), wavy, 2, 0);
    PointBuffer x(8, 2);
    ValueBuffer y(8, 2);
    for (int d = 0; d < 2; ++d) std::ranges::fill(x.coordinate(d), 0.5);
    try {
        shared.lead([&] { shared(x, y); });
        FAIL() << "nothing was thrown";
    } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find("no value here"), std::string::npos);
    }
    EXPECT_FALSE(shared.failed());
}

TEST(SharedIntegrand, SilentRanksAreGivenUp) {
    LocalJob job(2);
    EXPECT_THROW(SharedIntegrand(job.mailbox(0), wavy, 2, 1, 0.1), Error);
}

// The rank sends its hello and nothing else. A caller that waits for its batch must get an error, not values.
TEST(SharedIntegrand, OpenBatchesOfSilentRanksFail) {
    LocalJob job(2);
    FailingMailbox failing(job.mailbox(1), std::nullopt, 1);
    std::thread helper([&] { serve_integrand(failing, wavy, 2, 1, nullptr, 60); });
    const PointBuffer x(8, 2);
    ValueBuffer y(8, 2);
    {
        SharedIntegrand shared(job.mailbox(0), wavy, 2, 0, 0.3);
        EXPECT_THROW(shared.lead([&] { shared(x, y); }), Error);
        EXPECT_TRUE(shared.failed());
    }
    helper.join();
}

} // namespace
} // namespace montelux::testing
