#include <algorithm>
#include <cmath>

#include "montelux/mc/integrate/device_values.h"
#include "montelux/mc/integrate/infinity.h"
#include "montelux/mc/integrate/sampling.h"
#include "montelux/mc/integrate/unit_points.h"
#include "montelux/mc/integrate/vegas/hypercubes.h"
#include "montelux/mc/integrate/vegas/vegas_base.h"
#include "montelux/mc/random/hash.h"

namespace montelux {
namespace {

constexpr std::uint64_t most_boxes = 1 << 18;
constexpr std::uint64_t points_per_box = 8; // at least two of them are each box's own

// What the values in each box of one variable say of jumps between them.
struct BoxLine {
    BoxLine(std::size_t components, std::size_t boxes) : means(components * boxes), variances(means) {}

    std::vector<double> means, variances; // of component c in box h: number h components + c
};

// Moments of the values in one box.
class BoxMoments {
  public:
    BoxMoments(int components, bool full)
        : full_(full), mean_(static_cast<std::size_t>(components)), run_mean_(mean_),
          least_(mean_.size(), infinity), greatest_(mean_.size(), -infinity),
          products_(mean_.size() * (full ? mean_.size() : 1)) {}

    std::uint32_t count() const { return count_; }
    // Points [begin, begin + n) of the batch.
    void add(const MappedPoints& points, std::size_t begin, std::uint32_t n) {
        const std::size_t m = mean_.size();
        for (std::size_t c = 0; c < m; ++c) {
            const double* w = points.values(static_cast<int>(c)).data() + begin;
            double sum = 0;
            for (std::uint32_t i = 0; i < n; ++i) sum += w[i];
            for (std::uint32_t i = 0; i < n; ++i) {
                least_[c] = std::min(least_[c], w[i]);
                greatest_[c] = std::max(greatest_[c], w[i]);
            }
            run_mean_[c] = sum / n;
        }
        // Chan, Golub and LeVeque 1983: moments of two parts.
        const double weight = static_cast<double>(count_) * n / (static_cast<double>(count_) + n);
        for (std::size_t a = 0; a < m; ++a)
            for (std::size_t b = full_ ? 0 : a; b <= a; ++b) {
                const double* wa = points.values(static_cast<int>(a)).data() + begin;
                const double* wb = points.values(static_cast<int>(b)).data() + begin;
                double sum = 0;
                for (std::uint32_t i = 0; i < n; ++i) sum += (wa[i] - run_mean_[a]) * (wb[i] - run_mean_[b]);
                products_[full_ ? a * m + b : a] +=
                    sum + weight * (run_mean_[a] - mean_[a]) * (run_mean_[b] - mean_[b]);
            }
        count_ += n;
        for (std::size_t c = 0; c < m; ++c) mean_[c] += (run_mean_[c] - mean_[c]) * n / count_;
    }
    // Greatest distance of a value of the first component from the mean.
    double largest_deviation() const { return std::max(greatest_[0] - mean_[0], mean_[0] - least_[0]); }
    // Notes the moments of box h.
    void note(std::size_t h, BoxLine& line) const {
        const std::size_t m = mean_.size();
        for (std::size_t c = 0; c < m; ++c) {
            line.means[h * m + c] = mean_[c];
            line.variances[h * m + c] = products_[full_ ? c * m + c : c] / (count_ - 1);
        }
    }
    // Adds the box's part of the mean over `boxes` boxes and of its covariance; returns the variance of all
    // components together, each scaled; and starts afresh.
    double finish(double boxes, std::span<const double> inverse_scale, IterationEstimate& to) {
        const std::size_t m = mean_.size();
        const double n = count_, volume = 1 / boxes;
        const double factor = volume * volume / (n * (n - 1));
        double variance = 0;
        for (std::size_t a = 0; a < m; ++a) {
            to.value[a] += volume * mean_[a];
            for (std::size_t b = full_ ? 0 : a; b <= a; ++b) {
                const std::size_t k = full_ ? a * m + b : a;
                to.covariance[k] += factor * products_[k];
                if (a == b) variance += products_[k] * inverse_scale[a] * inverse_scale[a] / (n - 1);
                products_[k] = 0;
            }
            const double deviation = std::max(greatest_[a] - mean_[a], mean_[a] - least_[a]);
            to.largest_variance[a] = std::max(to.largest_variance[a], factor * deviation * deviation);
            mean_[a] = 0;
            least_[a] = infinity;
            greatest_[a] = -infinity;
        }
        count_ = 0;
        return variance;
    }

  private:
    bool full_;
    std::uint32_t count_ = 0;
    std::vector<double> mean_, run_mean_, least_, greatest_, products_;
};

// A jump shows in no variance if all points of its box lie on one side of it. Where the means of two neighbours differ
// far more than on one side of them, and than the values in the one with fewer points n, a jump of that size lies anywhere in
// this box, and none was drawn beyond it: the square of the part that was missed is 2 / ((n + 2)(n + 3)) of the
// square of the jump on average. Adds it to the covariance, and to `variances`, by which points are allotted.
void add_jumps(const BoxLine& line, std::span<const std::uint32_t> counts,
               std::span<const double> inverse_scale, std::span<double> variances, IterationEstimate& to) {
    constexpr double far_more = 9; // squares
    const std::size_t boxes = counts.size(), m = to.value.size();
    const double volume = 1 / static_cast<double>(boxes);
    const std::size_t stride = to.covariance.size() == m ? 1 : m + 1;
    for (std::size_t c = 0; c < m; ++c) {
        const auto square = [&](std::size_t h) {
            const double step = line.means[(h + 1) * m + c] - line.means[h * m + c];
            return step * step;
        };
        for (std::size_t h = 0; h + 1 < boxes && boxes > 2; ++h) {
            const double jump = square(h);
            const bool first = h == 0, last = h + 2 == boxes;
            const double beside = first  ? square(h + 1)
                                  : last ? square(h - 1)
                                         : std::min(square(h - 1), square(h + 1));
            // A slope has steps between means of sqrt(12) standard deviations within.
            const std::size_t fewer = counts[h] < counts[h + 1] ? h : h + 1;
            const double within = 12 * line.variances[fewer * m + c];
            if (!(jump > far_more * std::max(beside, within))) continue;
            const double n = counts[fewer];
            const double missed = volume * volume * jump * 2 / ((n + 2) * (n + 3));
            to.covariance[c * stride] += missed;
            to.largest_variance[c] = std::max(to.largest_variance[c], missed);
            const double spread = jump * inverse_scale[c] * inverse_scale[c] / (n + 2);
            for (std::size_t k : {h, h + 1}) variances[k] = std::max(variances[k], spread);
        }
    }
}

struct IterationSum {
    IterationEstimate estimate;
    MapInsight insight;

    void merge(const IterationSum& later) {
        for (std::size_t c = 0; c < estimate.value.size(); ++c) estimate.value[c] += later.estimate.value[c];
        for (std::size_t k = 0; k < estimate.covariance.size(); ++k)
            estimate.covariance[k] += later.estimate.covariance[k];
        for (std::size_t c = 0; c < estimate.largest_variance.size(); ++c)
            estimate.largest_variance[c] =
                std::max(estimate.largest_variance[c], later.estimate.largest_variance[c]);
        insight.merge(later.insight);
    }
};

// What tasks write, each for its own boxes.
struct BoxOutputs {
    std::span<double> variances;
    BoxLine* line; // null: the boxes lie in several variables
};

// Boxes that one task takes, and the numbers of its points.
struct Task {
    std::size_t begin, end;
    std::uint64_t first_point, end_point;
};

// Points that a device has drawn.
struct DrawnPoints {
    std::uint64_t begin, end;
};

class StratifiedVegas final : public VegasEstimator {
  public:
    StratifiedVegas(const Problem& problem, const Vegas& settings)
        : VegasEstimator(problem, settings, 32), cubes_(problem.evaluator.dimensions()) {}

    StepOutcome step(const StepRequest& request) override {
        if (request.max_evaluations < 2) return StepOutcome::exhausted;
        VegasState next = state_;
        Hypercubes cubes = cubes_;
        std::uint64_t used = 0;
        plan(next, request);
        if (!run_pilot(next, request, used)) return StepOutcome::cancelled;
        const std::uint64_t points = iteration_size(next, request.max_evaluations - used);
        if (points < least_iteration(next)) return StepOutcome::exhausted;
        sharpen(next.map, points);
        cubes.resize(std::clamp<std::uint64_t>(points / points_per_box, 1, most_boxes));
        const std::vector<std::uint32_t> counts = cubes.allocate(points, settings_.beta);
        std::vector<double> variances(counts.size());
        std::optional<BoxLine> line;
        if (problem_.evaluator.dimensions() == 1)
            line.emplace(static_cast<std::size_t>(problem_.evaluator.components()), counts.size());
        const BoxOutputs boxes{variances, line ? &*line : nullptr};
        auto sum = sample(next, cubes, counts, boxes, request.cancel);
        if (!sum) return StepOutcome::cancelled;
        if (line) add_jumps(*line, counts, next.inverse_scale, variances, sum->estimate);
        std::uint64_t taken = 0;
        for (std::uint32_t n : counts) taken += n;
        used += taken;

        next.non_finite.merge(sum->insight.non_finite);
        const double weight = static_cast<double>(taken);
        if (next.trained) {
            const std::uint64_t uniform = uniform_points(points);
            if (!next.check.run(problem_, device_.get(), next.map, sum->insight, weight, uniform,
                                next.stream + 1, next.inverse_scale, next.non_finite, request.cancel))
                return StepOutcome::cancelled;
            used += uniform;
            sum->estimate.points = weight;
            next.average.add(weight, sum->estimate);
            note_iteration(next, sum->insight, weight);
            next.evaluations += used;
        } else {
            next.evaluations += used;
            note_training(next, weight, relative_error(next, sum->estimate, sum->insight));
        }
        next.stream += 2;
        cubes.learn(variances);
        refine(next.map, sum->insight.training, taken);
        if (!next.trained || next.average.iterations() == 0) rescale(next, sum->insight);
        state_ = std::move(next);
        cubes_ = std::move(cubes);
        return StepOutcome::advanced;
    }

  private:
    // Points of the next iteration: half of all that counted before, so that a run can stop at many places
    // and the last iterations have the best map.
    std::uint64_t iteration_size(const VegasState& next, std::uint64_t limit) const {
        if (!next.trained) return std::min(next.training_size, limit);
        const auto counted = static_cast<std::uint64_t>(next.points);
        const auto room =
            static_cast<std::uint64_t>(std::ceil(static_cast<double>(limit) / (1 + settings_.uniform_share)));
        std::uint64_t size = std::max(2 * next.training_size, counted / 2);
        if (size == 0) size = 4096;
        size = std::min(size, std::max(large_step, counted / 10));
        // Avoids a small last iteration.
        if (size + size / 4 > room) size = room;
        while (size > 2 && size + uniform_points(size) > limit) --size;
        return size;
    }

    // A remainder of fewer points is not used: it would hardly change the average, and the error of a few points is
    // known too badly to be compared with the other iterations.
    static std::uint64_t least_iteration(const VegasState& next) {
        const auto counted = static_cast<std::uint64_t>(next.points);
        return std::max(std::min<std::uint64_t>(64, counted / 4), counted / 50);
    }

    std::optional<IterationSum> sample(const VegasState& next, const Hypercubes& cubes,
                                       const std::vector<std::uint32_t>& counts, const BoxOutputs& outputs,
                                       const CancelFlag* cancel) const {
        std::vector<Task> tasks;
        std::uint64_t point = 0;
        for (std::size_t h = 0; h < counts.size(); ++h) {
            if (tasks.empty() || point - tasks.back().first_point >= vegas_task_points)
                tasks.push_back({h, h, point, point});
            tasks.back().end = h + 1;
            tasks.back().end_point = point += counts[h];
        }
        if (!device_) return sample(next, cubes, counts, tasks, {}, point, outputs, cancel);
        upload(next.map, cubes, counts);
        std::optional<IterationSum> all;
        for (std::size_t begin = 0; begin < tasks.size();) {
            const std::uint64_t first = tasks[begin].first_point, size = device_->block_size();
            std::size_t end = begin + 1;
            while (end < tasks.size() && tasks[end].end_point - first <= size) ++end;
            DrawnPoints drawn{first, first};
            // A box may have more points than fit into a block: its task draws them piece by piece.
            if (tasks[end - 1].end_point - first <= size) draw(next, drawn, first, tasks[end - 1].end_point);
            auto sum = sample(next, cubes, counts, std::span(tasks).subspan(begin, end - begin), drawn, point,
                              outputs, cancel);
            if (!sum) return std::nullopt;
            if (all)
                all->merge(*sum);
            else
                all = std::move(sum);
            begin = end;
        }
        return all;
    }

    void upload(const AdaptiveMap& map, const Hypercubes& cubes,
                const std::vector<std::uint32_t>& counts) const {
        use_map(map);
        std::vector<std::uint64_t> begin{0};
        for (const std::uint32_t n : counts) begin.push_back(begin.back() + n);
        device_->sampler().set_boxes(begin, cubes.strata());
    }

    // Points [first, end), or as many of them as fit into a block.
    void draw(const VegasState& next, DrawnPoints& drawn, std::uint64_t first, std::uint64_t end) const {
        drawn = {first, std::min(end, first + device_->block_size())};
        device_->draw_random(problem_.seed, next.stream, first, drawn.end - first, true);
    }

    // A run of tasks, and the points that a device drew for them.
    std::optional<IterationSum> sample(const VegasState& next, const Hypercubes& cubes,
                                       const std::vector<std::uint32_t>& counts, std::span<const Task> tasks,
                                       const DrawnPoints& drawn, std::uint64_t all_points,
                                       const BoxOutputs& outputs, const CancelFlag* cancel) const {
        return parallel_reduce_ordered(
            static_cast<std::int64_t>(tasks.size()),
            [&](std::int64_t t) {
                return run(next, cubes, counts, tasks[static_cast<std::size_t>(t)], drawn, all_points,
                           outputs);
            },
            [](IterationSum a, const IterationSum& b) {
                a.merge(b);
                return a;
            },
            cancel);
    }

    IterationSum run(const VegasState& next, const Hypercubes& cubes,
                     const std::vector<std::uint32_t>& counts, const Task& task, DrawnPoints drawn,
                     std::uint64_t all_points, const BoxOutputs& outputs) const {
        const Evaluator& g = problem_.evaluator;
        const int m = g.components(), dimensions = g.dimensions();
        const double boxes = static_cast<double>(counts.size());
        IterationSum sum{empty(), MapInsight(m)};
        sum.insight.tail = next.tail.empty();
        sum.insight.training = MapTraining(dimensions, next.map.increments());
        BoxMoments moments(m, problem_.full_covariance);
        PointBuffer y;
        MappedPoints points;
        std::vector<double> box(batch_size), share(batch_size), weighted(batch_size);
        std::uint64_t first = task.first_point;
        std::size_t h = task.begin;     // box of the next point
        std::uint32_t left = counts[h]; // of its points
        while (h < task.end) {
            const std::size_t batch_box = h;
            const std::uint32_t batch_left = left;
            std::size_t n = 0;
            while (n < batch_size && h < task.end) {
                const std::uint32_t run =
                    std::min<std::uint32_t>(left, static_cast<std::uint32_t>(batch_size - n));
                std::fill_n(box.begin() + static_cast<std::ptrdiff_t>(n), run, static_cast<double>(h));
                std::fill_n(share.begin() + static_cast<std::ptrdiff_t>(n), run, 1 / (boxes * counts[h]));
                n += run;
                left -= run;
                if (left == 0 && ++h < task.end) left = counts[h];
            }
            const bool training = settings_.alpha > 0 && trains(next.stream, first, all_points);
            const auto fill = [&](PointBuffer& to) {
                fill_random(to, problem_.seed, next.stream, first);
                cubes.place(to, {box.data(), n});
            };
            if (device_ && first + n > drawn.end) draw(next, drawn, first, task.end_point);
            y.resize(n, dimensions);
            if (!device_ || training) fill(y);
            if (device_)
                points.evaluate(g, next.map, *device_, first - drawn.begin, n, fill, next.inverse_scale,
                                sum.insight.non_finite);
            else
                points.evaluate(g, next.map, y, next.inverse_scale, sum.insight.non_finite);
            sum.insight.add(points, {share.data(), n});
            if (training) {
                for (std::size_t i = 0; i < n; ++i) weighted[i] = share[i] * points.squares()[i];
                sum.insight.training.add(y, {share.data(), n}, {weighted.data(), n});
            }
            std::size_t at = 0;
            std::uint32_t rest = batch_left;
            for (std::size_t k = batch_box; at < n; rest = ++k < task.end ? counts[k] : 0) {
                const std::uint32_t run = std::min<std::uint32_t>(rest, static_cast<std::uint32_t>(n - at));
                moments.add(points, at, run);
                at += run;
                if (moments.count() < counts[k]) continue;
                const double relative_weight = static_cast<double>(all_points) / (boxes * counts[k]);
                sum.insight.tail.add(relative_weight * moments.largest_deviation());
                ++sum.insight.tail_values;
                if (outputs.line) moments.note(k, *outputs.line);
                outputs.variances[k] = moments.finish(boxes, next.inverse_scale, sum.estimate);
            }
            first += n;
        }
        return sum;
    }

    IterationEstimate empty() const {
        return IterationEstimate::zero(problem_.evaluator.components(), problem_.full_covariance);
    }

    void save_more(StateWriter& state) const override { cubes_.save(state); }
    void load_more(StateReader& state) override { cubes_.load(state); }

    Hypercubes cubes_;
};

} // namespace

std::unique_ptr<VegasEstimator> stratified_vegas(const Problem& problem, const Vegas& settings) {
    return std::make_unique<StratifiedVegas>(problem, settings);
}

} // namespace montelux
