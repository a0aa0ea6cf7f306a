// Chains that start among weighted points, combined with these: unbiased from the first state on.
#include "test/significance.h"
#include <cmath>
#include <gtest/gtest.h>
#include <vector>

#include "montelux/mc/integrate/metropolis/acceptance.h"
#include "montelux/mc/integrate/metropolis/chain_agreement.h"
#include "montelux/mc/integrate/metropolis/chain_trace.h"
#include "montelux/mc/integrate/metropolis/chain_weights.h"
#include "montelux/mc/random/primary_sample_stream.h"
#include "montelux/mc/stats/z_test.h"

namespace montelux {
namespace {

// A narrow peak, a wide one, and nothing between them that small steps cross: chains never converge.
double two_peaks(double x) {
    if (x < 0.02) return 20;
    return x > 0.5 && x < 0.6 ? 1 : 0;
}
constexpr double integral = 0.5; // 0.02 * 20 + 0.1

PrimarySamples start(std::uint64_t seed, std::uint64_t i) {
    PrimarySamples samples(PhiloxStream(hash_key(seed, i, 0)));
    samples.propose_large();
    samples.sample(0);
    return samples;
}

// One estimate: 16 points, 2 chains of 40 states, a tenth large steps; 0 where no point has f > 0 but for the uniform
// ones.
double estimate(std::uint64_t seed, double scale) {
    constexpr int points = 16, chains = 2, states = 40;
    constexpr double large_steps = 0.1;
    const ChainWeights weights{chains * states / scale, points + chains * states * large_steps};
    PhiloxStream numbers(hash_key(seed));
    std::vector<double> x, cdf;
    double sum = 0, total = 0;
    for (int i = 0; i < points; ++i) {
        x.push_back(start(seed, i).sample(0));
        const double f = two_peaks(x.back());
        cdf.push_back(sum += f);
        total += f * weights(f);
    }
    const double correction = sum / points / scale;
    const double offset = numbers.next_double();
    for (int c = 0; c < chains; ++c) {
        std::size_t i = 0;
        while (sum > 0 && cdf[i] < sum * (offset + c) / chains) ++i;
        PrimarySamples samples = start(seed, i);
        double current = two_peaks(samples.sample(0));
        samples.accept();
        samples.set_numbers(PhiloxStream(hash_key(seed, c, 1)));
        for (int t = 0; t < states; ++t) {
            const bool large = samples.numbers().next_double() < large_steps;
            if (!large && !(sum > 0)) continue;
            if (large)
                samples.propose_large();
            else
                samples.propose_small(SmallStep(0.1));
            const double f = two_peaks(samples.sample(0));
            if (large) total += f * weights(f);
            if (!(sum > 0)) continue;
            const double a = acceptance_of_densities(current, f);
            total += correction * (a * f * weights(f) + (1 - a) * current * weights(current));
            if (!(samples.numbers().next_double() < a)) continue;
            samples.accept();
            current = f;
        }
    }
    return total;
}

// Whatever the scale: too small, right, too large.
TEST(ChainWeights, UnbiasedBeforeConvergence) {
    for (const double scale : {0.1, 0.5, 3.0}) {
        RunningMoments estimates;
        for (std::uint64_t seed = 0; seed < 40000; ++seed) estimates.add(estimate(seed, scale));
        EXPECT_GT(unbiasedness_test(estimates, integral).p_value, significance)
            << scale << ": " << estimates.mean() << " +- " << estimates.standard_error();
        EXPECT_LT(estimates.standard_error(), 0.01 * integral);
    }
}

// As the traces of whole chains say it.
TEST(ChainAgreement, IsSplitRHat) {
    PhiloxStream numbers(2);
    std::vector<ChainTrace> traces;
    ChainAgreement<2> agreement, first, second;
    for (int c = 0; c < 6; ++c) {
        traces.emplace_back(2);
        double walk = c;
        for (int half = 0; half < 2; ++half) {
            ChannelMoments<2> moments;
            for (int t = 0; t < 256; ++t) {
                walk = 0.95 * walk + numbers.next_double() - 0.5;
                const std::array<double, 2> values{walk, numbers.next_double()};
                traces.back().add(values);
                moments.add(values);
            }
            agreement.add(moments);
            (c < 2 ? first : second).add(moments);
        }
    }
    first.merge(second);
    EXPECT_EQ(agreement.halves(), 12u);
    for (int k = 0; k < 2; ++k) {
        EXPECT_NEAR(agreement.r_hat(k), split_r_hat(traces, k), 1e-9);
        EXPECT_NEAR(first.r_hat(k), agreement.r_hat(k), 1e-9);
    }
    EXPECT_GT(agreement.r_hat(0), 1.05);
    EXPECT_LT(agreement.r_hat(1), 1.02);
    EXPECT_EQ(agreement.worst_r_hat(), agreement.r_hat(0));
}

} // namespace
} // namespace montelux
