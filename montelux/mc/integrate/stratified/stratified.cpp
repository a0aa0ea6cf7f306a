#include "montelux/mc/integrate/stratified/stratified.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "montelux/mc/integrate/stratified/pass_estimator.h"
#include "montelux/mc/integrate/stratified/strata.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

constexpr std::uint64_t samples_a_stratum = 16; // on a line, and beside a pilot
constexpr std::uint64_t most_pilot_numbers = 1 << 24;
constexpr double even_share = 0.2;

class StratifiedEstimator final : public PassEstimator {
  public:
    StratifiedEstimator(const Problem& problem, const Stratified& settings)
        : PassEstimator(problem), settings_(settings) {
        if (settings.pilot < 2)
            throw Error("stratified", "a pilot of " + std::to_string(settings.pilot) +
                                          " samples a stratum; expected at least 2");
        if (settings.strata == 0) return;
        const double count = std::pow(static_cast<double>(settings.strata), problem.evaluator.dimensions());
        if (count > 1 << 24)
            throw Error("stratified", std::to_string(settings.strata) + " strata along each of " +
                                          std::to_string(problem.evaluator.dimensions()) +
                                          " variables; expected at most 2^24 in all");
    }

    StepOutcome step(const StepRequest& request) override {
        const std::uint64_t pilot =
            settings_.allocation == Allocation::neyman ? static_cast<std::uint64_t>(settings_.pilot) : 0;
        std::uint64_t size = next_pass_size(evaluations(), request);
        std::uint64_t most = pilot != 0                              ? size / (pilot + samples_a_stratum)
                             : problem().evaluator.dimensions() == 1 ? size / samples_a_stratum
                                                                     : size / 2;
        if (pilot != 0)
            most = std::min(most, most_pilot_numbers /
                                      static_cast<std::uint64_t>(problem().evaluator.components()));
        const int d = problem().evaluator.dimensions();
        const std::vector<std::uint64_t> cells =
            settings_.strata != 0 ? std::vector<std::uint64_t>(static_cast<std::size_t>(d), settings_.strata)
                                  : balanced_cells(d, std::max<std::uint64_t>(most, 1));
        const Strata strata = grid_strata(cells);
        // A given grid may need more samples than the pass.
        size = std::max(size, strata.count * (pilot + 2));
        if (size > request.max_evaluations) return StepOutcome::exhausted;
        // A small rest has little weight beside finer strata.
        if (passes() > 0 && size < std::min<std::uint64_t>(1 << 20, evaluations() / 4))
            return StepOutcome::exhausted;

        std::vector<double> shares;
        Pass pass;
        if (pilot != 0) {
            std::vector<double> variances;
            const auto offsets = allocate_samples(strata.count, strata.count * pilot, pilot, {});
            auto sum = sample_strata(problem(), strata, offsets, pilot_stream(), &variances, request.cancel);
            if (!sum) return StepOutcome::cancelled;
            pass.non_finite = std::move(sum->non_finite);
            shares = neyman_shares(variances, cells);
        }
        std::uint64_t samples = size - strata.count * pilot;
        if (pilot == 0) samples -= samples % strata.count; // equal numbers
        const auto offsets =
            allocate_samples(strata.count, samples, pilot == 0 ? samples / strata.count : 2, shares);
        auto sum = sample_strata(problem(), strata, offsets, sample_stream(), nullptr, request.cancel);
        if (!sum) return StepOutcome::cancelled;
        pass.non_finite.merge(sum->non_finite);

        const double exponent = settings_.strata != 0 ? 1 : 1 + 2.0 / d;
        pass.weight = std::pow(static_cast<double>(samples), exponent);
        pass.estimate = std::move(sum->estimate);
        pass.tail = std::move(sum->tail);
        pass.tail_values = sum->tail_values;
        pass.evaluations = samples + strata.count * pilot;
        add(pass);
        return StepOutcome::advanced;
    }

  private:
    // Standard deviations within strata; those of several components relative to their means over strata.
    // Half of each variance is that of the neighbours in the grid: a few points are uncertain, and a stratum
    // whose points miss an edge has neighbours that show it.
    std::vector<double> neyman_shares(const std::vector<double>& variances,
                                      const std::vector<std::uint64_t>& cells) const {
        const auto m = static_cast<std::size_t>(problem().evaluator.components());
        const std::size_t strata = variances.size() / m;
        std::vector<double> total(m), own(strata), shares(strata);
        for (std::size_t k = 0; k < strata; ++k)
            for (std::size_t c = 0; c < m; ++c) total[c] += variances[k * m + c];
        for (std::size_t k = 0; k < strata; ++k)
            for (std::size_t c = 0; c < m; ++c)
                if (total[c] > 0) own[k] += variances[k * m + c] / total[c];
        double sum = 0;
        for (std::size_t k = 0; k < strata; ++k) {
            double beside = 0;
            int neighbours = 0;
            std::size_t stride = 1;
            for (std::uint64_t n : cells) {
                const std::size_t cell = k / stride % n;
                if (cell > 0) beside += own[k - stride];
                if (cell + 1 < n) beside += own[k + stride];
                neighbours += (cell > 0) + (cell + 1 < n);
                stride *= n;
            }
            sum += shares[k] = std::sqrt(neighbours == 0 ? own[k] : 0.5 * (own[k] + beside / neighbours));
        }
        const double even = even_share / (1 - even_share) * sum / static_cast<double>(strata);
        for (double& s : shares) s += even;
        return shares;
    }

    Stratified settings_;
};

} // namespace

std::unique_ptr<Estimator> Stratified::estimator(const Problem& problem) const {
    return std::make_unique<StratifiedEstimator>(problem, *this);
}

} // namespace montelux
