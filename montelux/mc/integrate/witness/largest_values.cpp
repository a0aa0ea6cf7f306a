#include "montelux/mc/integrate/witness/largest_values.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

// Least and greatest of some values and of zero.
std::pair<double, double> range_of(std::span<const double> values) {
    double least = 0, greatest = 0;
    for (double v : values) {
        least = std::min(least, v);
        greatest = std::max(greatest, v);
    }
    return {least, greatest};
}

} // namespace

void save(StateWriter& state, const Witness& w) {
    state.put(w.u);
    state.put(w.value);
    state.put(w.volume);
    state.put(w.extent);
    state.put(w.is_part);
}

void load(StateReader& state, Witness& w) {
    w.u = state.get_doubles();
    w.value = state.get_doubles();
    w.volume = state.get_double();
    w.extent = state.get_doubles();
    w.is_part = state.get<int>() != 0;
}

LargestValues::LargestValues(int components) : largest_(static_cast<std::size_t>(components)) {}

void LargestValues::add(const PointBatch& u, const ValueBatch& g) {
    for (std::size_t c = 0; c < largest_.size(); ++c) {
        const std::span<const double> values = g.component(static_cast<int>(c));
        const auto [least, greatest] = range_of(values);
        const double size = std::max(-least, greatest);
        Largest& known = largest_[c];
        if (least < 0) known.negative.store(true, std::memory_order_relaxed);
        if (greatest > 0) known.positive.store(true, std::memory_order_relaxed);
        if (size == 0 || size < known.size.load(std::memory_order_relaxed)) continue;
        std::size_t at = 0;
        while (std::abs(values[at]) != size) ++at;
        Witness witness{std::vector<double>(static_cast<std::size_t>(u.dimensions())),
                        std::vector<double>(largest_.size())};
        u.gather(at, witness.u.data());
        for (std::size_t k = 0; k < largest_.size(); ++k) witness.value[k] = g(at, static_cast<int>(k));
        const std::lock_guard lock(mutex_);
        const double before = known.size.load(std::memory_order_relaxed);
        if (size < before || (size == before && known.witness.u <= witness.u)) continue;
        known.witness = std::move(witness);
        known.size.store(size, std::memory_order_relaxed);
    }
}

bool LargestValues::learns(std::size_t component, double least, double greatest) const {
    const Largest& l = largest_[component];
    return std::max(-least, greatest) > l.size || (least < 0 && !l.negative) || (greatest > 0 && !l.positive);
}

bool LargestValues::learns(const ValueBatch& g) const {
    for (std::size_t c = 0; c < largest_.size(); ++c) {
        const auto [least, greatest] = range_of(g.component(static_cast<int>(c)));
        if (learns(c, least, greatest)) return true;
    }
    return false;
}

std::vector<Witness> LargestValues::witnesses() const {
    const std::lock_guard lock(mutex_);
    std::vector<Witness> seen;
    for (const Largest& l : largest_)
        if (l.size > 0) seen.push_back(l.witness);
    return seen;
}

bool LargestValues::cancels(std::size_t component) const {
    const Largest& l = largest_[component];
    return l.negative == l.positive;
}

void LargestValues::clear() {
    const std::lock_guard lock(mutex_);
    for (Largest& l : largest_) {
        l.size = 0;
        l.witness = {};
    }
}

void LargestValues::save(StateWriter& state) const {
    const std::lock_guard lock(mutex_);
    for (const Largest& l : largest_) {
        state.put(l.size.load());
        state.put(l.negative.load());
        state.put(l.positive.load());
        montelux::save(state, l.witness);
    }
}

void LargestValues::load(StateReader& state) {
    const std::lock_guard lock(mutex_);
    for (Largest& l : largest_) {
        l.size = state.get_double();
        l.negative = state.get<int>() != 0;
        l.positive = state.get<int>() != 0;
        montelux::load(state, l.witness);
        if (!l.witness.value.empty() && l.witness.value.size() != largest_.size())
            throw Error("the saved state has another number of components");
    }
}

} // namespace montelux
