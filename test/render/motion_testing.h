// Blurred pictures against those of scenes that stand still.
#pragma once

#include "test/render/scene_testing.h"
#include <functional>
#include <gtest/gtest.h>

namespace montelux::testing {

// z-values of the pixels of a blurred picture against the mean of `frames` pictures at the middles of equal
// parts of the time.
inline void expect_mean_of_frames(const SceneDescription& blurred,
                                  const std::function<SceneDescription(float)>& at) {
    constexpr int frames = 64;
    const Film film = render(blurred);
    const int width = film.bounds().width(), height = film.bounds().height();
    std::vector<double> mean(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)),
        variance = mean;
    for (int i = 0; i < frames; ++i) {
        SceneDescription d = at((static_cast<float>(i) + 0.5f) / frames);
        d.sampler.seed = 1000 + static_cast<std::uint64_t>(i);
        const Film frame = render(d);
        for (std::size_t k = 0; k < mean.size(); ++k) {
            const auto& r = frame.pixels()[k].replicates();
            mean[k] += r.mean(1) / frames;
            variance[k] += r.variance_of_mean(1) / (frames * frames);
        }
    }
    double sum = 0, total = 0, total_variance = 0;
    for (std::size_t k = 0; k < mean.size(); ++k) {
        const auto& r = film.pixels()[k].replicates();
        const double z = (r.mean(1) - mean[k]) / std::sqrt(r.variance_of_mean(1) + variance[k] + 1e-8);
        sum += z * z;
        total += r.mean(1) - mean[k];
        total_variance += r.variance_of_mean(1) + variance[k];
    }
    const auto n = static_cast<double>(mean.size());
    EXPECT_LT(std::abs(total), 5 * std::sqrt(total_variance));
    EXPECT_NEAR(sum / n, 1, 5 * std::sqrt(2 / n) + 0.15); // frames are not the whole of the time
}

} // namespace montelux::testing
