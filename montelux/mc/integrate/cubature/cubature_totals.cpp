#include "montelux/mc/integrate/cubature/cubature_totals.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "montelux/mc/integrate/cubature/cubature_halving.h"
#include "montelux/mc/integrate/extreme_values.h"
#include "montelux/mc/math/compensated.h"
#include "montelux/mc/math/error.h"

namespace montelux {

CubatureTotals::CubatureTotals(int components)
    : value_(static_cast<std::size_t>(components)), error_(value_.size()), rule_error_(value_.size()),
      inflation_(value_.size(), 1.0), absolute_(value_.size()), equal_(value_.size(), 0),
      disagreement_(value_.size(), 0.0), expected_(value_.size(), 0.0) {}

void CubatureTotals::begin_comparison() {
    constexpr double memory = 0.9; // of a step
    for (double& x : disagreement_) x *= memory;
    for (double& x : expected_) x *= memory;
}

void CubatureTotals::compare(std::size_t component, double predicted, double difference) {
    disagreement_[component] += difference * difference;
    expected_[component] += predicted * predicted;
}

void CubatureTotals::add_up(const CubatureRegions& regions, const CubatureVerification& verification,
                            const CubatureConfirmation& confirmation, std::uint64_t evaluations) {
    for (std::size_t c = 0; c < value_.size(); ++c) {
        CompensatedSum value, error;
        double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
        absolute_[c] = 0;
        for (std::size_t r = 0; r < regions.count(); ++r) {
            value.add(regions.value(r)[c]);
            error.add(regions.error(r)[c]);
            // Where signs cancel within a region, a quarter of its range.
            absolute_[c] +=
                std::max(std::abs(regions.value(r)[c]),
                         0.25 * regions.volume(r) * (regions.highest(r)[c] - regions.lowest(r)[c]));
            lowest = std::min(lowest, regions.lowest(r)[c]);
            highest = std::max(highest, regions.highest(r)[c]);
        }
        verification.widen(c, lowest, highest);
        value_[c] = value.value();
        inflation_[c] = expected_[c] > 0 ? std::max(1.0, std::sqrt(disagreement_[c] / expected_[c])) : 1;
        error_[c] = error.value() * inflation_[c] * caution(regions.count());
        error_[c] *= confirmation.factor(c) * verification.drift(c);
        error_[c] += verification.slack(c);
        rule_error_[c] = error_[c];
        equal_[c] = lowest == highest && lowest != 0;
    }
    if (equal_values())
        for (std::size_t c = 0; c < value_.size(); ++c)
            error_[c] = std::max(error_[c], equal_values_error(value_[c], static_cast<double>(evaluations)));
}

bool CubatureTotals::equal_values() const {
    return std::ranges::all_of(equal_, [](char equal) { return equal != 0; });
}

double CubatureTotals::caution(std::size_t regions) {
    return 1 + (caution_of_one_region - 1) / static_cast<double>(regions);
}

void CubatureTotals::save(StateWriter& state) const {
    state.put(disagreement_);
    state.put(expected_);
}

void CubatureTotals::load(StateReader& state) {
    disagreement_ = state.get_doubles();
    expected_ = state.get_doubles();
    if (disagreement_.size() != value_.size() || expected_.size() != value_.size())
        throw Error("the saved state has another number of components");
}

} // namespace montelux
