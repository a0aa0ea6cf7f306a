// Base of both forms of Vegas: pilot, plan of the training, checks, saved state.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "montelux/mc/integrate/device_values.h"
#include "montelux/mc/integrate/iteration_average.h"
#include "montelux/mc/integrate/vegas/mapped_points.h"
#include "montelux/mc/integrate/vegas/uniform_check.h"
#include "montelux/mc/integrate/vegas/vegas.h"

namespace montelux {

// Points of a batch that one task takes.
inline constexpr std::uint64_t vegas_task_points = 1 << 14;

// State of both forms.
struct VegasState {
    AdaptiveMap map;
    IterationAverage average;
    UniformCheck check;
    std::vector<double> inverse_scale = {}; // of the components; empty before the pilot
    NonFiniteCount non_finite = {};
    std::uint64_t evaluations = 0;
    std::uint32_t stream = 0; // next stream of random numbers
    // Training.
    bool planned = false, trained = false;
    std::uint64_t training_size = 0;  // of the next iteration that trains
    std::uint64_t training_limit = 0; // evaluations after which training ends
    int training_done = 0;            // iterations
    double last_spread = 0;           // squared, of the values relative to their size, in the last iteration
    // Over the iterations that count, for the share of the largest value in the sum of squares.
    double points = 0, sum_of_squares = 0, largest_square = 0;
    ParetoTail tail = {};
    std::uint64_t tail_values = 0;

    void save(StateWriter& state) const;
    void load(StateReader& state);
};

class VegasEstimator : public Estimator {
  public:
    const AdaptiveMap& map() const { return state_.map; }

    Tally tally() const override;
    void save(StateWriter& state) const override;
    void load(StateReader& state) override;
    std::shared_ptr<const UnitDensity> density() const override;

  protected:
    VegasEstimator(const Problem& problem, const Vegas& settings, int least_evaluations);

    // Values of components are compared after division by their root mean squares; a scalar needs none.
    // The pilot of a vector finds them at uniform points. False when cancelled.
    bool run_pilot(VegasState& next, const StepRequest& request, std::uint64_t& used) const;
    // Plans the training from the evaluations of the first step.
    void plan(VegasState& next, const StepRequest& request) const;
    // More increments where points are many.
    void sharpen(AdaptiveMap& map, std::uint64_t points) const;
    // Adapts the map to this many points; too few for the number of variables change nothing.
    void refine(AdaptiveMap& map, const MapTraining& training, std::uint64_t points) const;
    // Uniform check points for this many points of the map.
    std::uint64_t uniform_points(std::uint64_t points) const;
    // Records an iteration of `points` points: whether the training is over, and whether a few points
    // dominate.
    void note_training(VegasState& next, double points, double relative_error) const;
    void note_iteration(VegasState& next, const MapInsight& insight, double points) const;
    static void rescale(VegasState& next, const MapInsight& insight);
    // Which batches train the map, when there are more points than it needs.
    static bool trains(std::uint64_t stream, std::uint64_t batch, std::uint64_t points);
    // Root of the sum of squared errors of an iteration, components scaled, over the mean size.
    double relative_error(const VegasState& state, const IterationEstimate& iteration,
                          const MapInsight& insight) const;
    // The average at this moment.
    virtual IterationAverage average() const { return state_.average; }
    virtual void save_more(StateWriter&) const {}
    virtual void load_more(StateReader&) {}

    // Gives the map to the device's points.
    void use_map(const AdaptiveMap& map) const;

    Problem problem_;
    std::unique_ptr<DeviceValues> device_; // null: the processor
    Vegas settings_;
    VegasState state_;

  private:
    int least_;
};

std::unique_ptr<VegasEstimator> stratified_vegas(const Problem& problem, const Vegas& settings);
std::unique_ptr<VegasEstimator> sobol_vegas(const Problem& problem, const Vegas& settings);

} // namespace montelux
