#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "montelux/mc/integrate/adaptive/monotone_map.h"

namespace montelux {
namespace {

// If weights vanish beyond some place, the margin has as many points as would probably have shown one
// non-zero weight, at the rate nearby.
constexpr double margin = 5;
constexpr std::size_t nearby = 32;
constexpr double least_gain = 0.25; // of likelihood, in units of the noise of one effective point
constexpr double singularity_errors = 3, least_power = 0.005, largest_power = 0.9;
constexpr double strong_power = 0.65;  // that of a density that falls to 0 along a straight line is 2/3
constexpr std::size_t candidates = 64; // split places that are tried first

// Sorted points with running sums of their weights.
struct Profile {
    std::vector<double> x, cumulative; // cumulative[i]: of the first i
    std::vector<std::size_t> nonzero;  // the same for the number of weights that are not zero
    double mass(std::size_t first, std::size_t last) const { return cumulative[last] - cumulative[first]; }
};

// Points [first, last) in the interval [lower, upper], and the best place to split it.
struct Leaf {
    std::size_t first, last;
    double lower, upper;
    double gain = 0; // of log likelihood, times the total weight
    std::size_t split = 0;
    double at = 0;
    bool empty_side = false;
};

class Splitter {
  public:
    Splitter(const Profile& profile, std::size_t least) : profile_(profile), least_(least) {}

    void find_split(Leaf& leaf) const {
        leaf.gain = 0;
        const std::size_t count = leaf.last - leaf.first;
        if (count < 2 * least_ || !(profile_.mass(leaf.first, leaf.last) > 0)) return;
        std::size_t step = std::max<std::size_t>(1, count / candidates);
        for (std::size_t k = leaf.first + least_; k + least_ <= leaf.last; k += step) consider(leaf, k);
        // Closer and closer to the best so far.
        while (step > 1 && leaf.gain > 0) {
            const std::size_t near = leaf.split, reach = step;
            step = std::max<std::size_t>(1, step / (candidates / 4));
            for (std::size_t k = near - std::min(near, reach); k <= near + reach; k += step)
                if (k >= leaf.first + least_ && k + least_ <= leaf.last) consider(leaf, k);
        }
    }

  private:
    void consider(Leaf& leaf, std::size_t k) const {
        const double all = profile_.mass(leaf.first, leaf.last), left = profile_.mass(leaf.first, k),
                     right = all - left;
        const bool no_left = !(profile_.mass(leaf.first, k) > 0),
                   no_right = !(profile_.mass(k, leaf.last) > 0);
        // A few non-zero points among many zeros are too little evidence for a split.
        auto too_few = [&](std::size_t first, std::size_t last) {
            const std::size_t seen = profile_.nonzero[last] - profile_.nonzero[first];
            return seen > 0 && seen < least_;
        };
        if (too_few(leaf.first, k) || too_few(k, leaf.last)) return;
        double at = 0.5 * (profile_.x[k - 1] + profile_.x[k]);
        // Points [first, last) do not all vanish.
        auto kept_points = [&](std::size_t first, std::size_t last) {
            const double seen = static_cast<double>(profile_.nonzero[last] - profile_.nonzero[first]);
            return static_cast<std::size_t>(margin * static_cast<double>(last - first) /
                                            std::max(1.0, seen)) +
                   1;
        };
        if (no_right) {
            const std::size_t end = k + kept_points(k - std::min(nearby, k - leaf.first), k);
            if (end >= leaf.last) return;
            at = profile_.x[end];
        }
        if (no_left) {
            const std::size_t kept = kept_points(k, std::min(k + nearby, leaf.last));
            if (leaf.first + kept + 1 >= k) return;
            at = profile_.x[k - 1 - kept];
        }
        if (!(at > leaf.lower && at < leaf.upper)) return;
        const double width = leaf.upper - leaf.lower;
        auto term = [&](double mass, double part) {
            return mass > 0 ? mass * std::log(mass / all * width / part) : 0;
        };
        const double gain = term(left, at - leaf.lower) + term(right, leaf.upper - at);
        if (!(gain > leaf.gain)) return;
        leaf.gain = gain;
        leaf.split = k;
        leaf.at = at;
        leaf.empty_side = no_left || no_right;
    }

    const Profile& profile_;
    std::size_t least_;
};

// Indices in the order of the positions, to 33 binary digits, by a radix sort.
std::vector<std::uint32_t> sorted_order(std::span<const double> positions) {
    constexpr int digit_bits = 11, digits = 3;
    constexpr std::uint64_t buckets = 1 << digit_bits;
    std::vector<std::uint64_t> keys(positions.size());
    std::vector<std::uint32_t> order(positions.size()), next(positions.size());
    for (std::size_t i = 0; i < keys.size(); ++i)
        keys[i] = static_cast<std::uint64_t>(positions[i] *
                                             static_cast<double>(std::uint64_t{1} << (digit_bits * digits)));
    std::iota(order.begin(), order.end(), std::uint32_t{0});
    for (int digit = 0; digit < digits; ++digit) {
        auto bucket = [&](std::uint32_t i) { return (keys[i] >> (digit_bits * digit)) % buckets; };
        std::array<std::uint32_t, buckets + 1> start{};
        for (std::uint32_t i : order) ++start[bucket(i) + 1];
        std::partial_sum(start.begin(), start.end(), start.begin());
        for (std::uint32_t i : order) next[start[bucket(i)]++] = i;
        std::swap(order, next);
    }
    return order;
}

// The power of x, plus one, that weights on [0, upper] follow (maximum likelihood), and its error.
struct Power {
    double value = 1, error = 1;
};
Power fit_power(const Profile& profile, std::size_t count, double upper) {
    double logarithms = 0, squares = 0;
    std::size_t i = 0;
    for (; i < count && profile.x[i] < upper; ++i) {
        const double w = profile.mass(i, i + 1);
        logarithms -= w * std::log(profile.x[i] / upper);
        squares += w * w;
    }
    const double mass = profile.mass(0, i);
    if (!(mass > 0 && logarithms > 0 && squares > 0)) return {};
    return {mass / logarithms, std::sqrt(squares) / logarithms};
}

// The power of the first bin if it surely has a singularity (falls faster than a straight line, or stays near
// 0); else 1.
double end_power(const Profile& profile, const Leaf& first) {
    // The first bin by itself has few points.
    const std::size_t window = std::max(first.last, profile.x.size() / 16);
    const double end = window < profile.x.size() ? std::max(first.upper, profile.x[window]) : 1;
    const Power all = fit_power(profile, window, end), near = fit_power(profile, first.last, first.upper / 8);
    const bool strong = all.value + singularity_errors * all.error < strong_power;
    const bool weak = near.value + singularity_errors * near.error < largest_power;
    return strong || weak ? std::clamp(all.value, least_power, 1.0) : 1;
}

// The true place of a jump lies up to a few points of the denser side away from the edge halfway between two points. Beyond
// an edge that is drawn too near, points would be rare and heavy: moves it that far into the other bin.
void widen_at_jumps(const Profile& profile, const std::vector<Leaf>& leaves, std::vector<double>& edges,
                    std::vector<double>& masses) {
    const std::vector<double> before = edges, mass = masses;
    const auto width = [&](std::size_t k) { return before[k + 1] - before[k]; };
    for (std::size_t k = 1; k < leaves.size(); ++k) {
        for (const auto& [dense, other] : {std::pair(k - 1, k), std::pair(k, k - 1)}) {
            const double height = mass[dense] / width(dense);
            if (!(height > MonotoneMap::jump_ratio * mass[other] / width(other)) ||
                !(profile.mass(leaves[other].first, leaves[other].last) > 0))
                continue; // a bin without weights has a margin of its own
            const double count = static_cast<double>(leaves[dense].last - leaves[dense].first);
            const double by = std::min(margin * width(dense) / count, 0.25 * width(other));
            edges[k] += dense < other ? by : -by;
            masses[dense] += height * by;
        }
    }
}

} // namespace

MonotoneMap fit_monotone_map(std::span<const double> positions, std::span<const double> weights,
                             const MapFit& settings) {
    const std::size_t n = positions.size();
    const std::vector<std::uint32_t> order = sorted_order(positions);
    Profile profile;
    profile.cumulative.push_back(0);
    profile.nonzero.push_back(0);
    double squares = 0;
    for (std::uint32_t i : order) {
        profile.x.push_back(positions[i]);
        profile.cumulative.push_back(profile.cumulative.back() + weights[i]);
        profile.nonzero.push_back(profile.nonzero.back() + (weights[i] > 0 ? 1 : 0));
        squares += weights[i] * weights[i];
    }
    const double total = profile.cumulative.back();
    if (!(total > 0 && std::isfinite(squares))) return {};

    // The likelihood that one point's worth of noise would gain.
    const double noise = least_gain * squares / total;
    const Splitter splitter(profile, static_cast<std::size_t>(settings.points_per_bin));
    std::vector<Leaf> leaves{{0, n, 0, 1}};
    splitter.find_split(leaves.front());
    while (static_cast<int>(leaves.size()) < settings.bins) {
        auto best = std::max_element(leaves.begin(), leaves.end(),
                                     [](const Leaf& a, const Leaf& b) { return a.gain < b.gain; });
        if (!(best->gain > 1e-7 * total) || (!best->empty_side && best->gain < noise)) break;
        Leaf left = *best, right = *best;
        left.last = right.first = best->split;
        left.upper = right.lower = best->at;
        splitter.find_split(left);
        splitter.find_split(right);
        *best = left;
        leaves.push_back(right);
    }
    std::sort(leaves.begin(), leaves.end(), [](const Leaf& a, const Leaf& b) { return a.lower < b.lower; });
    const double one = total / static_cast<double>(profile.nonzero.back());
    std::vector<double> edges{0}, masses;
    for (const Leaf& leaf : leaves) {
        edges.push_back(leaf.upper);
        // The weight of one more point: a bin without non-zero points need not be empty.
        masses.push_back(profile.mass(leaf.first, leaf.last) + one);
    }
    widen_at_jumps(profile, leaves, edges, masses);
    return {std::move(edges), std::move(masses), end_power(profile, leaves.front())};
}

} // namespace montelux
