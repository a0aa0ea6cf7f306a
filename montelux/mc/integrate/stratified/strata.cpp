#include "montelux/mc/integrate/stratified/strata.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "montelux/mc/integrate/infinity.h"
#include "montelux/mc/integrate/sampling.h"
#include "montelux/mc/integrate/unit_points.h"

namespace montelux {
namespace {

// Sums over the strata of one task.
struct PartialSum {
    std::vector<double> value, covariance;
    std::vector<double> largest_variance; // that one value added, where there is one component
    ParetoTail
        tail; // of the largest deviations within strata, times the number of samples over the stratum's share
    std::uint64_t tail_values = 0;
    NonFiniteCount non_finite;

    void merge(const PartialSum& later) {
        for (std::size_t c = 0; c < value.size(); ++c)
            largest_variance[c] = std::max(largest_variance[c], later.largest_variance[c]);
        tail.merge(later.tail);
        tail_values += later.tail_values;
        for (std::size_t c = 0; c < value.size(); ++c) value[c] += later.value[c];
        for (std::size_t k = 0; k < covariance.size(); ++k) covariance[k] += later.covariance[k];
        non_finite.merge(later.non_finite);
    }
};

// A part of the points of a batch that lies in one stratum.
struct Piece {
    std::uint64_t stratum = 0;
    std::size_t begin = 0, end = 0;
    double volume = 0;
};

class StrataTask {
  public:
    StrataTask(const Problem& problem, const Strata& strata, std::span<const std::uint64_t> offsets,
               std::uint32_t stream, std::vector<double>* variances)
        : problem_(problem), strata_(strata), offsets_(offsets), stream_(stream), variances_(variances),
          moments_(components(), problem.full_covariance && components() > 1) {
        const auto m = static_cast<std::size_t>(components());
        sum_.value.resize(m);
        sum_.covariance.resize(m * (problem.full_covariance ? m : 1));
        sum_.largest_variance.resize(m);
    }

    // Strata [first, last).
    PartialSum operator()(std::uint64_t first, std::uint64_t last) {
        const auto d = static_cast<std::size_t>(problem_.evaluator.dimensions());
        std::vector<double> lower(d), width(d);
        std::uint64_t stratum = first;
        strata_.box(stratum, lower, width);
        double volume = product(width);
        for (std::uint64_t begin = offsets_[first], end = offsets_[last]; begin < end;) {
            const std::uint64_t count = std::min(batch_size, end - begin);
            u_.resize(count, problem_.evaluator.dimensions());
            values_.resize(count, components());
            fill_random(u_, problem_.seed, stream_, begin);
            pieces_.clear();
            for (std::size_t i = 0; i < count;) {
                while (offsets_[stratum + 1] <= begin + i) {
                    strata_.box(++stratum, lower, width);
                    volume = product(width);
                }
                const std::size_t to = std::min<std::uint64_t>(count, offsets_[stratum + 1] - begin);
                for (std::size_t j = 0; j < d; ++j) {
                    double* u = u_.coordinate(static_cast<int>(j)).data();
                    // Rounding must not reach the faces of the cube.
                    for (std::size_t p = i; p < to; ++p)
                        u[p] = std::min(lower[j] + width[j] * u[p], 1 - 0x1p-53);
                }
                pieces_.push_back({stratum, i, to, volume});
                i = to;
            }
            problem_.evaluator(u_, values_, sum_.non_finite);
            for (const Piece& piece : pieces_) add(piece, begin);
            begin += count;
        }
        return std::move(sum_);
    }

  private:
    int components() const { return problem_.evaluator.components(); }
    static double product(std::span<const double> widths) {
        double volume = 1;
        for (double w : widths) volume *= w;
        return volume;
    }

    void add(const Piece& piece, std::uint64_t batch_begin) {
        const bool ends = batch_begin + piece.end == offsets_[piece.stratum + 1];
        if (components() == 1) {
            std::span<const double> v =
                std::as_const(values_).component(0).subspan(piece.begin, piece.end - piece.begin);
            double mean = 0;
            for (double x : v) {
                mean += x;
                least_ = std::min(least_, x);
                greatest_ = std::max(greatest_, x);
            }
            mean /= static_cast<double>(v.size());
            double squares = 0;
            for (double x : v) squares += (x - mean) * (x - mean);
            if (ends && count_ == 0) return finish(piece, v.size(), mean, squares);
            // Chan, Golub and LeVeque 1983, as in CovarianceMoments.
            const double n = static_cast<double>(v.size()), before = static_cast<double>(count_);
            const double delta = mean - mean_, share = n / (n + before);
            mean_ += share * delta;
            squares_ += squares + delta * delta * before * share;
            count_ += v.size();
            if (!ends) return;
            finish(piece, count_, mean_, squares_);
            count_ = 0;
            mean_ = squares_ = 0;
            return;
        }
        one_.resize(static_cast<std::size_t>(components()));
        for (std::size_t i = piece.begin; i < piece.end; ++i) {
            for (int c = 0; c < components(); ++c) one_[static_cast<std::size_t>(c)] = values_(i, c);
            moments_.add(one_);
        }
        if (!ends) return;
        const double n = static_cast<double>(moments_.count()), v = piece.volume, scale = v * v / n;
        const auto m = static_cast<std::size_t>(components());
        for (std::size_t a = 0; a < m; ++a) {
            const int ia = static_cast<int>(a);
            sum_.value[a] += v * moments_.mean(ia);
            if (variances_) (*variances_)[piece.stratum * m + a] = moments_.variance(ia);
            if (!moments_.full()) {
                sum_.covariance[a] += scale * moments_.variance(ia);
                continue;
            }
            for (std::size_t b = 0; b <= a; ++b)
                sum_.covariance[a * m + b] += scale * moments_.covariance(ia, static_cast<int>(b));
        }
        moments_ = CovarianceMoments(components(), moments_.full());
    }

    void finish(const Piece& piece, std::uint64_t count, double mean, double squares) {
        const double n = static_cast<double>(count), variance = squares / (n - 1);
        sum_.value[0] += piece.volume * mean;
        const double share = piece.volume * piece.volume / (n * (n - 1));
        sum_.covariance[0] += share * squares;
        const double deviation = std::max(greatest_ - mean, mean - least_);
        sum_.largest_variance[0] = std::max(sum_.largest_variance[0], share * deviation * deviation);
        sum_.tail.add(piece.volume / n * static_cast<double>(offsets_.back()) * deviation);
        ++sum_.tail_values;
        least_ = infinity;
        greatest_ = -infinity;
        if (variances_) (*variances_)[piece.stratum] = variance;
    }

    const Problem& problem_;
    const Strata& strata_;
    std::span<const std::uint64_t> offsets_;
    std::uint32_t stream_;
    std::vector<double>* variances_;
    PartialSum sum_;
    PointBuffer u_;
    ValueBuffer values_;
    std::vector<Piece> pieces_;
    std::vector<double> one_;
    // The stratum that the batches so far have begun.
    CovarianceMoments moments_;
    std::uint64_t count_ = 0;
    double mean_ = 0, squares_ = 0, least_ = infinity, greatest_ = -infinity;
};

} // namespace

Strata grid_strata(std::vector<std::uint64_t> cells) {
    Strata strata;
    strata.count = 1;
    for (std::uint64_t n : cells) strata.count *= n;
    strata.box = [cells = std::move(cells)](std::uint64_t k, std::span<double> lower,
                                            std::span<double> width) {
        for (std::size_t d = 0; d < cells.size(); ++d, k /= cells[d - 1]) {
            width[d] = 1 / static_cast<double>(cells[d]);
            lower[d] = static_cast<double>(k % cells[d]) * width[d];
        }
    };
    return strata;
}

std::vector<std::uint64_t> balanced_cells(int dimensions, std::uint64_t count) {
    auto fits = [&](std::uint64_t n, int more) {
        double product = 1;
        for (int d = 0; d < dimensions; ++d) product *= static_cast<double>(d < more ? n + 1 : n);
        return product <= static_cast<double>(count);
    };
    auto n = static_cast<std::uint64_t>(std::pow(static_cast<double>(count), 1.0 / dimensions));
    n = std::max<std::uint64_t>(n, 1);
    while (fits(n + 1, 0)) ++n;
    while (n > 1 && !fits(n, 0)) --n;
    int more = 0;
    while (more < dimensions && fits(n, more + 1)) ++more;
    std::vector<std::uint64_t> cells(static_cast<std::size_t>(dimensions), n);
    for (int d = 0; d < more; ++d) ++cells[static_cast<std::size_t>(d)];
    return cells;
}

std::optional<StrataSum> sample_strata(const Problem& problem, const Strata& strata,
                                       std::span<const std::uint64_t> offsets, std::uint32_t stream,
                                       std::vector<double>* variances, const CancelFlag* cancel) {
    if (variances)
        variances->assign(strata.count * static_cast<std::size_t>(problem.evaluator.components()), 0.0);
    // Tasks of whole strata, of about equal numbers of samples.
    std::vector<std::uint64_t> starts{0};
    for (std::uint64_t k = 1; k <= strata.count; ++k)
        if (k == strata.count || offsets[k] - offsets[starts.back()] >= batch_size * batches_per_task)
            starts.push_back(k);
    auto sum = parallel_reduce_ordered(
        static_cast<std::int64_t>(starts.size()) - 1,
        [&](std::int64_t t) {
            StrataTask task(problem, strata, offsets, stream, variances);
            return task(starts[static_cast<std::size_t>(t)], starts[static_cast<std::size_t>(t) + 1]);
        },
        [](PartialSum a, const PartialSum& b) {
            a.merge(b);
            return a;
        },
        cancel);
    if (!sum) return std::nullopt;
    return StrataSum{{std::move(sum->value), std::move(sum->covariance), 0, std::move(sum->largest_variance),
                      static_cast<double>(offsets.back())},
                     std::move(sum->tail),
                     sum->tail_values,
                     std::move(sum->non_finite)};
}

std::vector<std::uint64_t> allocate_samples(std::uint64_t strata, std::uint64_t samples, std::uint64_t least,
                                            std::span<const double> shares) {
    double total = 0;
    for (double s : shares) total += s;
    const bool equal = !(total > 0 && std::isfinite(total));
    const double free = static_cast<double>(samples - strata * least);
    std::vector<std::uint64_t> offsets(strata + 1);
    double sum = 0;
    for (std::uint64_t k = 0; k < strata; ++k) {
        sum += equal ? 1 / static_cast<double>(strata) : shares[k] / total;
        // Rounding the running sum keeps the total.
        offsets[k + 1] = (k + 1) * least + static_cast<std::uint64_t>(std::floor(free * std::min(sum, 1.0)));
    }
    offsets[strata] = std::max(offsets[strata], samples);
    return offsets;
}

std::uint64_t next_pass_size(std::uint64_t done, const StepRequest& request) {
    constexpr std::uint64_t limited = std::uint64_t{1} << 50, large = 1 << 20, largest = 1 << 24;
    const std::uint64_t most = std::clamp(done / 10, large, largest), limit = request.max_evaluations;
    const bool to_the_end = !request.targeted() && limit < limited;
    const std::uint64_t size = to_the_end ? most : done == 0 ? 4096 : std::min(done, most);
    // Leaves no small rest.
    return limit < 2 * size ? std::min(limit, 2 * most) : size;
}

} // namespace montelux
