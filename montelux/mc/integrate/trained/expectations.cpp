#include "montelux/mc/integrate/trained/expectations.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "montelux/mc/integrate/extreme_values.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/mc/stats/covariance_moments.h"

namespace montelux {
namespace {

// Covariance matrices of all tasks lie in memory at once.
constexpr std::uint64_t most_numbers = 1 << 23, most_tasks = 64, least_tasks = 4;

constexpr double warned_effect = 0.02; // effective draws per draw

struct DrawSums {
    CovarianceMoments moments;
    ExtremeValues extremes;
    NonFiniteCount non_finite, undefined; // weights; observables where the weight is finite
    std::uint64_t evaluations = 0;
};

// One observable after the other of the values that are not zero.
void add_extremes(const std::vector<std::vector<double>>& columns, ExtremeValues& extremes) {
    for (std::size_t k = 0; k < columns.size(); ++k) extremes.add(static_cast<int>(k), columns[k]);
}

void add_block(const Target& target, const Integrand& observables, std::uint64_t first, std::uint64_t count,
               DrawSums& sums) {
    const auto m = static_cast<std::size_t>(observables.components());
    TargetDraws draws;
    target.draw(Target::Stream::samples, first, count, draws);
    sums.evaluations += draws.index.size();
    sums.non_finite.merge(draws.non_finite);
    ValueBuffer h(draws.index.size(), observables.components());
    if (h.count() > 0) observables(draws.x, h);
    std::vector<double> row(m + 1);
    std::vector<std::vector<double>> columns(m + 1);
    std::size_t next = 0;
    for (std::uint64_t i = 0; i < count; ++i) {
        std::ranges::fill(row, 0.0);
        if (next < draws.index.size() && draws.index[next] == i) {
            row[0] = draws.weight[next];
            bool finite = true;
            for (std::size_t k = 0; k < m; ++k) {
                const double product = row[0] == 0 ? 0 : row[0] * h(next, static_cast<int>(k));
                finite = finite && std::isfinite(product);
                row[k + 1] = product;
            }
            if (!finite) { // its weight still counts in Z
                std::fill(row.begin() + 1, row.end(), 0.0);
                std::vector<double> point(static_cast<std::size_t>(draws.x.dimensions()));
                draws.x.view().gather(next, point.data());
                sums.undefined.merge({1, std::move(point)});
            }
            for (std::size_t k = 0; k <= m; ++k)
                if (row[k] != 0) columns[k].push_back(row[k]);
            ++next;
        }
        sums.moments.add(row);
    }
    add_extremes(columns, sums.extremes);
}

// The diagonal of a covariance is at least what the number of its contributions allows.
void raise_errors(const DrawSums& sums, std::uint64_t draws, std::vector<double>& covariance) {
    const auto n = static_cast<std::size_t>(sums.extremes.components());
    for (std::size_t k = 0; k < n; ++k) {
        const double least = sums.extremes.least_standard_error(static_cast<int>(k), draws);
        double& variance = covariance[k * n + k];
        variance = std::max(variance, least * least);
    }
}

// `covariance`: of the means of the draws, in their unit.
void add_warnings(const DrawSums& sums, const std::vector<double>& covariance, Expectations& result) {
    const auto add = [&](std::uint64_t count, std::uint64_t all, const char* rest) {
        if (count > 0) result.warnings.push_back(std::to_string(count) + " of " + std::to_string(all) + rest);
    };
    add(sums.non_finite.count, result.evaluations, " values were not finite and were left out");
    add(sums.undefined.count, result.evaluations,
        " points have an observable that is not finite; they count in no observable");
    const double n = static_cast<double>(result.draws), mean = sums.moments.means()[0];
    warn_of_heavy_tail(sums.extremes.tail(), result.draws, n, std::sqrt(covariance[0]), result.warnings);
    const double effective = n * mean * mean / (mean * mean + n * covariance[0]);
    if (effective < warned_effect * n) {
        char text[160];
        std::snprintf(text, sizeof text,
                      "the %llu draws are worth %.0f unweighted samples; a density trained on more "
                      "evaluations evens the weights out",
                      static_cast<unsigned long long>(result.draws), effective);
        result.warnings.emplace_back(text);
    }
    std::uint64_t unseen = 0;
    for (int k = 1; k < sums.extremes.components(); ++k)
        unseen += sums.moments.means()[static_cast<std::size_t>(k)] == 0 && !(sums.moments.variance(k) > 0);
    add(unseen, static_cast<std::uint64_t>(result.observables()),
        " observables were zero in all draws; their error of zero says nothing");
}

} // namespace

std::vector<double> Expectations::mean() const {
    std::vector<double> means(integral.begin() + 1, integral.end());
    for (double& m : means) m /= integral[0];
    return means;
}

std::vector<double> Expectations::mean_covariance() const {
    const std::vector<double> r = mean();
    const std::size_t m = r.size(), n = m + 1;
    auto c = [&](std::size_t a, std::size_t b) { return integral_covariance[a * n + b]; };
    std::vector<double> result(m * m);
    for (std::size_t a = 0; a < m; ++a)
        for (std::size_t b = 0; b < m; ++b)
            result[a * m + b] =
                (c(a + 1, b + 1) - r[a] * c(0, b + 1) - r[b] * c(a + 1, 0) + r[a] * r[b] * c(0, 0)) /
                (integral[0] * integral[0]);
    return result;
}

Expectations expectations(const TrainedDensity& density, const Integrand& f, const Integrand& observables,
                          std::uint64_t draws, const SamplingOptions& options) {
    if (observables.components() > Expectations::most_observables)
        throw Error("expectations", "expected at most " + std::to_string(Expectations::most_observables) +
                                        " observables and bins, got " +
                                        std::to_string(observables.components()));
    if (draws < 2) throw Error("expectations", "expected at least two draws");
    return with_threads(options.threads, [&] {
        Target target(density, f, options);
        Expectations result;
        result.evaluations = target.find_scale();
        const auto n = static_cast<std::uint64_t>(observables.components()) + 1;
        const std::uint64_t blocks = (draws - 1) / Target::block + 1;
        const std::uint64_t tasks =
            std::min(std::clamp(most_numbers / (n * n), least_tasks, most_tasks), blocks);
        std::optional<DrawSums> sums;
        do {
            sums = parallel_reduce_ordered(
                static_cast<std::int64_t>(tasks),
                [&](std::int64_t t) {
                    DrawSums task;
                    task.moments = CovarianceMoments(static_cast<int>(n));
                    task.extremes = ExtremeValues(static_cast<int>(n));
                    const auto at = static_cast<std::uint64_t>(t);
                    for (std::uint64_t b = blocks * at / tasks; b < blocks * (at + 1) / tasks; ++b) {
                        if (options.cancel && options.cancel->requested()) break;
                        const std::uint64_t first = b * Target::block;
                        add_block(target, observables, first, std::min(Target::block, draws - first), task);
                    }
                    return task;
                },
                [](DrawSums a, const DrawSums& b) {
                    a.moments.merge(b.moments);
                    a.extremes.merge(b.extremes);
                    a.undefined.merge(b.undefined);
                    a.non_finite.merge(b.non_finite);
                    a.evaluations += b.evaluations;
                    return a;
                },
                options.cancel);
            if (sums) result.evaluations += sums->evaluations;
        } while (sums && target.rescaled());
        result.log_reference = target.log_reference();
        if (!sums || (options.cancel && options.cancel->requested())) {
            result.cancelled = true;
            return result;
        }
        result.draws = draws;
        result.non_finite = sums->non_finite;
        result.non_finite.merge(sums->undefined);
        std::vector<double> covariance;
        for (std::uint64_t a = 0; a < n; ++a)
            for (std::uint64_t b = 0; b < n; ++b)
                covariance.push_back(sums->moments.covariance(static_cast<int>(a), static_cast<int>(b)) /
                                     static_cast<double>(draws));
        raise_errors(*sums, draws, covariance);
        for (double mean : sums->moments.means()) result.integral.push_back(target.unscaled(mean));
        for (double v : covariance) result.integral_covariance.push_back(target.unscaled_product(v, 0, 0));
        add_warnings(*sums, covariance, result);
        return result;
    });
}

} // namespace montelux
