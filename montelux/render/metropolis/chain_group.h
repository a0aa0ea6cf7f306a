// ChainGroup: one replicate of a Metropolis picture: starting points, chains from them, and their splats.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "montelux/film/splat_film.h"
#include "montelux/render/bad_sample_report.h"
#include "montelux/render/metropolis/chain_plan.h"
#include "montelux/render/metropolis/chain_statistics.h"
#include "montelux/transport/ray_tracer.h"

namespace montelux {

class ChainBundle;
struct Mutation;

// Sees a step of a chain before the chain moves: the number of the chain in its task, and the mutation.
using StepObserver = std::function<void(std::size_t chain, const Mutation& mutation)>;

// Its picture is an unbiased estimate of the image, a pure function of (scene, plan, seed, group). Tasks of one kind run
// in any order and on any threads; first all of take_starting_points, then choose_starts, then all of walk.
class ChainGroup {
  public:
    // All arguments must outlive it.
    ChainGroup(const PrimarySampler& sampler, const ChainPlan& plan, const ChainKeys& keys,
               const PixelBounds& bounds);
    // Of this number, from the beginning.
    void begin(std::uint64_t number);

    std::size_t starting_tasks() const { return starting_sums_.size(); }
    void take_starting_points(std::size_t task, RayTracer& tracer);
    void choose_starts();
    std::size_t walking_tasks() const { return static_cast<std::size_t>(plan_->size.bundles); }
    // Returns early, and leaves the group useless, when stop(), called now and then, returns true.
    // `observer`, unless empty, sees each step.
    void walk(std::size_t task, RayTracer& tracer, const std::function<bool()>& stop,
              const StepObserver& observer = {});

    // After all tasks.
    Vec3d mean(int x, int y) const { return splats_.sum(x, y) * picture_scale_; }
    struct Tally {
        ChainStatistics statistics;
        BadSampleReport bad;
        double clamped = 0; // mean over pixels of the luminance that the film's limit removed
        std::uint64_t clamped_samples = 0;
    };
    Tally tally() const;

  private:
    // Of one task.
    struct Part {
        BadSampleReport bad;
        double clamped = 0; // sum of weights times luminance
        std::uint64_t clamped_samples = 0;
        std::uint64_t large_steps = 0, small_steps = 0;
        double large_accepted = 0, small_accepted = 0;
        ChannelMoments<3> halves[2];
    };
    void splat(const PrimarySample& sample, double weight, Part& part);
    void count(const PrimarySample& sample, std::uint64_t path, Part& part) const;
    std::array<double, 3> observables(const PrimarySample& sample) const;

    const PrimarySampler* sampler_;
    const ChainPlan* plan_;
    const ChainKeys* keys_;
    ChainWeights weights_;
    SplatFilm splats_;
    double splat_scale_, picture_scale_, pixels_;
    std::uint64_t number_ = 0;
    std::vector<double> sizes_; // of the starting points
    std::vector<double> starting_sums_;
    std::vector<Part> parts_;           // of the tasks, starting ones first
    std::vector<std::uint64_t> starts_; // of the chains, among the starting points; empty: all are dark
    double correction_ = 0;             // b' / c
};

} // namespace montelux
