#include "montelux/mc/integrate/grid/grid.h"

#include <cmath>
#include <limits>

#include "montelux/mc/integrate/sampling.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

constexpr std::uint64_t too_many = ~std::uint64_t{0};
constexpr double unknown_error = std::numeric_limits<double>::infinity();

enum class Rule : std::uint8_t { riemann, midpoint, trapezoid };

// n^d, or `too_many` where that is 2^63 or more.
std::uint64_t power(std::uint64_t n, int d) {
    std::uint64_t product = 1;
    for (int i = 0; i < d; ++i) {
        if (n != 0 && product > (too_many >> 1) / n) return too_many;
        product *= n;
    }
    return product;
}

// Sums of weighted values over a part of a grid.
struct GridSum {
    std::vector<double> sums;
    std::uint64_t evaluations = 0;
    NonFiniteCount non_finite;

    void merge(const GridSum& later) {
        for (std::size_t c = 0; c < sums.size(); ++c) sums[c] += later.sums[c];
        evaluations += later.evaluations;
        non_finite.merge(later.non_finite);
    }
};

class GridEstimator final : public Estimator {
  public:
    GridEstimator(const Problem& problem, Rule rule, std::uint64_t cells)
        : problem_(problem), rule_(rule), fixed_(cells), completed_(empty()), running_(empty()) {}

    StepOutcome step(const StepRequest& request) override {
        if (next_ == 0 && fixed_ != 0 && cells_ == fixed_) return StepOutcome::finished;
        const std::uint64_t next = next_ != 0 ? next_ : choose(request);
        if (next == 0 || request.max_evaluations == 0) return StepOutcome::exhausted;
        const bool nested = reuses(next);
        constexpr std::uint64_t most = 1 << 20;
        const std::uint64_t total = points(next);
        const std::uint64_t size = std::min({total - position_, most, request.max_evaluations});
        auto sum = sum_batches(
            size, [&] { return empty(); },
            [&](std::uint64_t first, std::uint64_t count, GridSum& to) {
                add(next, nested, position_ + first, count, to);
            },
            request.cancel);
        if (!sum) return StepOutcome::cancelled;
        next_ = next;
        position_ += size;
        running_.merge(*sum);
        if (position_ == total) complete(nested);
        return StepOutcome::advanced;
    }

    Tally tally() const override {
        Tally tally;
        tally.statistical = false;
        tally.value = value_;
        tally.value.resize(components());
        tally.standard_error = error_;
        tally.standard_error.resize(components(), unknown_error);
        tally.evaluations = completed_.evaluations + running_.evaluations;
        tally.non_finite = completed_.non_finite;
        tally.non_finite.merge(running_.non_finite);
        tally.ready = levels_ >= 3;
        if (levels_ == 0) tally.warnings.push_back("no grid was completed within the evaluations allowed");
        return tally;
    }

    void save(StateWriter& state) const override {
        state.put(levels_);
        state.put(cells_);
        state.put(next_);
        state.put(position_);
        state.put(value_);
        state.put(error_);
        state.put(difference_);
        for (const GridSum* s : {&completed_, &running_}) {
            state.put(s->sums);
            state.put(s->evaluations);
            montelux::save(state, s->non_finite);
        }
    }
    void load(StateReader& state) override {
        levels_ = state.get<int>();
        cells_ = state.get_word();
        next_ = state.get_word();
        position_ = state.get_word();
        value_ = state.get_doubles();
        error_ = state.get_doubles();
        difference_ = state.get_doubles();
        for (GridSum* s : {&completed_, &running_}) {
            s->sums = state.get_doubles();
            if (s->sums.size() != components())
                throw Error("the saved state has another number of components");
            s->evaluations = state.get_word();
            montelux::load(state, s->non_finite);
        }
    }

  private:
    int dimensions() const { return problem_.evaluator.dimensions(); }
    std::size_t components() const { return static_cast<std::size_t>(problem_.evaluator.components()); }
    GridSum empty() const { return {std::vector<double>(components()), 0, {}}; }

    std::uint64_t points_per_variable(std::uint64_t cells) const {
        return rule_ == Rule::trapezoid ? cells + 1 : cells;
    }
    std::uint64_t points(std::uint64_t cells) const {
        return power(points_per_variable(cells), dimensions());
    }
    // A grid of twice as many cells holds the points of the last one (not that of midpoints).
    bool reuses(std::uint64_t cells) const {
        return rule_ != Rule::midpoint && cells_ != 0 && cells == 2 * cells_;
    }
    std::uint64_t cost(std::uint64_t cells) const {
        const std::uint64_t all = points(cells);
        return all != too_many && reuses(cells) ? all - points(cells_) : all;
    }

    // The most cells whose points fit into the evaluations left.
    std::uint64_t largest(std::uint64_t evaluations) const {
        auto n = static_cast<std::uint64_t>(
            std::pow(static_cast<double>(evaluations), 1.0 / static_cast<double>(dimensions())));
        n = std::max<std::uint64_t>(n + 2, 3);
        while (n > 0 && (points(n) > evaluations || points(n) == too_many)) --n;
        return n;
    }

    // The cells of the next grid; 0 where none fits.
    std::uint64_t choose(const StepRequest& request) const {
        const std::uint64_t limit = request.max_evaluations;
        if (fixed_ != 0) return points(fixed_) <= limit && points(fixed_) != too_many ? fixed_ : 0;
        if (cells_ == 0) {
            std::uint64_t n = 2;
            while (power(n, dimensions()) < 32) ++n;
            return points(n) <= limit && points(n) != too_many ? n : largest(limit);
        }
        const std::uint64_t twice = 2 * cells_, cost_of_twice = cost(twice);
        const bool fits = cost_of_twice <= limit && cost_of_twice != too_many;
        const bool targeted = request.targeted();
        if (fits && (targeted || points(2 * twice) <= limit - cost_of_twice)) return twice;
        const std::uint64_t most = largest(limit);
        // Levels that are too close do not test each other.
        const double ratio = static_cast<double>(most) / static_cast<double>(cells_);
        return fits && most < twice ? twice : ratio >= 1.2 ? most : 0;
    }

    // Adds points [first, first + count) of the grid, in order with the first variable fastest.
    void add(std::uint64_t cells, bool nested, std::uint64_t first, std::uint64_t count, GridSum& to) const {
        const Evaluator& g = problem_.evaluator;
        const std::uint64_t per_variable = points_per_variable(cells);
        const double step = 1 / static_cast<double>(cells), offset = rule_ == Rule::midpoint ? 0.5 : 0;
        const auto d = static_cast<std::size_t>(dimensions());
        std::vector<std::uint64_t> index(d);
        std::uint64_t rest = first;
        for (std::size_t j = 0; j < d; ++j, rest /= per_variable) index[j] = rest % per_variable;

        PointBuffer all(count, dimensions());
        std::vector<double> weights(count, 1.0);
        std::size_t kept = 0;
        for (std::uint64_t i = 0; i < count; ++i) {
            bool old = nested;
            double weight = 1;
            for (std::size_t j = 0; j < d; ++j) {
                all(kept, static_cast<int>(j)) = (static_cast<double>(index[j]) + offset) * step;
                old = old && index[j] % 2 == 0;
                if (rule_ == Rule::trapezoid && (index[j] == 0 || index[j] == cells)) weight *= 0.5;
            }
            weights[kept] = weight;
            if (!old) ++kept;
            for (std::size_t j = 0; j < d && ++index[j] == per_variable; ++j) index[j] = 0;
        }
        if (kept == 0) return;
        ValueBuffer values(kept, g.components());
        g(all.view().slice(0, kept), values, to.non_finite);
        for (int c = 0; c < g.components(); ++c) {
            std::span<const double> v = std::as_const(values).component(c);
            double sum = 0;
            for (std::size_t i = 0; i < kept; ++i) sum += weights[i] * v[i];
            to.sums[static_cast<std::size_t>(c)] += sum;
        }
        to.evaluations += kept;
    }

    void complete(bool nested) {
        const double ratio = static_cast<double>(next_) / static_cast<double>(cells_);
        const double volume = std::pow(static_cast<double>(next_), -dimensions());
        const double gain = std::pow(ratio, rule_ == Rule::riemann ? 1 : 2);
        for (std::size_t c = 0; c < components(); ++c) {
            if (!nested) completed_.sums[c] = 0;
            completed_.sums[c] += running_.sums[c];
            running_.sums[c] = 0;
        }
        completed_.evaluations += running_.evaluations;
        completed_.non_finite.merge(running_.non_finite);
        running_ = empty();

        std::vector<double> value, error(components(), unknown_error),
            difference(components(), unknown_error);
        for (std::size_t c = 0; c < components(); ++c) {
            value.push_back(completed_.sums[c] * volume);
            if (levels_ == 0) continue;
            difference[c] = std::abs(value[c] - value_[c]) / (gain - 1);
            error[c] = levels_ == 1 ? difference[c] : std::max(difference[c], difference_[c] / gain);
        }
        value_ = std::move(value);
        error_ = std::move(error);
        difference_ = std::move(difference);
        cells_ = next_;
        next_ = position_ = 0;
        ++levels_;
    }

    Problem problem_;
    Rule rule_;
    std::uint64_t fixed_;
    int levels_ = 0;
    std::uint64_t cells_ = 0;               // of the last grid completed
    std::uint64_t next_ = 0, position_ = 0; // of the grid that is running, and its points done
    std::vector<double> value_, error_;     // of the last grid
    std::vector<double> difference_;        // to the grid before, as an error of the last one
    GridSum completed_, running_;
};

} // namespace

std::unique_ptr<Estimator> RiemannSum::estimator(const Problem& problem) const {
    return std::make_unique<GridEstimator>(problem, Rule::riemann, cells);
}
std::unique_ptr<Estimator> MidpointRule::estimator(const Problem& problem) const {
    return std::make_unique<GridEstimator>(problem, Rule::midpoint, cells);
}
std::unique_ptr<Estimator> TrapezoidRule::estimator(const Problem& problem) const {
    return std::make_unique<GridEstimator>(problem, Rule::trapezoid, cells);
}

} // namespace montelux
