#include "montelux/view/picture_statistics.h"

#include <algorithm>
#include <cmath>

#include "montelux/image/visible_error.h"

namespace montelux {

namespace {

constexpr std::size_t most_curved = 65536; // tone curves take powers

void count(ErrorHistogram& histogram, double mean, double error) {
    if (!std::isfinite(error) || (!(mean > 0) && error > 0)) {
        ++histogram.infinite;
        return;
    }
    constexpr double width = (ErrorHistogram::most - ErrorHistogram::least) / ErrorHistogram::bins;
    const double place =
        error > 0 ? (double(std::log10(static_cast<float>(error / mean))) - ErrorHistogram::least) / width
                  : 0;
    ++histogram.counts[static_cast<std::size_t>(std::clamp(place, 0.0, double(ErrorHistogram::bins - 1)))];
}

} // namespace

PictureStatistics statistics_of(std::span<const LivePixel> pixels, const ToneCurve& curve) {
    PictureStatistics s;
    double light = 0, variance = 0;
    const std::size_t stride = (pixels.size() + most_curved - 1) / most_curved;
    std::uint64_t visible = 0, curved = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const double mean = luminance(pixels[i].mean), error = luminance(pixels[i].error);
        light += mean;
        variance += error * error;
        s.samples += double(pixels[i].samples);
        count(s.histogram, mean, error);
        if (i % stride != 0) continue;
        visible += error_is_visible(mean, error, curve) ? 1u : 0u;
        ++curved;
    }
    const auto n = static_cast<double>(pixels.size());
    s.samples /= n;
    const double error = std::sqrt(variance / n) / (light / n);
    if (std::isfinite(error)) s.error = error;
    s.visible = curved > 0 ? static_cast<double>(visible) / static_cast<double>(curved) : 1;
    return s;
}

} // namespace montelux
