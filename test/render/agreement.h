// Pictures of methods that trace light against those of path tracing.
//
// Means of pictures are compared by Student's test of 16 seeds at 7 standard errors (two-sided: 4e-6 each).
#pragma once

#include "test/render/seed_means.h"
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <gtest/gtest.h>
#include <string>
#include <vector>

namespace montelux::testing {

// Of two sets of renders with the same number of seeds.
struct Agreement {
    double bias = 0;                // largest of the channels, relative
    double error = 0;               // its standard error, relative
    double sigmas = 0;              // largest of the channels
    double squares = 0, pixels = 0; // of the pixels' differences over their errors
};
inline Agreement agreement_of(const SeedMeans& a, const SeedMeans& b) {
    Agreement r;
    for (std::size_t c = 0; c < 3; ++c) {
        const double mean = a.channel[c].mean(), difference = std::abs(b.channel[c].mean() - mean),
                     error = std::hypot(a.channel[c].standard_error(), b.channel[c].standard_error());
        r.sigmas = std::max(r.sigmas, difference / error);
        r.bias = std::max(r.bias, difference / mean);
        r.error = std::max(r.error, error / mean);
    }
    for (std::size_t p = 0; p < a.films[0].pixels().size(); ++p) {
        double difference = 0, variance = 0;
        for (std::size_t i = 0; i < a.films.size(); ++i) {
            const SkewMoments<3>&x = a.films[i].pixels()[p].replicates(),
                  &y = b.films[i].pixels()[p].replicates();
            difference += x.mean(1) - y.mean(1);
            variance += x.variance_of_mean(1) + y.variance_of_mean(1);
        }
        if (!(variance > 0)) continue;
        r.squares += difference * difference / variance;
        ++r.pixels;
    }
    return r;
}

struct AgreementCase {
    std::string name;
    SceneBuilder scene;
    IntegratorKind method = IntegratorKind::bidirectional;
    std::uint32_t samples = 48; // per pixel and seed, in the fast tests
};
inline constexpr IntegratorKind by_light = IntegratorKind::light_tracing;

// Each case has seeds of its own. Light tracing takes twice as many samples.
inline Agreement agreement_in(const AgreementCase& c, std::size_t number, std::uint32_t samples) {
    SceneDescription d = c.scene.description;
    d.sampler.seed = 1000 * number;
    return agreement_of(render_of_seeds(d, IntegratorKind::path, samples),
                        render_of_seeds(d, c.method, (c.method == by_light ? 2 : 1) * samples));
}

// Pooled over cases with names, the pixels differ by as much as their errors say; `agreement` of a case and its number.
// Heavy tails, of caustics with few samples, widen the differences a little: `most_ratio`.
template <typename Case, typename AgreementOf>
void expect_pooled_agreement(const std::vector<Case>& cases, const AgreementOf& agreement, double most_error,
                             double most_ratio) {
    double squares = 0, pixels = 0;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const Agreement r = agreement(cases[i], i);
        EXPECT_LT(r.sigmas, 7) << cases[i].name << ": " << 100 * r.bias << " %";
        EXPECT_LT(r.error, most_error) << cases[i].name;
        squares += r.squares;
        pixels += r.pixels;
    }
    EXPECT_GT(std::sqrt(squares / pixels), 0.9);
    EXPECT_LT(std::sqrt(squares / pixels), most_ratio);
}

inline void expect_agreement_of(const std::vector<AgreementCase>& cases, double most_error = 0.03,
                                double most_ratio = 1.1) {
    expect_pooled_agreement(
        cases, [](const AgreementCase& c, std::size_t i) { return agreement_in(c, i, c.samples); },
        most_error, most_ratio);
}

} // namespace montelux::testing
