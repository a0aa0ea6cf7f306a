#include "montelux/render/allocation.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "montelux/mc/math/compensated.h"
#include "montelux/mc/parallel/parallel_for.h"

namespace montelux {
namespace {

constexpr int radius = 3;               // of the pixels around one
constexpr double least_share = 1.0 / 3; // of the mean number of samples
constexpr double least_growth = 1.1, most_growth = 2;

// Standard deviation of one sample of each pixel, as the pixels around it know it.
std::vector<double> deviations(const Film& film) {
    const int width = film.bounds().width(), height = film.bounds().height();
    std::vector<double> variance(film.pixels().size());
    parallel_for(
        static_cast<std::int64_t>(variance.size()),
        [&](std::int64_t i) {
            const Pixel& p = film.pixels()[static_cast<std::size_t>(i)];
            const double error = luminance_error(p);
            variance[static_cast<std::size_t>(i)] =
                std::isfinite(error) ? error * error * static_cast<double>(p.samples()) : 0;
        },
        nullptr, 1024);
    auto at = [&](int x, int y) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    };
    // Added up anew for each: differences of running sums would let the pixel itself in again by their
    // rounding.
    auto around = [&](int x0, int y0) {
        double sum = 0;
        int count = 0;
        for (int y = std::max(0, y0 - radius); y < std::min(height, y0 + radius + 1); ++y)
            for (int x = std::max(0, x0 - radius); x < std::min(width, x0 + radius + 1); ++x)
                if (x != x0 || y != y0) {
                    sum += variance[at(x, y)];
                    ++count;
                }
        return count > 0 ? sum / count : variance[at(x0, y0)]; // a picture of one pixel
    };
    std::vector<double> result(variance.size());
    parallel_for(height, [&](std::int64_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < width; ++x) result[at(x, y)] = std::sqrt(around(x, y));
    });
    CompensatedSum total;
    for (double s : result) total.add(s);
    const double least = least_share * total.value() / static_cast<double>(result.size());
    for (double& s : result) s = std::max(s, least);
    return result;
}

} // namespace

std::vector<std::uint32_t> allocate(const Film& film, const SampleOrder& order, const RenderTarget& target) {
    const std::vector<double> weight = deviations(film);
    const std::size_t n = weight.size();
    const double pixels = static_cast<double>(n), unit = order.unit();
    CompensatedSum taken, weights;
    for (const Pixel& p : film.pixels()) taken.add(p.samples());
    for (double w : weight) weights.add(w);
    const double most = static_cast<double>(order.share()) * pixels;
    if (taken.value() + unit > most) return {};

    // n_p = scale * weight_p, and no fewer than there are.
    auto goal_of = [&](std::size_t i, double scale) {
        const double wanted = std::min(std::ceil(scale * weight[i] / unit) * unit, 4e9);
        return std::max(static_cast<double>(film.pixels()[i].samples()), wanted);
    };
    // Sums of whole numbers are exact in any order.
    auto total = [&](double scale) {
        constexpr std::size_t run = 4096;
        return parallel_reduce_ordered(
            static_cast<std::int64_t>((n + run - 1) / run),
            [&](std::int64_t r) {
                const std::size_t first = static_cast<std::size_t>(r) * run, last = std::min(n, first + run);
                double sum = 0;
                for (std::size_t i = first; i < last; ++i) sum += goal_of(i, scale);
                return sum;
            },
            std::plus<>());
    };
    // The greatest scale whose total is within a limit.
    auto scale_within = [&](double limit) {
        double low = 0, high = weights.value() > 0 ? 2 * limit / weights.value() : 0;
        for (int i = 0; i < 50; ++i) {
            const double middle = 0.5 * (low + high);
            (total(middle) <= limit ? low : high) = middle;
        }
        return low;
    };
    double limit = std::min(most_growth * taken.value(), most);
    if (target.error > 0 && target.quantile == 0) {
        // Mean over pixels of w^2 / (scale w) = (error * mean luminance)^2.
        const double tolerance = target.error * error_of(film).mean_luminance;
        const double scale = weights.value() / (pixels * tolerance * tolerance);
        if (std::isfinite(scale))
            limit = std::min(limit, std::max(total(scale), std::min(least_growth * taken.value(), most)));
    }
    if (target.error > 0 && target.quantile > 0) {
        const double ratio = error_quantile(film, target.quantile) / target.error;
        limit = std::min(limit, std::max(ratio * ratio, least_growth) * taken.value());
    }
    const double scale = scale_within(limit);
    std::vector<std::uint32_t> goals(n);
    bool more = false;
    for (std::size_t i = 0; i < n; ++i) {
        goals[i] = static_cast<std::uint32_t>(goal_of(i, scale));
        more = more || goals[i] > film.pixels()[i].samples();
    }
    // Units are too large for the limit, or nothing varies: the same for all, as far as that is allowed.
    if (!more) {
        const std::uint64_t room = static_cast<std::uint64_t>((most - taken.value()) / (pixels * unit));
        if (room == 0) return {};
        for (std::size_t i = 0; i < n; ++i) goals[i] = film.pixels()[i].samples() + order.unit();
    }
    return goals;
}

} // namespace montelux
