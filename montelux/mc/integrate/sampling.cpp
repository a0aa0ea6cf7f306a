#include "montelux/mc/integrate/sampling.h"

#include <array>
#include <cmath>

#include "montelux/mc/device/device_job.h"
#include "montelux/mc/math/error.h"

namespace montelux {

void SampleMoments::add(const ValueBuffer& values) {
    const std::size_t n = values.count();
    for (int c = 0; c < extremes.components(); ++c) extremes.add(c, values.component(c));
    if (values.components() == 1) {
        // Two passes over values in the cache are exact enough and vectorise; a running mean does neither.
        constexpr std::size_t lanes = 8;
        std::span<const double> v = values.component(0);
        auto lane_sum = [&](auto term) {
            std::array<double, lanes> sums{};
            std::size_t i = 0;
            for (; i + lanes <= n; i += lanes)
                for (std::size_t l = 0; l < lanes; ++l) sums[l] += term(v[i + l]);
            for (; i < n; ++i) sums[i % lanes] += term(v[i]);
            double sum = 0;
            for (double s : sums) sum += s;
            return sum;
        };
        const double mean = lane_sum([](double x) { return x; }) / static_cast<double>(n);
        moments.merge(n, mean, lane_sum([mean](double x) { return (x - mean) * (x - mean); }));
        return;
    }
    std::vector<double> one(static_cast<std::size_t>(values.components()));
    for (std::size_t i = 0; i < n; ++i) {
        for (int c = 0; c < values.components(); ++c) one[static_cast<std::size_t>(c)] = values(i, c);
        moments.add(one);
    }
}

void SampleMoments::add(const DeviceSummary& values, std::uint64_t count) {
    if (extremes.components() > 0) extremes.add(values, count);
    moments.merge(count, values.mean, values.squared_deviations);
}

void tally_mean(const CovarianceMoments& moments, Tally& tally) {
    const int m = moments.components();
    const double inverse = 1 / static_cast<double>(moments.count());
    tally.value = moments.means();
    tally.standard_error.resize(static_cast<std::size_t>(m));
    for (int c = 0; c < m; ++c)
        tally.standard_error[static_cast<std::size_t>(c)] = std::sqrt(moments.variance(c) * inverse);
    tally.covariance.clear();
    if (!moments.full()) return;
    for (int a = 0; a < m; ++a)
        for (int b = 0; b < m; ++b) tally.covariance.push_back(moments.covariance(a, b) * inverse);
}

void tally_mean(const SampleMoments& samples, Tally& tally) {
    tally_mean(samples.moments, tally);
    judge_extremes(samples.extremes, samples.moments.count(), tally);
}

void raise_errors_of_few(const ExtremeValues& extremes, std::uint64_t n, Tally& tally) {
    if (n < 2) return;
    std::vector<double> least;
    for (int c = 0; c < extremes.components(); ++c) least.push_back(extremes.least_standard_error(c, n));
    raise_standard_errors(least, tally);
}

void judge_extremes(const ExtremeValues& extremes, std::uint64_t n, Tally& tally) {
    if (n < 2 || extremes.components() == 0) return;
    raise_errors_of_few(extremes, n, tally);
    warn_of_heavy_tail(extremes.tail(), n, static_cast<double>(n), tally.standard_error[0], tally.warnings);
    const double beyond = beyond_the_largest(extremes.tail(), n, static_cast<double>(n));
    if (beyond > 0) {
        const std::array<double, 1> least{std::hypot(tally.standard_error[0], beyond)};
        raise_standard_errors(least, tally);
    }
    tally.absolute.clear();
    for (int c = 0; c < extremes.components(); ++c) tally.absolute.push_back(extremes.mean_magnitude(c, n));
}

void raise_standard_errors(std::span<const double> least, Tally& tally) {
    const std::size_t m = tally.standard_error.size();
    for (std::size_t c = 0; c < least.size(); ++c) {
        double& error = tally.standard_error[c];
        if (!(least[c] > error)) continue;
        const double factor = error > 0 ? least[c] / error : 0;
        error = least[c];
        if (tally.covariance.empty()) continue;
        for (std::size_t k = 0; k < m; ++k) {
            tally.covariance[c * m + k] *= factor;
            tally.covariance[k * m + c] *= factor;
        }
        tally.covariance[c * m + c] = error * error;
    }
}

void save(StateWriter& state, const CovarianceMoments& moments) {
    state.put(moments.count());
    state.put(moments.means());
    state.put(moments.products());
}

void load(StateReader& state, CovarianceMoments& moments) {
    const std::uint64_t count = state.get_word();
    std::vector<double> means = state.get_doubles();
    std::vector<double> products = state.get_doubles();
    if (means.size() != moments.means().size() || products.size() != moments.products().size())
        throw Error("the saved state has another number of components");
    moments.restore(count, std::move(means), std::move(products));
}

void save(StateWriter& state, const NonFiniteCount& count) {
    state.put(count.count);
    state.put(count.first_point);
    state.put(count.vanished);
}

void load(StateReader& state, NonFiniteCount& count) {
    count.count = state.get_word();
    count.first_point = state.get_doubles();
    count.vanished = state.get_word();
}

std::uint64_t next_step_size(std::uint64_t done, std::uint64_t first, std::uint64_t limit) {
    std::uint64_t size = done == 0 ? first : done <= large_step ? done : std::max(large_step, done / 10);
    return std::min(size, limit);
}

std::uint64_t next_step_size_after_pilot(std::uint64_t done, std::uint64_t limit) {
    return next_step_size(done, std::min<std::uint64_t>(4096, limit / 16), limit);
}

} // namespace montelux
