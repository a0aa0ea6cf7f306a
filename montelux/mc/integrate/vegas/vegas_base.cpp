#include "montelux/mc/integrate/vegas/vegas_base.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>

#include "montelux/mc/integrate/device_values.h"
#include "montelux/mc/integrate/extreme_values.h"
#include "montelux/mc/integrate/trained/unit_density.h"
#include "montelux/mc/integrate/unit_points.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/random/hash.h"

namespace montelux {
namespace {

constexpr std::uint64_t pilot_points = 1024;
constexpr std::uint64_t least_points_per_variable = 128;
// Maximum points of an iteration used for training; more are only slower.
constexpr std::uint64_t training_points = 1 << 17;
// Share of the sum of squares above which one point dominates the sum.
constexpr double concentrated = 0.1;
constexpr double few_points = 1000;

void check(bool good, const char* what) {
    if (!good) throw Error("Vegas", what);
}

std::uint64_t default_training(int dimensions) {
    return 512 + 192 * static_cast<std::uint64_t>(std::min(dimensions, 64));
}

} // namespace

void VegasState::save(StateWriter& state) const {
    map.save(state);
    average.save(state);
    check.save(state);
    state.put(inverse_scale);
    montelux::save(state, non_finite);
    state.put(evaluations);
    state.put(stream);
    state.put(planned);
    state.put(trained);
    state.put(training_size);
    state.put(training_limit);
    state.put(training_done);
    for (double x : {last_spread, points, sum_of_squares, largest_square}) state.put(x);
    state.put(tail.values());
    state.put(tail_values);
}

void VegasState::load(StateReader& state) {
    AdaptiveMap loaded = AdaptiveMap::load(state);
    if (loaded.dimensions() != map.dimensions())
        throw Error("the saved state has another number of dimensions");
    map = std::move(loaded);
    average.load(state);
    check.load(state);
    inverse_scale = state.get_doubles();
    montelux::load(state, non_finite);
    evaluations = state.get_word();
    stream = state.get<std::uint32_t>();
    planned = state.get<std::uint64_t>() != 0;
    trained = state.get<std::uint64_t>() != 0;
    training_size = state.get_word();
    training_limit = state.get_word();
    training_done = state.get<int>();
    for (double* x : {&last_spread, &points, &sum_of_squares, &largest_square}) *x = state.get_double();
    tail.restore(state.get_doubles());
    tail_values = state.get_word();
}

VegasEstimator::VegasEstimator(const Problem& problem, const Vegas& settings, int least_evaluations)
    : problem_(problem), device_(DeviceValues::of(problem.evaluator)),
      settings_(settings), state_{.map = settings.map ? *settings.map
                                                      : AdaptiveMap(problem.evaluator.dimensions(), 16),
                                  .average = IterationAverage(problem.evaluator.components(),
                                                              problem.full_covariance),
                                  .check = UniformCheck(problem.evaluator.components())},
      least_(least_evaluations) {
    check(settings.alpha >= 0 && settings.alpha <= 4, "expected alpha in [0, 4]");
    check(settings.beta >= 0 && settings.beta <= 1, "expected beta in [0, 1]");
    check(settings.training_iterations >= 0 && settings.training_iterations <= 1000,
          "expected between 0 and 1000 training iterations");
    check(settings.increments >= 1 && settings.increments <= AdaptiveMap::max_increments,
          "expected between 1 and 16384 increments");
    check(settings.uniform_share >= 0 && settings.uniform_share <= 1, "expected a uniform share in [0, 1]");
    check(settings.replicates >= 2 && settings.replicates <= 1024, "expected between 2 and 1024 replicates");
    if (state_.map.dimensions() != problem.evaluator.dimensions())
        throw Error("Vegas", "the map that was given has " + std::to_string(state_.map.dimensions()) +
                                 " dimensions; the integrand takes " +
                                 std::to_string(problem.evaluator.dimensions()));
    if (problem.evaluator.components() == 1) state_.inverse_scale = {1};
}

void VegasEstimator::use_map(const AdaptiveMap& map) const {
    if (!device_) return;
    std::vector<double> edges;
    for (int d = 0; d < map.dimensions(); ++d)
        edges.insert(edges.end(), map.edges(d).begin(), map.edges(d).end());
    device_->sampler().set_map(edges, map.increments());
}

bool VegasEstimator::run_pilot(VegasState& next, const StepRequest& request, std::uint64_t& used) const {
    if (!next.inverse_scale.empty()) return true;
    const Evaluator& g = problem_.evaluator;
    const std::uint64_t n = std::min(pilot_points, request.max_evaluations / 4);
    next.inverse_scale.assign(static_cast<std::size_t>(g.components()), 1);
    MapInsight insight(g.components());
    if (n > 0) {
        if (request.cancel && request.cancel->requested()) return false;
        PointBuffer y(n, g.dimensions());
        fill_random(y, problem_.seed, next.stream++, 0);
        MappedPoints points;
        points.evaluate(g, next.map, y, next.inverse_scale, next.non_finite);
        insight.add(points, std::vector<double>(n, 1 / static_cast<double>(n)));
        used += n;
    }
    rescale(next, insight);
    return true;
}

void VegasEstimator::rescale(VegasState& next, const MapInsight& insight) {
    if (insight.square.size() == 1) return;
    for (std::size_t c = 0; c < insight.square.size(); ++c)
        if (insight.square[c] > 0) next.inverse_scale[c] = 1 / std::sqrt(insight.square[c]);
}

void VegasEstimator::plan(VegasState& next, const StepRequest& request) const {
    if (next.planned) return;
    next.planned = true;
    const std::uint64_t budget = request.max_evaluations;
    const auto iterations = static_cast<std::uint64_t>(settings_.training_iterations);
    next.training_limit = std::min(budget / 4, std::uint64_t{1} << 22);
    // With fewer points, maps of so many variables would follow noise.
    const std::uint64_t needed =
        std::max(static_cast<std::uint64_t>(least_),
                 least_points_per_variable * static_cast<std::uint64_t>(problem_.evaluator.dimensions()));
    if (iterations == 0 || next.training_limit / iterations < needed) {
        next.trained = true;
        return;
    }
    std::uint64_t size = settings_.training_evaluations;
    if (size == 0) {
        size = default_training(problem_.evaluator.dimensions());
        // Without a target error, training takes a twentieth of the evaluations.
        if (!request.targeted())
            size = std::max(size, std::min<std::uint64_t>(budget / (20 * iterations), 1 << 15));
    }
    next.training_size = std::max(needed, std::min(size, next.training_limit / iterations));
}

void VegasEstimator::sharpen(AdaptiveMap& map, std::uint64_t points) const {
    if (settings_.map) return;
    const std::uint64_t most =
        std::max<std::uint64_t>(16, 65536 / static_cast<std::uint64_t>(map.dimensions()));
    const std::uint64_t wanted =
        std::min({std::bit_floor(std::max<std::uint64_t>(16, points / 8)), std::bit_floor(most),
                  static_cast<std::uint64_t>(settings_.increments)});
    if (static_cast<int>(wanted) > map.increments()) map = map.resampled(static_cast<int>(wanted));
}

void VegasEstimator::refine(AdaptiveMap& map, const MapTraining& training, std::uint64_t points) const {
    if (points >= least_points_per_variable * static_cast<std::uint64_t>(map.dimensions()))
        map.refine(training, settings_.alpha);
}

std::uint64_t VegasEstimator::uniform_points(std::uint64_t points) const {
    return static_cast<std::uint64_t>(settings_.uniform_share * static_cast<double>(points));
}

bool VegasEstimator::trains(std::uint64_t stream, std::uint64_t batch, std::uint64_t points) {
    // By a hash, since regular gaps would line up with strata.
    return points <= training_points ||
           static_cast<double>(hash_key(stream, batch) >> 11) * 0x1p-53 * static_cast<double>(points) <
               static_cast<double>(training_points);
}

double VegasEstimator::relative_error(const VegasState& state, const IterationEstimate& iteration,
                                      const MapInsight& insight) const {
    const std::size_t m = iteration.value.size();
    double square = 0;
    for (std::size_t c = 0; c < m; ++c)
        square += iteration.covariance[problem_.full_covariance ? c * m + c : c] * state.inverse_scale[c] *
                  state.inverse_scale[c];
    return insight.size > 0 ? std::sqrt(square) / insight.size : 0;
}

void VegasEstimator::note_training(VegasState& next, double points, double error) const {
    constexpr double vague = 0.2;
    const double spread = error * error * points;
    ++next.training_done;
    if (next.training_done >= settings_.training_iterations) {
        // Error still uncertain, or large and falling: training is better than counting.
        const bool falling = spread > 1 && spread < 0.75 * next.last_spread;
        next.trained = !(error > vague || falling);
        next.training_size += next.training_size / 2;
        if (next.evaluations + next.training_size > next.training_limit) next.trained = true;
    }
    next.last_spread = spread;
}

void VegasEstimator::note_iteration(VegasState& next, const MapInsight& insight, double points) const {
    double squares = 0;
    for (std::size_t c = 0; c < insight.square.size(); ++c)
        squares += insight.square[c] * next.inverse_scale[c] * next.inverse_scale[c];
    next.points += points;
    next.sum_of_squares += points * squares;
    next.largest_square = std::max(next.largest_square, insight.largest_square);
    next.tail.merge(insight.tail);
    next.tail_values += insight.tail_values;
}

Tally VegasEstimator::tally() const {
    Tally tally;
    average().tally(tally);
    tally.evaluations = state_.evaluations;
    tally.non_finite = state_.non_finite;
    if (!tally.ready) return tally;
    state_.check.warn(tally.value, tally.standard_error, state_.inverse_scale, tally.warnings);
    if (state_.points >= few_points && state_.largest_square > concentrated * state_.sum_of_squares) {
        char text[160];
        std::snprintf(text, sizeof text,
                      "one of %.0f points has %.0f %% of the sum of squares; the error may be too small",
                      state_.points, 100 * std::min(1.0, state_.largest_square / state_.sum_of_squares));
        tally.warnings.emplace_back(text);
    }
    warn_of_heavy_tail(state_.tail, state_.tail_values, state_.points, tally.standard_error[0],
                       tally.warnings);
    return tally;
}

std::shared_ptr<const UnitDensity> VegasEstimator::density() const {
    return std::make_shared<const UnitDensity>(state_.map);
}

void VegasEstimator::save(StateWriter& state) const {
    state_.save(state);
    save_more(state);
}

void VegasEstimator::load(StateReader& state) {
    state_.load(state);
    load_more(state);
}

} // namespace montelux
