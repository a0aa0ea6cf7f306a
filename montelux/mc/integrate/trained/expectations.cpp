#include "montelux/mc/integrate/trained/expectations.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "montelux/mc/math/error.h"
#include "montelux/mc/stats/covariance_moments.h"

namespace montelux {
namespace {

// Covariance matrices of all tasks lie in memory at once.
constexpr std::uint64_t most_numbers = 1 << 23, most_tasks = 64, least_tasks = 4;

struct DrawSums {
    CovarianceMoments moments;
    NonFiniteCount non_finite;
    std::uint64_t evaluations = 0;
};

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
            if (!finite) { // left out as a whole, as by all estimators
                std::ranges::fill(row, 0.0);
                std::vector<double> point(static_cast<std::size_t>(draws.x.dimensions()));
                draws.x.view().gather(next, point.data());
                sums.non_finite.merge({1, std::move(point)});
            }
            ++next;
        }
        sums.moments.add(row);
    }
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
        for (std::uint64_t a = 0; a < n; ++a) {
            result.integral.push_back(target.unscaled(sums->moments.means()[a]));
            for (std::uint64_t b = 0; b < n; ++b)
                result.integral_covariance.push_back(target.unscaled_product(
                    sums->moments.covariance(static_cast<int>(a), static_cast<int>(b)) /
                        static_cast<double>(draws),
                    0, 0));
        }
        if (result.non_finite.count > 0)
            result.warnings.push_back(std::to_string(result.non_finite.count) + " of " +
                                      std::to_string(result.evaluations) +
                                      " values were not finite and were left out");
        return result;
    });
}

} // namespace montelux
