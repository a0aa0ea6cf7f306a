#include "montelux/mc/integrate/vegas/adaptive_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "montelux/mc/integrate/whole_file.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

constexpr std::string_view file_kind = "adaptive map";
// Minimum distance of edges: points within an increment must differ, or its volume is lost.
constexpr double least_bin_width = 0x1p-44;
constexpr double uniform_part = 1e-3;
constexpr double growth = 2;
constexpr double below_one = 1 - 0x1p-53;

void check_shape(int dimensions, int increments) {
    if (dimensions < 1)
        throw Error("AdaptiveMap", "expected at least one dimension, got " + std::to_string(dimensions));
    if (increments < 1 || increments > AdaptiveMap::max_increments)
        throw Error("AdaptiveMap", "expected between 1 and " + std::to_string(AdaptiveMap::max_increments) +
                                       " increments, got " + std::to_string(increments));
}

// Lepage 2021, section II: each value becomes (left + 6 own + right) / 8, at the ends (7 own + next) / 8.
void smooth(std::vector<double>& values) {
    const std::size_t n = values.size();
    if (n < 2) return;
    double left = values[0];
    for (std::size_t i = 0; i < n; ++i) {
        const double own = values[i], right = i + 1 < n ? values[i + 1] : own;
        values[i] = (left + 6 * own + right) / 8;
        left = own;
    }
}

// Lepage 2021, section II, for a share r of the total: a large share grows slowly.
double compressed(double r, double alpha) {
    if (!(r > 0)) return 0;
    if (r >= 1) return 1;
    return std::pow((r - 1) / std::log(r), alpha);
}

// n + 1 edges between which the weights, spread evenly over the old increments, have equal sums.
std::vector<double> rebalanced(std::span<const double> edges, const std::vector<double>& weights,
                               std::size_t n) {
    double total = 0;
    for (double w : weights) total += w;
    std::vector<double> fresh(n + 1);
    std::size_t k = 1;
    double before = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        const double width = edges[i + 1] - edges[i];
        for (; k < n; ++k) {
            const double wanted = total * static_cast<double>(k) / static_cast<double>(n);
            if (wanted > before + weights[i]) break;
            fresh[k] = edges[i] + std::clamp((wanted - before) / weights[i], 0.0, 1.0) * width;
        }
        before += weights[i];
    }
    for (; k < n; ++k) fresh[k] = 1; // rounding of the last sums; the passes below set them apart
    fresh[0] = 0;
    fresh[n] = 1;
    for (std::size_t i = 1; i < n; ++i) fresh[i] = std::max(fresh[i], fresh[i - 1] + least_bin_width);
    for (std::size_t i = n - 1; i > 0; --i) fresh[i] = std::min(fresh[i], fresh[i + 1] - least_bin_width);
    return fresh;
}

// Splits increments that are much wider than a neighbour into a graded sequence. If an integrand ends at a
// jump, the last narrow increment ends just before it; without grading the sliver between would lie in a wide
// increment that few points hit, with rare and huge values.
std::vector<double> graded(std::span<const double> edges) {
    const std::size_t n = edges.size() - 1;
    std::vector<double> fresh{0}, from_right;
    double before = 1; // width of the increment before
    for (std::size_t i = 0; i < n; ++i) {
        double rest = edges[i + 1] - edges[i];
        double left = growth * before, right = i + 1 < n ? growth * (edges[i + 2] - edges[i + 1]) : 1;
        from_right.clear();
        while (rest > std::min(left, right)) {
            if (left <= right) {
                fresh.push_back(fresh.back() + left);
                rest -= left;
                before = left;
                left *= growth;
            } else {
                from_right.push_back(right);
                rest -= right;
                right *= growth;
            }
        }
        double at = edges[i + 1];
        for (double width : from_right) at -= width;
        if (rest > least_bin_width) {
            fresh.push_back(at);
            before = rest;
        }
        for (std::size_t k = from_right.size(); k-- > 0;) {
            at += from_right[k];
            fresh.push_back(at);
            before = from_right[k];
        }
        fresh.back() = edges[i + 1];
    }
    return fresh;
}

} // namespace

void MapTraining::add(const PointBatch& y, std::span<const double> share,
                      std::span<const double> weighted_square) {
    for (int d = 0; d < y.dimensions(); ++d) {
        Sum* sums = &sums_[static_cast<std::size_t>(d) * static_cast<std::size_t>(increments_)];
        const double* at = y.coordinate(d).data();
        for (std::size_t i = 0; i < y.count(); ++i) {
            Sum& sum = sums[static_cast<int>(at[i] * increments_)];
            sum.share += share[i];
            sum.square += weighted_square[i];
        }
    }
}

void MapTraining::merge(const MapTraining& other) {
    if (!other.active()) return;
    if (!active()) {
        *this = other;
        return;
    }
    for (std::size_t i = 0; i < sums_.size(); ++i) {
        sums_[i].share += other.sums_[i].share;
        sums_[i].square += other.sums_[i].square;
    }
}

std::vector<double> MapTraining::means(int d) const {
    const auto n = static_cast<std::size_t>(increments_);
    const Sum* sums = &sums_[static_cast<std::size_t>(d) * n];
    std::vector<double> means(n, 0);
    std::size_t last = n; // with points
    for (std::size_t i = 0; i < n; ++i) {
        if (!(sums[i].share > 0)) continue;
        means[i] = sums[i].square / sums[i].share;
        // The gap before, half from either side.
        const std::size_t begin = last == n ? 0 : last + 1;
        for (std::size_t j = begin; j < i; ++j)
            means[j] = last == n ? means[i] : 0.5 * (means[last] + means[i]);
        last = i;
    }
    if (last != n)
        for (std::size_t j = last + 1; j < n; ++j) means[j] = means[last];
    return means;
}

void MapTraining::save(StateWriter& state) const {
    state.put(increments_);
    state.put(static_cast<std::uint64_t>(sums_.size()));
    for (const Sum& sum : sums_) {
        state.put(sum.share);
        state.put(sum.square);
    }
}

void MapTraining::load(StateReader& state) {
    const int increments = state.get<int>();
    const std::uint64_t size = state.get_word();
    if (increments < 0 || increments > AdaptiveMap::max_increments || size > (std::uint64_t{1} << 32) ||
        (increments == 0 ? size != 0 : size % static_cast<std::uint64_t>(increments) != 0))
        throw Error("the saved training of a map has no possible shape");
    increments_ = increments;
    sums_.clear();
    for (std::uint64_t i = 0; i < size; ++i) {
        const double share = state.get_double();
        const double square = state.get_double();
        sums_.push_back({share, square});
    }
}

AdaptiveMap::AdaptiveMap(int dimensions, int increments) : dimensions_(dimensions), increments_(increments) {
    check_shape(dimensions, increments);
    edges_.resize(static_cast<std::size_t>(dimensions) * stride());
    for (std::size_t i = 0; i < edges_.size(); ++i)
        edges_[i] = static_cast<double>(i % stride()) / increments;
}

AdaptiveMap::AdaptiveMap(const std::vector<std::vector<double>>& edges)
    : dimensions_(static_cast<int>(edges.size())),
      increments_(edges.empty() ? 0 : static_cast<int>(edges[0].size()) - 1) {
    check_shape(dimensions_, increments_);
    for (std::size_t d = 0; d < edges.size(); ++d) {
        std::ostringstream what;
        what << "the edges of coordinate " << d + 1;
        if (edges[d].size() != stride()) {
            what << " are " << edges[d].size() << "; expected " << stride() << " as in the first";
            throw Error("AdaptiveMap", what.str());
        }
        if (edges[d].front() != 0 || edges[d].back() != 1)
            throw Error("AdaptiveMap", what.str() + " do not run from 0 to 1");
        for (std::size_t i = 0; i + 1 < stride(); ++i)
            if (!(edges[d][i + 1] - edges[d][i] >= least_bin_width / 2)) {
                what << " do not increase after the one at " << edges[d][i];
                throw Error("AdaptiveMap", what.str());
            }
        edges_.insert(edges_.end(), edges[d].begin(), edges[d].end());
    }
}

void AdaptiveMap::map(const PointBatch& y, PointBuffer& x, std::span<double> jacobian) const {
    const double n = increments_;
    const std::size_t count = y.count();
    double* factor = jacobian.data();
    for (int d = 0; d < dimensions_; ++d) {
        const double* edge = edges(d).data();
        const double* from = y.coordinate(d).data();
        double* to = x.coordinate(d).data();
        for (std::size_t i = 0; i < count; ++i) {
            const double t = from[i] * n;
            const int k = static_cast<int>(t);
            const double low = edge[k], width = edge[k + 1] - low;
            to[i] = std::min(low + (t - k) * width, below_one);
            factor[i] *= n * width;
        }
    }
}

void AdaptiveMap::inverse(const PointBatch& x, PointBuffer& y, std::span<double> jacobian) const {
    constexpr std::size_t lanes = 64;
    const double n = increments_;
    for (int d = 0; d < dimensions_; ++d) {
        const double* edge = edges(d).data();
        const double* from = x.coordinate(d).data();
        double* to = y.coordinate(d).data();
        for (std::size_t begin = 0; begin < x.count(); begin += lanes) {
            const std::size_t count = std::min(lanes, x.count() - begin);
            // Bisection in lockstep for all lanes: the same number of halvings, no branches.
            std::array<int, lanes> low{};
            for (int length = increments_; length > 1;) {
                const int half = length / 2;
                for (std::size_t i = 0; i < count; ++i)
                    low[i] += edge[low[i] + half] <= from[begin + i] ? half : 0;
                length -= half;
            }
            for (std::size_t i = 0; i < count; ++i) {
                const double left = edge[low[i]], width = edge[low[i] + 1] - left;
                to[begin + i] = std::min((low[i] + (from[begin + i] - left) / width) / n, below_one);
                jacobian[begin + i] *= n * width;
            }
        }
    }
}

void AdaptiveMap::refine(const MapTraining& training, double alpha) {
    if (!training.active() || alpha == 0) return;
    if (training.increments() != increments_)
        throw Error("AdaptiveMap", "the training has another number of increments than the map");
    for (int d = 0; d < dimensions_; ++d) {
        std::vector<double> weights = training.means(d);
        smooth(weights);
        // Scaled by the largest, so that no sum overflows.
        const double largest = *std::max_element(weights.begin(), weights.end());
        if (!(largest > 0)) continue;
        double total = 0;
        for (double& w : weights) total += w /= largest;
        double compressed_total = 0;
        for (double& w : weights) compressed_total += w = compressed(w / total, alpha);
        std::span<double> edge{edges_.data() + static_cast<std::size_t>(d) * stride(), stride()};
        for (std::size_t i = 0; i < weights.size(); ++i)
            weights[i] += uniform_part * compressed_total * (edge[i + 1] - edge[i]);
        const std::vector<double> moved = rebalanced(edge, weights, weights.size());
        const std::vector<double> steps = graded(moved);
        const std::vector<double> result =
            rebalanced(steps, std::vector<double>(steps.size() - 1, 1.0), weights.size());
        std::copy(result.begin(), result.end(), edge.begin());
    }
}

AdaptiveMap AdaptiveMap::resampled(int increments) const {
    AdaptiveMap fresh(dimensions_, increments);
    for (int d = 0; d < dimensions_; ++d) {
        const std::span<const double> from = edges(d);
        double* to = fresh.edges_.data() + static_cast<std::size_t>(d) * fresh.stride();
        for (int k = 1; k < increments; ++k) {
            const double t = static_cast<double>(k) * increments_ / increments;
            const auto i = static_cast<std::size_t>(t);
            to[k] = from[i] + (t - static_cast<double>(i)) * (from[i + 1] - from[i]);
            to[k] = std::max(to[k], to[k - 1] + least_bin_width);
        }
        for (int k = increments - 1; k > 0; --k) to[k] = std::min(to[k], to[k + 1] - least_bin_width);
    }
    return fresh;
}

void AdaptiveMap::save(StateWriter& state) const {
    state.put(dimensions_);
    state.put(increments_);
    state.put(edges_);
}

AdaptiveMap AdaptiveMap::load(StateReader& state) {
    const int dimensions = state.get<int>(), increments = state.get<int>();
    check_shape(dimensions, increments);
    const std::vector<double> all = state.get_doubles();
    const std::size_t stride = static_cast<std::size_t>(increments) + 1;
    if (all.size() != stride * static_cast<std::size_t>(dimensions))
        throw Error("AdaptiveMap", "the saved map has another number of edges than its shape requires");
    std::vector<std::vector<double>> edges;
    for (std::size_t at = 0; at < all.size(); at += stride)
        edges.emplace_back(all.begin() + static_cast<std::ptrdiff_t>(at),
                           all.begin() + static_cast<std::ptrdiff_t>(at + stride));
    return AdaptiveMap(edges);
}

void AdaptiveMap::save(const std::string& path) const {
    StateWriter state;
    save(state);
    write_state(path, file_kind, state);
}

AdaptiveMap AdaptiveMap::load(const std::string& path) {
    return read_whole_file(path, file_kind, [](StateReader& state) { return load(state); });
}

} // namespace montelux
