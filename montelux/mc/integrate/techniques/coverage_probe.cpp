#include "montelux/mc/integrate/techniques/coverage_probe.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "montelux/mc/integrate/sampling.h"
#include "montelux/mc/integrate/unit_points.h"

namespace montelux {
namespace {

// Standard errors that may be missing without a warning: densities with thin tails underflow to zero sooner
// than integrands.
constexpr double negligible = 1e-3;
constexpr std::uint32_t probe_stream = 0xc07e7a9eu;

struct Found {
    std::uint64_t uncovered = 0;
    std::vector<double> point;
    double value = 0;
    std::vector<double> missing; // of each component; empty while nothing is uncovered
    double missing_square = 0;

    void merge(const Found& later) {
        if (later.uncovered == 0) return;
        if (uncovered == 0) {
            *this = later;
            return;
        }
        uncovered += later.uncovered;
        for (std::size_t c = 0; c < missing.size(); ++c) missing[c] += later.missing[c];
        missing_square += later.missing_square;
    }
};

} // namespace

std::uint64_t CoverageProbe::due(std::uint64_t samples, std::uint64_t limit) const {
    constexpr std::uint64_t least = 32, ratio = 32, most = 1 << 16;
    const std::uint64_t wanted = std::max(least, std::min(2 * samples / ratio, samples / ratio + most));
    return wanted > evaluations_ ? std::min(wanted - evaluations_, limit / (ratio + 1)) : 0;
}

bool CoverageProbe::run(const Problem& problem, std::uint64_t points, const CancelFlag* cancel) {
    // Values that are not finite at probes do not concern the estimate.
    const Evaluator f(problem.evaluator.integrand(), problem.evaluator.domain());
    const Domain& domain = f.domain();
    auto found = sum_batches(
        points, [] { return Found{}; },
        [&](std::uint64_t first, std::uint64_t count, Found& to) {
            PointBuffer u(count, domain.uniforms()), x(count, domain.dimensions());
            std::vector<double> volume(count, 1.0), p(count), density(count, 0.0);
            fill_random(u, problem.seed, probe_stream, evaluations_ + first);
            domain.map(u, x, volume);
            for (const Technique& t : techniques_) {
                t.density(x, p);
                for (std::size_t i = 0; i < count; ++i) density[i] += p[i];
            }
            ValueBuffer values(count, f.components());
            NonFiniteCount ignored;
            f.at_points(x, values, ignored);
            for (std::size_t i = 0; i < count; ++i) {
                if (density[i] > 0) continue;
                int c = 0;
                while (c < values.components() && values(i, c) == 0) ++c;
                if (c == values.components()) continue;
                Found one{
                    1, std::vector<double>(static_cast<std::size_t>(x.dimensions())), values(i, c), {}, 0};
                for (int k = 0; k < values.components(); ++k)
                    one.missing.push_back(std::abs(values(i, k)) * volume[i]);
                one.missing_square = one.missing[0] * one.missing[0];
                x.view().gather(i, one.point.data());
                to.merge(one);
            }
        },
        cancel);
    if (!found) return false;
    evaluations_ += points;
    Found all{uncovered_, first_point_, first_value_, missing_, missing_square_};
    all.merge(*found);
    uncovered_ = all.uncovered;
    first_point_ = std::move(all.point);
    first_value_ = all.value;
    missing_ = std::move(all.missing);
    missing_square_ = all.missing_square;
    return true;
}

void CoverageProbe::warn(Tally& tally) const {
    if (uncovered_ == 0) return;
    const double n = static_cast<double>(evaluations_), mean = missing_[0] / n;
    bool matters = false;
    for (std::size_t c = 0; c < missing_.size(); ++c) {
        const double error = std::isfinite(tally.standard_error[c]) ? tally.standard_error[c] : 0;
        matters |= missing_[c] / n > std::max(negligible * error, 1e-15 * std::abs(tally.value[c]));
    }
    if (!matters) return;
    const double variance = std::max(0.0, missing_square_ / n - mean * mean);
    std::ostringstream text;
    text << "the density is zero at (";
    text.precision(6);
    for (std::size_t d = 0; d < first_point_.size(); ++d) text << (d ? ", " : "") << first_point_[d];
    text << "), where the integrand is " << first_value_ << ": that part of the integral is missing, about ";
    text.precision(3);
    text << mean << " +- " << std::sqrt(variance / n) << " in absolute value (by " << uncovered_ << " of "
         << evaluations_ << " probes)";
    tally.warnings.push_back(text.str());
}

void CoverageProbe::save(StateWriter& state) const {
    state.put(evaluations_);
    state.put(uncovered_);
    state.put(first_point_);
    state.put(first_value_);
    state.put(missing_);
    state.put(missing_square_);
}

void CoverageProbe::load(StateReader& state) {
    evaluations_ = state.get_word();
    uncovered_ = state.get_word();
    first_point_ = state.get_doubles();
    first_value_ = state.get_double();
    missing_ = state.get_doubles();
    missing_square_ = state.get_double();
}

} // namespace montelux
