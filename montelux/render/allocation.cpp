#include "montelux/render/allocation.h"

#include <algorithm>
#include <cmath>

#include "montelux/mc/math/compensated.h"

namespace montelux {
namespace {

constexpr int radius = 3;               // of the pixels around one
constexpr double least_share = 1.0 / 3; // of the mean number of samples
constexpr double least_growth = 1.1, most_growth = 2;

// Sums over windows of a picture, from a table of all sums from the corner.
class WindowSums {
  public:
    WindowSums(const std::vector<double>& values, int width, int height)
        : width_(width), height_(height),
          sums_(static_cast<std::size_t>(width + 1) * static_cast<std::size_t>(height + 1)) {
        for (int y = 0; y < height; ++y) {
            double row = 0;
            for (int x = 0; x < width; ++x) {
                row += values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                              static_cast<std::size_t>(x)];
                at(x + 1, y + 1) = at(x + 1, y) + row;
            }
        }
    }
    struct Window {
        double sum = 0;
        int count = 0;
    };
    Window around(int x, int y) const {
        const int x0 = std::max(0, x - radius), x1 = std::min(width_, x + radius + 1);
        const int y0 = std::max(0, y - radius), y1 = std::min(height_, y + radius + 1);
        return {at(x1, y1) - at(x0, y1) - at(x1, y0) + at(x0, y0), (x1 - x0) * (y1 - y0)};
    }

  private:
    double& at(int x, int y) { return sums_[index(x, y)]; }
    double at(int x, int y) const { return sums_[index(x, y)]; }
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_ + 1) +
               static_cast<std::size_t>(x);
    }

    int width_, height_;
    std::vector<double> sums_;
};

// Standard deviation of one sample of each pixel, as the pixels around it know it.
std::vector<double> deviations(const Film& film) {
    const int width = film.bounds().width(), height = film.bounds().height();
    std::vector<double> variance;
    variance.reserve(film.pixels().size());
    for (const Pixel& p : film.pixels()) {
        const double error = luminance_error(p);
        variance.push_back(std::isfinite(error) ? error * error * static_cast<double>(p.samples()) : 0);
    }
    const WindowSums sums(variance, width, height);
    std::vector<double> result(variance.size());
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const std::size_t i =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
            const auto [sum, count] = sums.around(x, y);
            result[i] = count > 1 ? std::sqrt(std::max(0.0, sum - variance[i]) / (count - 1))
                                  : std::sqrt(variance[i]); // a picture of one pixel
        }
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
    auto total = [&](double scale) {
        double sum = 0;
        for (std::size_t i = 0; i < n; ++i) sum += goal_of(i, scale);
        return sum;
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
