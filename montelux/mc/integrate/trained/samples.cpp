#include "montelux/mc/integrate/trained/samples.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

#include "montelux/mc/integrate/extreme_values.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/parallel/parallel_for.h"

namespace montelux {
namespace {

constexpr double warned_overweight = 0.01;    // of the weight, beyond 1 in overweight samples
constexpr double warned_sample_effect = 0.02; // effective samples per sample
constexpr std::uint64_t most_pilot = 1 << 24;

// Rows that grow one by one, in the order of coordinates.
class SampleRows {
  public:
    explicit SampleRows(const TargetDraws& like)
        : x_(static_cast<std::size_t>(like.x.dimensions())),
          f_(static_cast<std::size_t>(like.f.components())) {}

    std::uint64_t count() const { return f_[0].size(); }
    void add(const TargetDraws& draws, std::size_t i, const Target& target) {
        const PointBatch x = draws.x.view();
        for (std::size_t d = 0; d < x_.size(); ++d) x_[d].push_back(x(i, static_cast<int>(d)));
        for (std::size_t c = 0; c < f_.size(); ++c) {
            const int component = static_cast<int>(c);
            f_[c].push_back(target.unscaled(draws.f(i, component), component));
        }
    }
    void store(Samples& samples, bool logarithm) {
        samples.x.resize(count(), static_cast<int>(x_.size()));
        samples.f.resize(count(), static_cast<int>(f_.size()));
        for (std::size_t d = 0; d < x_.size(); ++d)
            std::ranges::copy(x_[d], samples.x.coordinate(static_cast<int>(d)).begin());
        for (std::size_t c = 0; c < f_.size(); ++c)
            std::ranges::copy(f_[c], samples.f.component(static_cast<int>(c)).begin());
        if (logarithm)
            for (double& v : samples.f.component(0)) v = std::log(v) + samples.log_reference;
    }

  private:
    std::vector<std::vector<double>> x_, f_;
};

void check_request(const TrainedDensity& density, std::uint64_t n, const SamplingOptions& options) {
    const auto row = static_cast<std::uint64_t>(density.domain().dimensions()) + 2;
    if (n == 0 || n > (std::uint64_t{1} << 40) / row)
        throw Error("sample", "a number of samples of " + std::to_string(n) +
                                  " was given; expected between 1 and " +
                                  std::to_string((std::uint64_t{1} << 40) / row));
    if (options.threads < 0) throw Error("sample", "expected a number of threads that is not negative");
}

// Sums over draws for the integral; draws without an entry are zeros.
struct WeightSums {
    double sum = 0, squares = 0;
    void add(double w) {
        sum += w;
        squares += w * w;
    }
    // The mean of n draws, with its error.
    Estimate mean(double n) const {
        const double value = sum / n, variance = std::max(0.0, squares / n - value * value);
        return {value, n > 1 ? std::sqrt(variance / (n - 1)) : infinity};
    }
    static constexpr double infinity = std::numeric_limits<double>::infinity();
};

void warn_of_short_run(Samples& s, std::uint64_t n, const SamplingOptions& options) {
    if (s.count() == n) return;
    s.cancelled = true;
    if (options.max_draws > 0 && s.draws >= options.max_draws)
        s.warnings.push_back("only " + std::to_string(s.count()) + " of " + std::to_string(n) +
                             " samples were found in " + std::to_string(s.draws) + " draws");
}

void finish(Samples& s, std::uint64_t n, const SamplingOptions& options) {
    warn_of_short_run(s, n, options);
    s.integral.evaluations = s.evaluations;
    s.integral.non_finite = s.non_finite.count;
    if (s.non_finite.count > 0)
        s.warnings.push_back(std::to_string(s.non_finite.count) + " of " + std::to_string(s.evaluations) +
                             " values were not finite and were left out");
}

Samples draw_weighted(const Target& target, std::uint64_t n, const SamplingOptions& options) {
    Samples s;
    s.log_reference = target.log_reference();
    std::optional<SampleRows> rows;
    std::uint64_t drawn = 0, inside = 0;
    auto expected = [&](std::uint64_t) {
        const double rate =
            drawn > 0 ? std::max(static_cast<double>(inside), 1.0) / static_cast<double>(drawn) : 1;
        return static_cast<std::uint64_t>(std::ceil(static_cast<double>(n - inside) / rate));
    };
    draw_blocks(target, Target::Stream::samples, options, expected,
                [&](TargetDraws& draws, std::uint64_t first, std::uint64_t count) {
                    if (!rows) rows.emplace(draws);
                    s.non_finite.merge(draws.non_finite);
                    s.evaluations += draws.index.size();
                    drawn = first + count;
                    for (std::size_t i = 0; i < draws.index.size() && inside < n; ++i) {
                        rows->add(draws, i, target);
                        s.weight.push_back(draws.weight[i]);
                        if (++inside == n) drawn = first + draws.index[i] + 1;
                    }
                    if (options.progress)
                        options.progress(static_cast<double>(inside) / static_cast<double>(n));
                    return inside < n;
                });
    s.draws = drawn;
    if (rows) rows->store(s, options.form == IntegrandForm::logarithm);
    WeightSums sums;
    for (double w : s.weight) sums.add(w);
    s.integral = sums.mean(static_cast<double>(drawn));
    ExtremeValues extremes(1);
    extremes.add(0, s.weight);
    warn_of_heavy_tail(extremes.tail(), s.count(), static_cast<double>(drawn), s.integral.standard_error,
                       s.warnings);
    if (const double effective = s.effective_sample_size();
        s.count() > 100 && effective < warned_sample_effect * static_cast<double>(s.count())) {
        char text[160];
        std::snprintf(text, sizeof text,
                      "the %zu samples are worth %.0f unweighted ones; a density trained on more evaluations "
                      "evens the weights out",
                      s.count(), effective);
        s.warnings.emplace_back(text);
    }
    // Ends with the n-th point inside of N draws, so that n / N would be biased; the mean of (n - 1) / (N - 1)
    // is the probability of these points, and N and the weights are independent.
    const double points = static_cast<double>(inside), draws = static_cast<double>(drawn);
    const double scale =
        inside < n || inside == drawn || n == 1 ? 1 / draws : (points - 1) / (draws - 1) / points;
    for (double& w : s.weight) w = target.unscaled(w * scale);
    s.integral.value = target.unscaled(sums.sum * scale);
    s.integral.standard_error = target.unscaled(s.integral.standard_error);
    return s;
}

// The maximum weight of which `share` of the sum of all lies above.
double maximum_of(std::vector<double> weights, double share) {
    std::ranges::sort(weights, std::greater());
    double total = 0;
    for (double w : weights) total += w;
    // The k largest lie above weights[k] by above - k weights[k] in all.
    double above = 0;
    for (std::size_t k = 0; k < weights.size(); ++k) {
        if (above - static_cast<double>(k) * weights[k] > share * total) // between weights[k] and [k - 1]
            return (above - share * total) / static_cast<double>(k);
        above += weights[k];
    }
    return weights.back();
}

UnweightedSamples draw_unweighted(const Target& target, std::uint64_t n, const UnweightingOptions& options) {
    UnweightedSamples s;
    s.log_reference = target.log_reference();
    // Pilot.
    std::vector<double> weights;
    WeightSums pilot;
    double sizes = 0;
    SamplingOptions limits;
    limits.cancel = options.cancel;
    limits.max_draws = options.pilot;
    std::optional<SampleRows> rows;
    const bool whole = draw_blocks(
        target, Target::Stream::pilot, limits, [&](std::uint64_t done) { return options.pilot - done; },
        [&](TargetDraws& draws, std::uint64_t, std::uint64_t) {
            if (!rows) rows.emplace(draws);
            s.non_finite.merge(draws.non_finite);
            s.evaluations += draws.index.size();
            for (double w : draws.weight) {
                pilot.add(w);
                sizes += std::abs(w);
                if (w != 0) weights.push_back(std::abs(w));
            }
            return true;
        });
    if (!whole) return s;
    if (weights.empty())
        throw Error("sample", "the target is zero at all " + std::to_string(options.pilot) +
                                  " points of the pilot; expected a density that was trained on it");
    const double largest = maximum_of(std::move(weights), options.overweight_share);
    s.max_weight = target.unscaled(largest);
    const double guess = sizes / static_cast<double>(options.pilot) / largest;

    std::uint64_t drawn = 0, kept = 0;
    double overweight = 0, all = 0;
    WeightSums sums; // without the last sample, with which their mean would be biased
    auto expected = [&](std::uint64_t) {
        const double rate = kept > 100 ? static_cast<double>(kept) / static_cast<double>(drawn) : guess;
        return static_cast<std::uint64_t>(std::min(static_cast<double>(n - kept) / rate + 1, 1e18));
    };
    draw_blocks(target, Target::Stream::samples, options, expected,
                [&](TargetDraws& draws, std::uint64_t first, std::uint64_t count) {
                    s.non_finite.merge(draws.non_finite);
                    s.evaluations += draws.index.size();
                    drawn = first + count;
                    for (std::size_t i = 0; i < draws.index.size() && kept < n; ++i) {
                        const double w = draws.weight[i], size = std::abs(w) / largest;
                        if (!(draws.choice[i] < size)) {
                            sums.add(w);
                            continue;
                        }
                        rows->add(draws, i, target);
                        const double weight = std::max(1.0, size);
                        s.weight.push_back(std::copysign(weight, w));
                        all += weight;
                        if (size > 1) {
                            ++s.overweight;
                            overweight += weight - 1;
                            s.largest_weight = std::max(s.largest_weight, weight);
                        }
                        if (++kept == n)
                            drawn = first + draws.index[i] + 1;
                        else
                            sums.add(w);
                    }
                    if (options.progress)
                        options.progress(static_cast<double>(kept) / static_cast<double>(n));
                    return kept < n;
                });
    s.draws = drawn;
    rows->store(s, options.form == IntegrandForm::logarithm);
    const auto trials = static_cast<double>(drawn);
    // The draws before the last sample: their mean and the share of kept ones are unbiased.
    const bool ended = kept == n && drawn > 1;
    s.integral = n < options.pilot ? pilot.mean(static_cast<double>(options.pilot))
                                   : sums.mean(ended ? trials - 1 : trials);
    s.integral.value = target.unscaled(s.integral.value);
    s.integral.standard_error = target.unscaled(s.integral.standard_error);
    const double share =
        ended ? static_cast<double>(kept - 1) / (trials - 1) : static_cast<double>(kept) / trials;
    const double likely = (static_cast<double>(kept) + 1) / (trials + 2); // never 0 or 1
    s.efficiency = {share, std::sqrt(likely * (1 - likely) / trials), drawn};
    if (all > 0) s.overweight_share = overweight / all;
    if (s.overweight_share > warned_overweight) {
        char text[160];
        std::snprintf(
            text, sizeof text,
            "samples weigh up to %.3g, %.2g %% of the weight is beyond 1; a larger pilot or more training "
            "evens the weights out",
            s.largest_weight, 100 * s.overweight_share);
        s.warnings.emplace_back(text);
    }
    return s;
}

// Draws, again if the values turn out to lie beyond the range of doubles.
template <typename Draw>
auto with_scale(const TrainedDensity& density, const Integrand& f, std::uint64_t n,
                const SamplingOptions& options, const Draw& draw) {
    check_request(density, n, options);
    return with_threads(options.threads, [&] {
        Target target(density, f, options);
        std::uint64_t spent = target.find_scale();
        for (;;) {
            auto samples = draw(target);
            samples.evaluations += spent;
            spent = samples.evaluations;
            if (target.rescaled()) continue;
            finish(samples, n, options);
            return samples;
        }
    });
}

} // namespace

double Samples::effective_sample_size() const {
    WeightSums sums;
    double largest = 0;
    for (double w : weight) largest = std::max(largest, std::abs(w));
    if (!(largest > 0)) return 0;
    for (double w : weight) sums.add(w / largest);
    return sums.sum * sums.sum / sums.squares;
}

Samples weighted_samples(const TrainedDensity& density, const Integrand& f, std::uint64_t n,
                         const SamplingOptions& options) {
    return with_scale(density, f, n, options,
                      [&](const Target& target) { return draw_weighted(target, n, options); });
}

UnweightedSamples unweighted_samples(const TrainedDensity& density, const Integrand& f, std::uint64_t n,
                                     const UnweightingOptions& options) {
    if (options.pilot == 0 || options.pilot > most_pilot)
        throw Error("sample", "a pilot of " + std::to_string(options.pilot) +
                                  " draws was given; expected between 1 and " + std::to_string(most_pilot));
    if (!(options.overweight_share >= 0 && options.overweight_share < 1))
        throw Error("sample", "expected a share of overweight in [0, 1)");
    return with_scale(density, f, n, options,
                      [&](const Target& target) { return draw_unweighted(target, n, options); });
}

} // namespace montelux
