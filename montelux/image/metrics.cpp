#include "montelux/image/metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "montelux/image/variance_pool.h"
#include "montelux/mc/math/compensated.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/stats/moments.h"
#include "montelux/mc/stats/skew_moments.h"

namespace montelux {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::string size_of(const Image& image) {
    return std::to_string(image.width()) + " x " + std::to_string(image.height());
}

bool finite_pixel(const MeasuredPicture& p, int x, int y) {
    for (std::size_t c = 0; c < p.channels.size(); ++c)
        if (!std::isfinite(p.value(x, y, static_cast<int>(c)))) return false;
    return true;
}

// Pixels that count: finite in both, and not among the noisiest.
std::vector<bool> choose_pixels(const MeasuredPicture& a, const MeasuredPicture& b, double percent,
                                Comparison& result) {
    int width = a.image->width(), height = a.image->height(), channels = static_cast<int>(a.channels.size());
    std::vector<bool> chosen(a.image->pixel_count());
    std::vector<std::size_t> order;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            if (finite_pixel(a, x, y) && finite_pixel(b, x, y)) {
                order.push_back(static_cast<std::size_t>(y) * width + x);
                chosen[order.back()] = true;
            }
    result.not_finite = chosen.size() - order.size();
    result.set_aside =
        static_cast<std::uint64_t>(std::floor(percent / 100 * static_cast<double>(order.size())));
    result.pixels = order.size() - result.set_aside;
    if (result.set_aside == 0) return chosen;

    const MeasuredPicture& source = b.has_error() ? b : a;
    auto brightness = [&](std::size_t pixel) {
        double sum = 0;
        for (int c = 0; c < channels; ++c)
            sum +=
                std::abs(source.value(static_cast<int>(pixel % width), static_cast<int>(pixel / width), c));
        return sum;
    };
    CompensatedSum total;
    for (std::size_t pixel : order) total.add(brightness(pixel));
    double floor = 1e-3 * total.value() / static_cast<double>(order.size());
    std::vector<double> noise(chosen.size());
    for (std::size_t pixel : order) {
        double error = 0;
        for (int c = 0; c < channels; ++c)
            error +=
                source.standard_error(static_cast<int>(pixel % width), static_cast<int>(pixel / width), c);
        double relative = error == 0 ? 0 : error / (brightness(pixel) + floor);
        noise[pixel] = std::isnan(relative) ? std::numeric_limits<double>::infinity() : relative;
    }
    auto noisier = [&](std::size_t i, std::size_t j) {
        return noise[i] != noise[j] ? noise[i] > noise[j] : i > j;
    };
    auto end = order.begin() + static_cast<std::ptrdiff_t>(result.set_aside);
    std::nth_element(order.begin(), end, order.end(), noisier);
    for (auto it = order.begin(); it != end; ++it) chosen[*it] = false;
    return chosen;
}

// Variance of a - b in one channel, by rows, from the known errors; negative where it is not usable.
std::vector<double> difference_variances(const MeasuredPicture& a, const MeasuredPicture& b, int c) {
    int width = a.image->width(), height = a.image->height();
    std::vector<double> variances(a.image->pixel_count());
    for (const MeasuredPicture* p : {&a, &b}) {
        if (!p->has_error()) continue;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                double& variance = variances[static_cast<std::size_t>(y) * width + x];
                double s = p->standard_error(x, y, c);
                if (!(s >= 0) || !std::isfinite(s))
                    variance = -1;
                else if (variance >= 0)
                    variance += s * s;
            }
    }
    return variances;
}

class ZCollector {
  public:
    // `skewness` is that of the difference.
    void add(double difference, double variance, double skewness = 0) {
        if (variance < 0) {
            ++z_.invalid_errors;
        } else if (variance == 0) {
            ++(difference == 0 ? z_.equal_without_error : z_.unexplained);
        } else {
            double z = skew_corrected_z(difference / std::sqrt(variance), skewness), magnitude = std::abs(z);
            moments_.add(z);
            for (int k = 0; k < 3; ++k) inside_[k] += magnitude <= k + 1;
            z_.largest = std::max(z_.largest, magnitude);
        }
    }

    ZScores finish() const {
        ZScores z = z_;
        z.count = moments_.count();
        z.mean = z.count > 0 ? moments_.mean() : nan;
        z.standard_deviation = z.count > 1 ? moments_.standard_deviation() : nan;
        for (int k = 0; k < 3; ++k)
            z.within[k] = z.count > 0 ? static_cast<double>(inside_[k]) / static_cast<double>(z.count) : nan;
        return z;
    }

  private:
    ZScores z_;
    RunningMoments moments_;
    std::array<std::uint64_t, 3> inside_{};
};

} // namespace

MeasuredPicture measured_picture(const std::string& name, const Image& image) {
    MeasuredPicture p{name, &image, image.color_channels(), nullptr, {}, image.color_channels("skewness.")};
    if (p.channels.empty()) throw Error(name, "has neither the channels R, G, B nor Y");
    if (p.skewness_channels.size() != p.channels.size()) p.skewness_channels.clear();
    auto errors = image.color_channels("stderr.");
    if (errors.size() == p.channels.size()) {
        p.error = &image;
        p.error_channels = errors;
    }
    return p;
}

MeasuredPicture measured_picture(const std::string& name, const Image& image, const std::string& error_name,
                                 const Image& error) {
    MeasuredPicture p = measured_picture(name, image);
    if (error.width() != image.width() || error.height() != image.height())
        throw Error(error_name, "is " + size_of(error) +
                                    " pixels, but the picture whose errors it should hold, " + name +
                                    ", is " + size_of(image));
    p.error = &error;
    p.error_channels = error.color_channels("stderr.");
    if (p.error_channels.empty()) p.error_channels = error.color_channels();
    if (p.error_channels.size() != p.channels.size())
        throw Error(error_name, "has no standard error for each of the " + std::to_string(p.channels.size()) +
                                    " colour channels of " + name);
    return p;
}

Comparison compare_pictures(const MeasuredPicture& a, const MeasuredPicture& b,
                            const ComparisonOptions& options) {
    if (a.image->width() != b.image->width() || a.image->height() != b.image->height())
        throw Error("compare", a.name + " is " + size_of(*a.image) + " pixels, but " + b.name + " is " +
                                   size_of(*b.image));
    if (a.channels.size() != b.channels.size())
        throw Error("compare", (a.channels.size() == 1 ? a.name : b.name) + " is grey, but " +
                                   (a.channels.size() == 1 ? b.name : a.name) + " is in colour");
    if (!(options.relative_epsilon > 0))
        throw Error("compare", "the epsilon of the relative error must be positive");
    if (!(options.set_aside_percent >= 0) || options.set_aside_percent >= 100)
        throw Error("compare", "the share to set aside must be at least 0 and below 100 per cent");
    if (options.set_aside_percent > 0 && !a.has_error() && !b.has_error())
        throw Error("compare", "pixels can only be set aside for their noise when standard errors are known");

    Comparison result;
    result.a_has_error = a.has_error();
    result.b_has_error = b.has_error();
    std::vector<bool> chosen = choose_pixels(a, b, options.set_aside_percent, result);
    if (result.pixels == 0) throw Error("compare", "there is no pixel that is finite in both pictures");

    bool any_error = a.has_error() || b.has_error();
    double n = static_cast<double>(result.pixels);
    ZCollector scores, corrected, pooled_scores;
    result.skew_known = any_error && !(a.skewness_channels.empty() && b.skewness_channels.empty());
    CompensatedSum all_squares, all_relative;
    for (int c = 0; c < static_cast<int>(a.channels.size()); ++c) {
        CompensatedSum sum_a, sum_b, squares, relative, variance_sum;
        std::vector<double> variances, pooled;
        if (any_error) {
            variances = difference_variances(a, b, c);
            pooled = pool_variances(variances, a.image->width(), a.image->height());
        }
        for (int y = 0; y < a.image->height(); ++y)
            for (int x = 0; x < a.image->width(); ++x) {
                std::size_t pixel = static_cast<std::size_t>(y) * a.image->width() + x;
                if (!chosen[pixel]) continue;
                double va = a.value(x, y, c), vb = b.value(x, y, c), d = va - vb;
                sum_a.add(va);
                sum_b.add(vb);
                squares.add(d * d);
                relative.add(d * d / (vb * vb + options.relative_epsilon));
                if (!any_error) continue;
                double variance = variances[pixel];
                scores.add(d, variance);
                // Equal samples without error have no score here either.
                pooled_scores.add(d, variance == 0 && d == 0 ? 0 : pooled[pixel]);
                if (result.skew_known) {
                    double cumulant = a.third_cumulant(x, y, c) - b.third_cumulant(x, y, c);
                    corrected.add(d, variance,
                                  variance > 0 ? cumulant / (variance * std::sqrt(variance)) : 0);
                }
                variance_sum.add(std::max(variance, 0.0));
            }
        ChannelComparison channel;
        channel.name = a.image->channel_names()[a.channels[c]];
        channel.mean_a = sum_a.value() / n;
        channel.mean_b = sum_b.value() / n;
        channel.relative_mean_difference =
            channel.mean_b != 0 ? (channel.mean_a - channel.mean_b) / channel.mean_b : nan;
        channel.mean_difference_error = any_error ? std::sqrt(variance_sum.value()) / n : nan;
        channel.rmse = std::sqrt(squares.value() / n);
        channel.rel_mse = relative.value() / n;
        result.channels.push_back(channel);
        all_squares.add(squares);
        all_relative.add(relative);
    }
    double samples = n * static_cast<double>(a.channels.size());
    result.rmse = std::sqrt(all_squares.value() / samples);
    result.rel_mse = all_relative.value() / samples;
    if (any_error) {
        result.z = scores.finish();
        result.pooled = pooled_scores.finish();
    }
    if (result.skew_known) result.skew_corrected = corrected.finish();
    return result;
}

ChannelSummary summarize_channel(const Image& image, int channel) {
    ChannelSummary s;
    s.minimum = std::numeric_limits<double>::infinity();
    s.maximum = -s.minimum;
    CompensatedSum sum;
    std::size_t step = static_cast<std::size_t>(image.channels());
    for (std::size_t i = static_cast<std::size_t>(channel); i < image.sample_count(); i += step) {
        double v = static_cast<double>(image.value_at(i));
        s.nan += std::isnan(v);
        s.infinite += std::isinf(v);
        s.negative += v < 0;
        if (!std::isfinite(v)) continue;
        ++s.finite;
        sum.add(v);
        s.minimum = std::min(s.minimum, v);
        s.maximum = std::max(s.maximum, v);
    }
    s.mean = sum.value() / static_cast<double>(s.finite);
    if (s.finite == 0) s.minimum = s.mean = s.maximum = nan;
    return s;
}

} // namespace montelux
