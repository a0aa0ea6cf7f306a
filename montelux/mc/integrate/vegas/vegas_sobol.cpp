#include <algorithm>
#include <bit>
#include <cmath>

#include "montelux/mc/integrate/device_values.h"
#include "montelux/mc/integrate/lane_sum.h"
#include "montelux/mc/integrate/replicates.h"
#include "montelux/mc/integrate/sampling.h"
#include "montelux/mc/integrate/unit_points.h"
#include "montelux/mc/integrate/vegas/vegas_base.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

constexpr std::uint64_t first_points = 256;    // of a replicate
constexpr std::uint64_t iteration_growth = 16; // of iterations
constexpr std::uint64_t longest = std::uint64_t{1} << 31;

struct ReplicatePass {
    ReplicateSums sums;
    MapInsight insight;

    void merge(const ReplicatePass& later) {
        sums.merge(later.sums);
        insight.merge(later.insight);
    }
};

// The iteration that runs: so many points in each replicate.
struct Iteration {
    std::uint64_t points = 0, length = 0;
    std::uint32_t stream = 0;
    ReplicateSums sums;
    MapTraining training;
};

class SobolVegas final : public VegasEstimator {
  public:
    SobolVegas(const Problem& problem, const Vegas& settings)
        : VegasEstimator(problem, settings, 16 * settings.replicates) {
        // Its error for too many dimensions comes now, not in the first step.
        const ScrambledSobol points(problem.evaluator.dimensions(), 0, 0);
        iteration_.sums = ReplicateSums(settings.replicates, problem.evaluator.components());
    }

    StepOutcome step(const StepRequest& request) override {
        if (request.max_evaluations < replicates()) return StepOutcome::exhausted;
        VegasState next = state_;
        Iteration iteration = iteration_;
        std::uint64_t used = 0;
        plan(next, request);
        if (!run_pilot(next, request, used)) return StepOutcome::cancelled;
        if (!next.trained) return train(next, used, request);

        if (iteration.points == 0) begin(iteration, next);
        const std::uint64_t points = chunk(iteration, request.max_evaluations - used);
        if (points == 0) return StepOutcome::exhausted;
        auto pass = sample(next, iteration.stream, iteration.points, points, true, request.cancel);
        if (!pass) return StepOutcome::cancelled;
        const std::uint64_t all = points * replicates(), uniform = uniform_points(all);
        next.non_finite.merge(pass->insight.non_finite);
        if (!next.check.run(problem_, device_.get(), next.map, pass->insight, static_cast<double>(all),
                            uniform, next.stream++, next.inverse_scale, next.non_finite, request.cancel))
            return StepOutcome::cancelled;
        next.evaluations += used + all + uniform;
        note_iteration(next, pass->insight, static_cast<double>(all));
        iteration.sums.merge(pass->sums);
        iteration.points += points;
        // Each chunk's training data is a mean; longer chunks weigh more.
        iteration.training.merge(pass->insight.training);
        if (iteration.points >= iteration.length) {
            next.average.add(weight(iteration), estimate(iteration));
            refine(next.map, iteration.training, iteration.points * replicates());
            iteration.length *= iteration_growth;
            iteration.points = 0;
        }
        state_ = std::move(next);
        iteration_ = std::move(iteration);
        return StepOutcome::advanced;
    }

  private:
    std::uint64_t replicates() const { return static_cast<std::uint64_t>(settings_.replicates); }

    StepOutcome train(VegasState& next, std::uint64_t used, const StepRequest& request) {
        const std::uint64_t points = std::bit_floor(next.training_size / replicates());
        if (points == 0 || points * replicates() + used > request.max_evaluations)
            return StepOutcome::exhausted;
        sharpen(next.map, points * replicates());
        Iteration iteration;
        iteration.points = points;
        auto pass = sample(next, next.stream++, 0, points, true, request.cancel);
        if (!pass) return StepOutcome::cancelled;
        iteration.sums = std::move(pass->sums);
        const double all = static_cast<double>(points * replicates());
        next.evaluations += used + points * replicates();
        next.non_finite.merge(pass->insight.non_finite);
        note_training(next, all, relative_error(next, estimate(iteration), pass->insight));
        refine(next.map, pass->insight.training, points * replicates());
        rescale(next, pass->insight);
        state_ = std::move(next);
        return StepOutcome::advanced;
    }

    // A new iteration: new scrambles, the map unchanged.
    void begin(Iteration& iteration, VegasState& next) const {
        if (iteration.length == 0) iteration.length = iteration_growth * first_points;
        iteration.length = std::min(iteration.length, longest);
        iteration.stream = next.stream++;
        iteration.sums = ReplicateSums(settings_.replicates, problem_.evaluator.components());
        iteration.training = {};
        sharpen(next.map, iteration.length * replicates());
    }

    // Points that each replicate gets in this step; doublings, for nets of base 2 are the best sets.
    std::uint64_t chunk(const Iteration& iteration, std::uint64_t limit) const {
        const double room = static_cast<double>(limit) / (1 + settings_.uniform_share);
        const auto most = static_cast<std::uint64_t>(room / static_cast<double>(replicates()));
        const std::uint64_t large =
            std::bit_floor(std::max({large_step / replicates(), iteration.points / 8, std::uint64_t{1}}));
        const std::uint64_t start = std::max(first_points, iteration.length / iteration_growth);
        const std::uint64_t wanted = std::min(iteration.points == 0 ? start : iteration.points, large);
        // At the end of the budget the largest power of two that fits; a small remainder is not used.
        if (wanted <= most) return wanted;
        const std::uint64_t fits = std::bit_floor(most);
        return fits * 16 < iteration.points ? 0 : fits;
    }

    std::optional<ReplicatePass> sample(const VegasState& next, std::uint32_t stream, std::uint64_t first,
                                        std::uint64_t points, bool training, const CancelFlag* cancel) const {
        if (device_) {
            use_map(next.map);
            device_->set_replicates(problem_.seed, stream * 1024, settings_.replicates);
        }
        // A power of two, so that the points of a batch lie in one block, or are whole blocks.
        const std::uint64_t size = device_ ? std::bit_floor(device_->block_of_each(replicates())) : points;
        std::optional<ReplicatePass> all;
        for (std::uint64_t done = 0; done < points; done += size) {
            const std::uint64_t each = std::min(size, points - done);
            const std::uint64_t runs = (each + vegas_task_points - 1) / vegas_task_points;
            if (device_) device_->draw_sobol(first + done, each);
            auto pass = parallel_reduce_ordered(
                static_cast<std::int64_t>(runs * replicates()),
                [&](std::int64_t t) {
                    const auto replicate = static_cast<std::uint64_t>(t) / runs;
                    const std::uint64_t begin = static_cast<std::uint64_t>(t) % runs * vegas_task_points;
                    return run(next, stream, static_cast<int>(replicate), first, done + begin,
                               std::min(vegas_task_points, each - begin), replicate * each + begin,
                               points * replicates(), training);
                },
                [](ReplicatePass a, const ReplicatePass& b) {
                    a.merge(b);
                    return a;
                },
                cancel);
            if (!pass) return std::nullopt;
            if (all)
                all->merge(*pass);
            else
                all = std::move(pass);
        }
        return all;
    }

    // `count` points from number `begin` of a step on, whose first point is `first` of the replicate's sequence.
    ReplicatePass run(const VegasState& next, std::uint32_t stream, int replicate, std::uint64_t first,
                      std::uint64_t begin, std::uint64_t count, std::uint64_t number,
                      std::uint64_t all_points, bool training) const {
        const Evaluator& g = problem_.evaluator;
        ReplicatePass pass{ReplicateSums(settings_.replicates, g.components()), MapInsight(g.components())};
        pass.insight.tail = next.tail.empty();
        pass.insight.training = MapTraining(g.dimensions(), next.map.increments());
        // Streams of different iterations are independent, too.
        const ScrambledSobol sobol(g.dimensions(), problem_.seed,
                                   stream * 1024 + static_cast<std::uint32_t>(replicate));
        PointBuffer y;
        MappedPoints points;
        const double one = 1 / static_cast<double>(all_points);
        const std::vector<double> share(batch_size, one);
        std::vector<double> weighted(batch_size);
        for (std::uint64_t done = 0; done < count; done += batch_size) {
            const std::size_t n = std::min<std::uint64_t>(batch_size, count - done);
            const bool trains_map = training && settings_.alpha > 0 &&
                                    trains(stream * 1024 + static_cast<std::uint64_t>(replicate),
                                           first + (begin + done) / batch_size * batch_size, all_points);
            const auto fill = [&](PointBuffer& to) { sobol.fill(to, first + begin + done); };
            y.resize(n, g.dimensions());
            if (!device_ || trains_map) fill(y);
            if (device_)
                points.evaluate(g, next.map, *device_, number + done, n, fill, next.inverse_scale,
                                pass.insight.non_finite);
            else
                points.evaluate(g, next.map, y, next.inverse_scale, pass.insight.non_finite);
            pass.insight.add(points, {share.data(), n});
            for (std::size_t i = 0; i < n; ++i) weighted[i] = std::abs(points.values(0)[i]);
            pass.insight.tail.add({weighted.data(), n});
            pass.insight.tail_values += n;
            for (int c = 0; c < g.components(); ++c) {
                const double* w = points.values(c).data();
                pass.sums.sum(replicate, c) += lane_sum(n, [&](std::size_t i) { return w[i]; });
            }
            if (trains_map) {
                // Every point of the iteration weighs the same, whichever step it came in.
                for (std::size_t i = 0; i < n; ++i) weighted[i] = points.squares()[i];
                static const std::vector<double> ones(batch_size, 1.0);
                pass.insight.training.add(y, {ones.data(), n}, {weighted.data(), n});
            }
        }
        return pass;
    }

    static double weight(const Iteration& iteration) {
        return static_cast<double>(iteration.points) * static_cast<double>(iteration.points);
    }

    IterationEstimate estimate(const Iteration& iteration) const {
        const CovarianceMoments moments = iteration.sums.moments(iteration.points, problem_.full_covariance);
        const double r = settings_.replicates;
        IterationEstimate estimate{moments.means(),
                                   moments.products(),
                                   settings_.replicates - 1,
                                   {},
                                   r * static_cast<double>(iteration.points)};
        for (double& p : estimate.covariance) p /= r * (r - 1);
        return estimate;
    }

    IterationAverage average() const override {
        IterationAverage average = state_.average;
        if (iteration_.points > 0) average.add(weight(iteration_), estimate(iteration_));
        return average;
    }

    void save_more(StateWriter& state) const override {
        state.put(iteration_.points);
        state.put(iteration_.length);
        state.put(iteration_.stream);
        state.put(iteration_.sums.all());
        iteration_.training.save(state);
    }

    void load_more(StateReader& state) override {
        iteration_.points = state.get_word();
        iteration_.length = state.get_word();
        iteration_.stream = state.get<std::uint32_t>();
        std::vector<double> sums = state.get_doubles();
        if (sums.size() != iteration_.sums.all().size())
            throw Error("the saved state has another number of replicates or components");
        iteration_.sums.restore(std::move(sums));
        iteration_.training.load(state);
    }

    Iteration iteration_;
};

} // namespace

std::unique_ptr<VegasEstimator> sobol_vegas(const Problem& problem, const Vegas& settings) {
    return std::make_unique<SobolVegas>(problem, settings);
}

} // namespace montelux
