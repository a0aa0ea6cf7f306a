#include "montelux/mc/integrate/metropolis/metropolis_chain.h"

#include <cstdio>

namespace montelux::detail {

AdaptedWalk::AdaptedWalk(const GaussianWalk& settings, int dimensions, std::uint64_t burn_in)
    : adapt_(settings.adapt),
      step_(settings.step > 0 ? settings.step : 2.38 / std::sqrt(static_cast<double>(dimensions))),
      target_(dimensions == 1 ? 0.44 : 0.234 + 0.206 / (dimensions * dimensions)), scale_(settings.scale),
      moments_(static_cast<std::size_t>(dimensions)), burn_in_(burn_in) {
    if (!(step_ > 0 && std::isfinite(step_)))
        throw Error("metropolis", "expected a finite step that is not negative");
    if (scale_.empty()) scale_.assign(static_cast<std::size_t>(dimensions), 1.0);
    if (static_cast<int>(scale_.size()) != dimensions)
        throw Error("metropolis", "expected a scale for each of " + std::to_string(dimensions) +
                                      " coordinates, got " + std::to_string(scale_.size()));
    for (double s : scale_)
        if (!(s > 0 && std::isfinite(s))) throw Error("metropolis", "expected finite scales above zero");
}

void AdaptedWalk::learn(std::span<const double> x, double acceptance) {
    if (!adapt_) return;
    ++seen_;
    // Robbins and Monro 1951, with steps that fall as t^-0.6.
    step_ *= std::exp((acceptance - target_) * 3 * std::pow(static_cast<double>(++since_window_), -0.6));
    // The spreads in windows of doubling length become the scales; each window lets a far too small scale
    // grow by an order of magnitude. The second half of the burn-in adapts the step alone.
    if (window_end_ == 0) window_end_ = std::max<std::uint64_t>(50, burn_in_ / 32);
    if (window_end_ > burn_in_ / 2) return;
    for (std::size_t d = 0; d < x.size(); ++d) moments_[d].add(x[d]);
    if (seen_ != window_end_) return;
    window_end_ *= 2;
    double old_size = 0, new_size = 0;
    for (std::size_t d = 0; d < x.size(); ++d) {
        const double spread = moments_[d].standard_deviation();
        old_size += std::log(scale_[d]);
        if (spread > 0) scale_[d] = spread;
        new_size += std::log(scale_[d]);
        moments_[d] = {};
    }
    // The product of step and mean scale is kept, then adapted again.
    step_ *= std::exp((old_size - new_size) / static_cast<double>(x.size()));
    since_window_ = 0;
}

void check(const MetropolisOptions& options, const std::vector<std::vector<double>>& starts,
           int observables) {
    auto expect = [](bool good, const char* what) {
        if (!good) throw Error("metropolis", what);
    };
    expect(options.chains >= 1, "expected at least one chain");
    expect(options.samples >= 8, "expected at least 8 samples of a chain");
    expect(options.thin >= 1, "expected a thinning of at least 1");
    expect(observables >= 1, "expected at least one observable");
    expect(starts.size() == 1 || starts.size() == static_cast<std::size_t>(options.chains),
           "expected one start, or one for each chain");
    for (const std::vector<double>& start : starts) {
        expect(!start.empty() && start.size() == starts[0].size(),
               "expected starts of at least one coordinate, as many in each");
        for (double x : start) expect(std::isfinite(x), "expected starts of finite numbers");
    }
}

MetropolisResult gather(const std::vector<ChainTrace>& traces, const std::vector<ChainOutcome>& outcomes,
                        const MetropolisOptions& options, bool cancelled) {
    constexpr double converged = 1.01; // Vehtari et al. 2021
    constexpr double few = 100;        // effective samples of a chain
    MetropolisResult result;
    result.cancelled = cancelled;
    std::uint64_t accepted = 0;
    for (const ChainOutcome& o : outcomes) {
        accepted += o.accepted;
        result.evaluations += o.evaluations;
        result.non_finite += o.non_finite;
    }
    result.acceptance_rate = static_cast<double>(accepted) / static_cast<double>(options.samples) /
                             static_cast<double>(options.chains);
    char text[192];
    for (int k = 0; k < traces[0].observables(); ++k) {
        const ChainSummary s = summarize(traces, k);
        result.observables.push_back(s);
        if (s.r_hat > converged) {
            std::snprintf(
                text, sizeof text,
                "the chains have not converged to one density: split R-hat of observable %d is %.3f, "
                "expected at most 1.01",
                k, s.r_hat);
            result.warnings.emplace_back(text);
        }
        if (s.effective_sample_size < few * options.chains) {
            std::snprintf(text, sizeof text,
                          "observable %d has only %.0f effective samples; its error is uncertain", k,
                          s.effective_sample_size);
            result.warnings.emplace_back(text);
        }
    }
    if (result.non_finite > 0) {
        std::snprintf(text, sizeof text, "%llu of %llu densities were not finite and were rejected",
                      static_cast<unsigned long long>(result.non_finite),
                      static_cast<unsigned long long>(result.evaluations));
        result.warnings.emplace_back(text);
    }
    if (cancelled) result.warnings.emplace_back("the chains were cancelled before their end");
    return result;
}

} // namespace montelux::detail
