#include "montelux/mc/integrate/cubature/cubature_confirmation.h"

#include <algorithm>
#include <cmath>

#include "montelux/mc/math/error.h"
#include "montelux/mc/random/hash.h"

namespace montelux {
namespace {

constexpr std::uint64_t confirmation_stream = 0x636f6e66;
constexpr std::uint64_t most_confirmations = 12;
// Parts of the regions that are chosen by their errors, and by volume times the range of the values, since an error
// that is too small does not choose its region; the rest is chosen equally.
constexpr double part_by_error = 0.5, part_by_spread = 0.4;
// Halves have errors of their own: near a jump half of that of the whole.
constexpr double caution_of_halves = 2;

} // namespace

void CubatureConfirmation::require(const CubatureRegions& regions) {
    // A little more halving does not make a confirmed result doubtful.
    const bool known = confirmed_ > 0 && 2 * regions.count() <= 3 * confirmed_;
    pending_ = !known && rounds_ < most_confirmations;
}

std::vector<std::size_t> CubatureConfirmation::choose(const CubatureRegions& regions,
                                                      std::span<const double> scale, std::size_t most,
                                                      std::uint64_t seed) {
    const std::size_t count = regions.count();
    std::vector<double> share(count, 0.0), spread(count, 0.0);
    double sum = 0, all_spread = 0;
    std::size_t divisible = 0;
    for (std::size_t r = 0; r < count; ++r) {
        if (regions.marks(r).indivisible) continue;
        ++divisible;
        for (std::size_t c = 0; c < scale.size(); ++c)
            if (scale[c] > 0) {
                share[r] = std::max(share[r], regions.error(r)[c] / scale[c]);
                spread[r] = std::max(
                    spread[r], regions.volume(r) * (regions.highest(r)[c] - regions.lowest(r)[c]) / scale[c]);
            }
        sum += share[r];
        all_spread += spread[r];
    }
    std::vector<std::size_t> chosen;
    probability_.clear();
    // Systematic sampling.
    const double offset = static_cast<double>(hash_key(seed, confirmation_stream, rounds_) >> 11) * 0x1p-53;
    double measure = 0, next = offset;
    for (std::size_t r = 0; r < count; ++r) {
        if (regions.marks(r).indivisible) continue;
        const double equal = 1 / static_cast<double>(divisible);
        const double by_error = sum > 0 ? share[r] / sum : equal;
        const double by_spread = all_spread > 0 ? spread[r] / all_spread : equal;
        const double own = part_by_error * by_error + part_by_spread * by_spread +
                           (1 - part_by_error - part_by_spread) * equal;
        const double p = std::min(1.0, static_cast<double>(most) * own);
        measure += p;
        if (!(next < measure)) continue;
        next += 1;
        chosen.push_back(r);
        probability_.push_back(p);
    }
    return chosen;
}

void CubatureConfirmation::compare(const CubatureRegions& regions, std::span<const std::size_t> chosen,
                                   const CubatureRegions& halves, std::span<const double> claimed) {
    pending_ = false;
    ++rounds_;
    confirmed_ = regions.count() + chosen.size();
    for (std::size_t c = 0; c < factor_.size(); ++c) {
        double movement = 0;
        for (std::size_t i = 0; i < chosen.size(); ++i)
            movement += (halves.value(2 * i)[c] + halves.value(2 * i + 1)[c] - regions.value(chosen[i])[c]) /
                        probability_[i];
        const double ratio = caution_of_halves * std::abs(movement);
        factor_[c] = claimed[c] > 0 ? std::max(1.0, ratio * factor_[c] / claimed[c]) : 1;
        if (factor_[c] > 1) confirmed_ = 0;
    }
}

void CubatureConfirmation::save(StateWriter& state) const {
    state.put(factor_);
    state.put(rounds_);
    state.put(confirmed_);
    state.put(pending_);
}

void CubatureConfirmation::load(StateReader& state) {
    const std::size_t components = factor_.size();
    factor_ = state.get_doubles();
    if (factor_.size() != components) throw Error("the saved state has another number of components");
    rounds_ = state.get_word();
    confirmed_ = state.get_word();
    pending_ = state.get<bool>();
}

} // namespace montelux
