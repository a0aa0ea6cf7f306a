#include "montelux/mc/integrate/quasi/quasi.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "montelux/mc/integrate/device_values.h"
#include "montelux/mc/integrate/infinity.h"
#include "montelux/mc/integrate/lane_sum.h"
#include "montelux/mc/integrate/quasi/randomised_points.h"
#include "montelux/mc/integrate/replicates.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/math/special.h"

namespace montelux {
namespace {

constexpr std::uint64_t first_points = 64;
constexpr std::uint64_t limited = std::uint64_t{1} << 50; // more evaluations than any run makes

Randomisation best_randomisation(PointSetKind kind) {
    switch (kind) {
    case PointSetKind::halton:
    case PointSetKind::hammersley:
    case PointSetKind::sobol:
        return Randomisation::scramble;
    case PointSetKind::independent:
        return Randomisation::none;
    default:
        return Randomisation::shift;
    }
}

class QuasiEstimator final : public Estimator {
  public:
    QuasiEstimator(const Problem& problem, const Quasi& settings)
        : problem_(problem), kind_(settings.points),
          randomisation_(settings.randomisation.value_or(best_randomisation(kind_))),
          plain_(randomisation_ == Randomisation::none && kind_ != PointSetKind::independent),
          asked_(settings.replicates), device_(DeviceValues::of(problem.evaluator)),
          completed_extremes_(problem.evaluator.components()), running_extremes_(completed_extremes_) {
        if (asked_ < 0 || asked_ == 1 || asked_ > 65536)
            throw Error("quasi", std::to_string(asked_) + " replicates; expected 2 to 65536, or 0");
        if (device_ && (kind_ != PointSetKind::sobol || randomisation_ != Randomisation::scramble))
            throw Error("quasi", "a device draws scrambled Sobol' points only, not '" +
                                     std::string(to_string(kind_)) + "' with the randomisation '" +
                                     std::string(to_string(randomisation_)) + "'");
        // Throws at once if the set does not exist.
        RandomisedPoints(kind_, randomisation_, problem_.evaluator.dimensions(), 1, 0, 0);
    }

    StepOutcome step(const StepRequest& request) override {
        const int replicates = replicates_ ? replicates_ : choose_replicates(request.max_evaluations);
        const std::uint64_t each = request.max_evaluations / static_cast<std::uint64_t>(replicates);
        const std::uint64_t next = next_ ? next_ : choose_points(request, each);
        const std::uint64_t begin = (extensible() ? points_ : 0) + position_;
        const auto all = static_cast<std::uint64_t>(replicates);
        const std::uint64_t most =
            device_ ? device_->block_of_each(all) : std::max<std::uint64_t>(1, large_step / all);
        const std::uint64_t size = next == 0 ? 0 : std::min({next - begin, each, most});
        if (size == 0) return StepOutcome::exhausted;
        ReplicateSums sums(replicates, problem_.evaluator.components());
        NonFiniteCount non_finite;
        ExtremeValues extremes = running_extremes_.empty();
        if (!add(begin, size, next, sums, non_finite, extremes, request.cancel))
            return StepOutcome::cancelled;

        if (replicates_ == 0) {
            replicates_ = replicates;
            completed_ = running_ = ReplicateSums(replicates, problem_.evaluator.components());
        }
        next_ = next;
        position_ += size;
        evaluations_ += size * static_cast<std::uint64_t>(replicates);
        relative_target_ = request.relative_error;
        absolute_target_ = request.absolute_error;
        sizes_.assign(request.sizes.begin(), request.sizes.end());
        non_finite_.merge(non_finite);
        running_.merge(sums);
        running_extremes_.merge(extremes);
        if (begin + size == next_) complete();
        return StepOutcome::advanced;
    }

    Tally tally() const override {
        Tally tally;
        tally.evaluations = evaluations_;
        tally.non_finite = non_finite_;
        tally.statistical = !plain_;
        const auto m = static_cast<std::size_t>(problem_.evaluator.components());
        tally.value.assign(m, 0.0);
        tally.standard_error.assign(m, infinity);
        tally.ready = false;
        if (points_ == 0) return tally;
        tally_mean(completed_.moments(points_, problem_.full_covariance), tally);
        if (plain_) {
            tally.covariance.clear();
            return tally;
        }
        judge_extremes(completed_extremes_, points_ * static_cast<std::uint64_t>(replicates_), tally);
        tally.ready = trusted(tally);
        warn(tally);
        return tally;
    }

    void save(StateWriter& state) const override {
        state.put(replicates_);
        state.put(points_);
        state.put(next_);
        state.put(position_);
        state.put(evaluations_);
        state.put(relative_target_);
        state.put(absolute_target_);
        state.put(sizes_);
        state.put(completed_.all());
        state.put(running_.all());
        completed_extremes_.save(state);
        running_extremes_.save(state);
        state.put(previous_value_);
        state.put(previous_error_);
        montelux::save(state, non_finite_);
    }
    void load(StateReader& state) override {
        replicates_ = state.get<int>();
        points_ = state.get_word();
        next_ = state.get_word();
        position_ = state.get_word();
        evaluations_ = state.get_word();
        relative_target_ = state.get_double();
        absolute_target_ = state.get_double();
        sizes_ = state.get_doubles();
        const int m = problem_.evaluator.components();
        for (ReplicateSums* sums : {&completed_, &running_}) {
            std::vector<double> all = state.get_doubles();
            if (replicates_ < 0 ||
                all.size() != static_cast<std::size_t>(replicates_) * static_cast<std::size_t>(m))
                throw Error("the saved state has another number of replicates or components");
            *sums = ReplicateSums(replicates_, m);
            sums->restore(std::move(all));
        }
        completed_extremes_.load(state);
        running_extremes_.load(state);
        previous_value_ = state.get_doubles();
        previous_error_ = state.get_doubles();
        montelux::load(state, non_finite_);
    }

  private:
    bool extensible() const { return kind_ != PointSetKind::hammersley; }
    std::uint64_t most_points() const {
        const bool full_length = kind_ == PointSetKind::sobol && randomisation_ == Randomisation::scramble;
        return full_length ? ScrambledSobol::max_points : ScrambledSobol::max_points - 1;
    }

    int choose_replicates(std::uint64_t evaluations) const {
        if (plain_) return 1;
        if (asked_ != 0) return asked_;
        if (kind_ != PointSetKind::sobol || evaluations >= limited || evaluations < 24) return 16;
        // At least 12, each of the largest possible power of two of points.
        return static_cast<int>(evaluations >> (std::bit_width(evaluations / 12) - 1));
    }

    // The next number of points per replicate; 0 if the evaluations do not suffice. `each`: evaluations left
    // per replicate.
    std::uint64_t choose_points(const StepRequest& request, std::uint64_t each) const {
        const bool binary = kind_ == PointSetKind::sobol;
        const bool targeted = request.targeted();
        if (each == 0) return 0;
        if (points_ == 0) {
            // A set without prefixes starts anew, which costs all its points in one step.
            constexpr std::uint64_t short_wait = 1 << 16;
            if (!extensible() && !targeted && each <= short_wait) return each;
            return each >= first_points ? first_points : binary ? std::bit_floor(each) : each;
        }
        const std::uint64_t twice = 2 * points_, start = extensible() ? points_ : 0;
        if (twice <= most_points() && twice - start <= each) {
            const std::uint64_t after = each - (twice - start),
                                next_cost = 2 * twice - (extensible() ? twice : 0);
            if (binary || targeted || next_cost <= after) return twice;
        }
        if (binary) return 0;
        // Uses up the rest if it is large enough.
        const std::uint64_t all = std::min(start + each, most_points());
        return all >= points_ + points_ / 16 + 1 ? all : 0;
    }

    // Adds points [begin, begin + size) of each replicate. Parts of the work are cut by number alone, and
    // added up in order.
    bool add(std::uint64_t begin, std::uint64_t size, std::uint64_t set, ReplicateSums& sums,
             NonFiniteCount& non_finite, ExtremeValues& extremes, const CancelFlag* cancel) const {
        constexpr std::uint64_t part = batch_size * batches_per_task;
        const std::uint64_t parts = (size + part - 1) / part;
        const int m = problem_.evaluator.components();
        struct Slot {
            std::vector<double> sums;
            NonFiniteCount non_finite;
            ExtremeValues extremes;
        };
        std::vector<Slot> slots(static_cast<std::size_t>(sums.replicates()) * parts);
        std::vector<RandomisedPoints> sets;
        sets.reserve(static_cast<std::size_t>(sums.replicates()));
        for (int r = 0; r < sums.replicates(); ++r)
            sets.emplace_back(kind_, randomisation_, problem_.evaluator.dimensions(),
                              static_cast<std::uint32_t>(std::min<std::uint64_t>(set, ~std::uint32_t{0})),
                              problem_.seed, static_cast<std::uint32_t>(r));
        if (device_) {
            device_->set_replicates(problem_.seed, 0, sums.replicates());
            device_->summarise_above(
                std::max(running_extremes_.tail().floor(), completed_extremes_.tail().floor()));
            device_->draw_sobol(begin, size);
        }
        const bool whole = parallel_for(
            static_cast<std::int64_t>(slots.size()),
            [&](std::int64_t task) {
                Slot& slot = slots[static_cast<std::size_t>(task)];
                slot.sums.assign(static_cast<std::size_t>(m), 0.0);
                slot.extremes = running_extremes_.empty();
                const RandomisedPoints& replicate = sets[static_cast<std::size_t>(task) / parts];
                const std::uint64_t from = static_cast<std::uint64_t>(task) % parts * part;
                const std::uint64_t to = std::min(size, from + part);
                PointBuffer u;
                ValueBuffer values;
                for (std::uint64_t first = from; first < to; first += batch_size) {
                    const std::uint64_t count = std::min(batch_size, to - first);
                    const std::uint64_t number = static_cast<std::uint64_t>(task) / parts * size + first;
                    if (const DeviceSummary* s = device_ ? device_->summary(number) : nullptr) {
                        slot.sums[0] += s->sum;
                        slot.extremes.add(*s, count);
                        continue;
                    }
                    values.resize(count, m);
                    if (device_) {
                        device_->read(
                            number, values, [&](PointBuffer& at) { replicate.fill(at, begin + first); },
                            slot.non_finite);
                    } else {
                        u.resize(count, problem_.evaluator.dimensions());
                        replicate.fill(u, begin + first);
                        problem_.evaluator(u, values, slot.non_finite);
                    }
                    for (int c = 0; c < m; ++c) {
                        std::span<const double> v = std::as_const(values).component(c);
                        slot.sums[static_cast<std::size_t>(c)] +=
                            lane_sum(count, [v](std::size_t i) { return v[i]; });
                        slot.extremes.add(c, v);
                    }
                }
            },
            cancel);
        if (!whole) return false;
        for (std::size_t i = 0; i < slots.size(); ++i) {
            for (int c = 0; c < m; ++c)
                sums.sum(static_cast<int>(i / parts), c) += slots[i].sums[static_cast<std::size_t>(c)];
            non_finite.merge(slots[i].non_finite);
            extremes.merge(slots[i].extremes);
        }
        return true;
    }

    void complete() {
        if (points_ > 0) {
            Tally before;
            tally_mean(completed_.moments(points_, false), before);
            previous_value_ = std::move(before.value);
            previous_error_ = std::move(before.standard_error);
        }
        if (extensible()) {
            completed_.merge(running_);
            completed_extremes_.merge(running_extremes_);
        } else {
            completed_ = running_;
            completed_extremes_ = running_extremes_;
        }
        running_extremes_ = ExtremeValues(completed_.components());
        running_ = ReplicateSums(replicates_, completed_.components());
        points_ = next_;
        next_ = position_ = 0;
    }

    // May the targets be believed (see Quasi)?
    bool trusted(const Tally& tally) const {
        if (previous_error_.empty()) return false;
        const double student = student_t_quantile(normal_cdf(3), replicates_ - 1) / 3;
        bool surely = true, twice = true;
        const StepRequest target{
            .relative_error = relative_target_, .absolute_error = absolute_target_, .sizes = sizes_};
        for (std::size_t c = 0; c < tally.value.size(); ++c) {
            const double tolerance = target.tolerance(c, tally.value[c]);
            surely = surely && tally.standard_error[c] * student <= tolerance;
            twice = twice && tally.standard_error[c] <= tolerance &&
                    previous_error_[c] <= target.tolerance(c, previous_value_[c]);
        }
        return surely || twice;
    }

    // Warns if few replicates see something that the others miss, or if all values are zero.
    void warn(Tally& tally) const {
        const CovarianceMoments moments = completed_.moments(points_, false);
        for (int c = 0; c < moments.components(); ++c) {
            const std::string which =
                moments.components() > 1 ? " of component " + std::to_string(c + 1) : std::string();
            const double squares = moments.variance(c) * (replicates_ - 1);
            if (squares == 0 && moments.mean(c) == 0)
                tally.warnings.push_back("every value" + which + " was zero");
            if (replicates_ < 8 || !(squares > 0)) continue;
            double largest = 0;
            for (int r = 0; r < replicates_; ++r) {
                const double off = completed_.sum(r, c) / static_cast<double>(points_) - moments.mean(c);
                largest = std::max(largest, off * off);
            }
            // The share b of one of R normal deviations squared, b R / (R - 1), follows Beta(1/2, (R - 2) /
            // 2).
            const double share = largest / squares * replicates_ / (replicates_ - 1);
            const double p =
                replicates_ * (1 - incomplete_beta(0.5, 0.5 * (replicates_ - 2), std::min(share, 1.0)));
            if (p < 1e-4)
                tally.warnings.push_back(
                    "one of the " + std::to_string(replicates_) + " replicates" + which +
                    " lies far from all others: a part of the integral may be seen seldom");
        }
    }

    Problem problem_;
    PointSetKind kind_;
    Randomisation randomisation_;
    bool plain_;
    int asked_;
    std::unique_ptr<DeviceValues> device_; // null: the processor
    int replicates_ = 0;                   // 0 before the first step
    // Points of each replicate: in the estimate; to be reached; and done on the way there.
    std::uint64_t points_ = 0, next_ = 0, position_ = 0;
    std::uint64_t evaluations_ = 0;
    double relative_target_ = 0, absolute_target_ = 0; // of the last request,
    std::vector<double> sizes_;                        // and its sizes
    ReplicateSums completed_, running_;
    ExtremeValues completed_extremes_, running_extremes_;
    std::vector<double> previous_value_, previous_error_; // at the number of points before
    NonFiniteCount non_finite_;
};

} // namespace

std::unique_ptr<Estimator> Quasi::estimator(const Problem& problem) const {
    return std::make_unique<QuasiEstimator>(problem, *this);
}

} // namespace montelux
