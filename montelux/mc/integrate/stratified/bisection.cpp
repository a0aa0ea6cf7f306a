#include "montelux/mc/integrate/stratified/bisection.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "montelux/mc/integrate/sampling.h"
#include "montelux/mc/integrate/unit_points.h"
#include "montelux/mc/random/hash.h"

namespace montelux {
namespace {

constexpr double least_share_of_samples = 0.1; // of a half
constexpr std::uint64_t most_numbers_kept = std::uint64_t{1} << 24;

// A box, its pilot points (point by point: coordinates, then values), and the samples that it may spend.
struct Node {
    std::vector<double> lower, width, pilot;
    std::uint64_t samples = 0;
    std::uint64_t key = 1; // of the path that leads here
};

// Split of a node into two halves; empty if it stays a box.
struct Split {
    std::vector<Node> halves;
    std::uint64_t pilot = 0; // evaluations
    NonFiniteCount non_finite;
};

class Bisector {
  public:
    Bisector(const Problem& problem, double pilot_part, std::uint32_t stream)
        : problem_(problem), pilot_part_(pilot_part), stream_(stream),
          d_(static_cast<std::size_t>(problem.evaluator.dimensions())),
          m_(static_cast<std::size_t>(problem.evaluator.components())), inverse_variance_(m_, 1.0) {}

    // Points that show the variances in both halves along each variable.
    std::uint64_t least_pilot() const { return 16 + 4 * d_; }

    // Evaluates `count` further pilot points in the box of the node. False when cancelled.
    bool explore(Node& node, std::uint64_t count, Split& split, const CancelFlag* cancel) const {
        struct Points {
            std::vector<double> numbers;
            NonFiniteCount non_finite;
            void merge(const Points& later) {
                numbers.insert(numbers.end(), later.numbers.begin(), later.numbers.end());
                non_finite.merge(later.non_finite);
            }
        };
        const std::uint64_t seed = hash_key(problem_.seed, node.key);
        auto points = sum_batches(
            count, [] { return Points{}; },
            [&](std::uint64_t first, std::uint64_t n, Points& to) {
                PointBuffer u(n, static_cast<int>(d_));
                ValueBuffer g(n, static_cast<int>(m_));
                fill_random(u, seed, stream_, first);
                for (std::size_t j = 0; j < d_; ++j)
                    for (double& x : u.coordinate(static_cast<int>(j)))
                        x = std::min(node.lower[j] + node.width[j] * x, 1 - 0x1p-53);
                problem_.evaluator(u, g, to.non_finite);
                for (std::size_t i = 0; i < n; ++i) {
                    for (std::size_t j = 0; j < d_; ++j) to.numbers.push_back(u(i, static_cast<int>(j)));
                    for (std::size_t c = 0; c < m_; ++c) to.numbers.push_back(g(i, static_cast<int>(c)));
                }
            },
            cancel);
        if (!points) return false;
        node.pilot.insert(node.pilot.end(), points->numbers.begin(), points->numbers.end());
        split.pilot += count;
        split.non_finite.merge(points->non_finite);
        return true;
    }

    // Components count relative to their variances over the whole cube.
    void set_scales(const Node& root) {
        const std::size_t n = root.pilot.size() / (d_ + m_);
        for (std::size_t c = 0; c < m_; ++c) {
            double sum = 0, squares = 0;
            for (std::size_t i = 0; i < n; ++i) sum += root.pilot[i * (d_ + m_) + d_ + c];
            const double mean = sum / static_cast<double>(n);
            for (std::size_t i = 0; i < n; ++i)
                squares += std::pow(root.pilot[i * (d_ + m_) + d_ + c] - mean, 2);
            inverse_variance_[c] = squares > 0 ? static_cast<double>(n) / squares : 0;
        }
    }

    std::optional<Split> split(Node& node, const CancelFlag* cancel) const {
        Split result;
        std::size_t count = node.pilot.size() / (d_ + m_);
        const std::uint64_t wanted = std::max(
            least_pilot(), static_cast<std::uint64_t>(0.5 * pilot_part_ * static_cast<double>(node.samples)));
        if (node.samples < 8 * least_pilot()) return result;
        if (2 * count < wanted) {
            const std::uint64_t more = wanted - count;
            if (!explore(node, more, result, cancel)) return std::nullopt;
            node.samples -= more;
            count += more;
        }
        halve(node, count, result);
        return result;
    }

    // The standard deviations in the halves along every variable, of all components together.
    void halve(Node& node, std::size_t count, Split& result) const {
        const std::size_t stride = d_ + m_;
        std::size_t best = d_;
        double best_sum = 0, best_lower = 0, best_upper = 0;
        // Of what lies in the upper halves: counts, and sums and squares of values less the node's means,
        // which keeps their digits. One pass; the inner loops run over variables.
        std::vector<double> mean(m_), total(m_), squares(m_), middle(d_);
        std::vector<double> above(d_), above_sum(m_ * d_), above_squares(m_ * d_), in_upper(d_);
        for (std::size_t j = 0; j < d_; ++j) middle[j] = node.lower[j] + 0.5 * node.width[j];
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t c = 0; c < m_; ++c) mean[c] += node.pilot[i * stride + d_ + c];
        for (double& v : mean) v /= static_cast<double>(count);
        for (std::size_t i = 0; i < count; ++i) {
            const double* p = &node.pilot[i * stride];
            for (std::size_t j = 0; j < d_; ++j) in_upper[j] = p[j] >= middle[j] ? 1.0 : 0.0;
            for (std::size_t j = 0; j < d_; ++j) above[j] += in_upper[j];
            for (std::size_t c = 0; c < m_; ++c) {
                const double v = p[d_ + c] - mean[c], square = v * v;
                total[c] += v;
                squares[c] += square;
                double *sums = &above_sum[c * d_], *sums_of_squares = &above_squares[c * d_];
                for (std::size_t j = 0; j < d_; ++j) sums[j] += in_upper[j] * v;
                for (std::size_t j = 0; j < d_; ++j) sums_of_squares[j] += in_upper[j] * square;
            }
        }
        for (std::size_t j = 0; j < d_; ++j) {
            const double upper_count = above[j], lower_count = static_cast<double>(count) - upper_count;
            if (lower_count < 3 || upper_count < 3) continue;
            auto variance = [](double n, double sum, double sum_of_squares) {
                return std::max(0.0, sum_of_squares - sum * sum / n) / (n - 1);
            };
            double lower_variance = 0, upper_variance = 0;
            for (std::size_t c = 0; c < m_; ++c) {
                const double sum = above_sum[c * d_ + j], square = above_squares[c * d_ + j];
                upper_variance += inverse_variance_[c] * variance(upper_count, sum, square);
                lower_variance +=
                    inverse_variance_[c] * variance(lower_count, total[c] - sum, squares[c] - square);
            }
            const double root[2] = {std::cbrt(lower_variance), std::cbrt(upper_variance)};
            // The wider side first on a tie.
            const double sum = root[0] + root[1];
            if (best == d_ || sum < best_sum || (sum == best_sum && node.width[j] > node.width[best])) {
                best = j;
                best_sum = sum;
                best_lower = root[0];
                best_upper = root[1];
            }
        }
        if (best == d_) return;
        double share = best_sum > 0 ? best_lower / (best_lower + best_upper) : 0.5;
        share = std::clamp(share, least_share_of_samples, 1 - least_share_of_samples);

        Node lower, upper;
        lower.lower = node.lower;
        lower.width = node.width;
        lower.width[best] *= 0.5;
        upper.lower = node.lower;
        upper.width = lower.width;
        upper.lower[best] += lower.width[best];
        lower.samples = static_cast<std::uint64_t>(share * static_cast<double>(node.samples));
        upper.samples = node.samples - lower.samples;
        lower.key = hash_key(node.key, 0);
        upper.key = hash_key(node.key, 1);
        for (std::size_t i = 0; i < count; ++i) {
            const double* p = &node.pilot[i * stride];
            std::vector<double>& to = p[best] >= upper.lower[best] ? upper.pilot : lower.pilot;
            to.insert(to.end(), p, p + stride);
        }
        result.halves.push_back(std::move(lower));
        result.halves.push_back(std::move(upper));
    }

  private:
    const Problem& problem_;
    double pilot_part_;
    std::uint32_t stream_;
    std::size_t d_, m_;
    std::vector<double> inverse_variance_;
};

} // namespace

Strata Bisection::strata() const {
    const std::size_t count = offsets.size() - 1, d = lower.size() / count;
    return {count, [this, d](std::uint64_t k, std::span<double> l, std::span<double> w) {
                std::copy_n(&lower[k * d], d, l.begin());
                std::copy_n(&width[k * d], d, w.begin());
            }};
}

std::optional<Bisection> bisect(const Problem& problem, std::uint64_t samples, double pilot_part,
                                std::uint32_t stream, const CancelFlag* cancel) {
    const auto d = static_cast<std::size_t>(problem.evaluator.dimensions());
    const auto m = static_cast<std::uint64_t>(problem.evaluator.components());
    Bisector bisector(problem, pilot_part, stream);
    Bisection found;
    found.offsets.push_back(0);

    std::vector<Node> level(1);
    level[0].lower.assign(d, 0.0);
    level[0].width.assign(d, 1.0);
    level[0].samples = samples;
    Split root;
    const auto pilot = std::min(static_cast<std::uint64_t>(pilot_part * static_cast<double>(samples)),
                                std::max<std::uint64_t>(1, most_numbers_kept / (d + m)));
    if (pilot >= bisector.least_pilot()) {
        if (!bisector.explore(level[0], pilot, root, cancel)) return std::nullopt;
        level[0].samples -= pilot;
        bisector.set_scales(level[0]);
    }
    found.pilot = root.pilot;
    found.non_finite = std::move(root.non_finite);

    // Level by level; the split of a node depends only on the node.
    while (!level.empty()) {
        std::vector<std::optional<Split>> splits(level.size());
        const bool whole = parallel_for(
            static_cast<std::int64_t>(level.size()),
            [&](std::int64_t i) {
                const auto k = static_cast<std::size_t>(i);
                splits[k] = found.pilot == 0 ? Split{} : bisector.split(level[k], cancel);
            },
            cancel);
        if (!whole) return std::nullopt;
        std::vector<Node> next;
        for (std::size_t k = 0; k < level.size(); ++k) {
            if (!splits[k]) return std::nullopt;
            Split& split = *splits[k];
            found.pilot += split.pilot;
            found.non_finite.merge(split.non_finite);
            if (split.halves.empty()) {
                const Node& box = level[k];
                found.lower.insert(found.lower.end(), box.lower.begin(), box.lower.end());
                found.width.insert(found.width.end(), box.width.begin(), box.width.end());
                found.offsets.push_back(found.offsets.back() + box.samples);
            }
            for (Node& half : split.halves) next.push_back(std::move(half));
        }
        level = std::move(next);
    }
    return found;
}

} // namespace montelux
