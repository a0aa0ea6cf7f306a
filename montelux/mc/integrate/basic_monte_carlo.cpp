#include "montelux/mc/integrate/basic_monte_carlo.h"

#include "montelux/mc/integrate/device_values.h"
#include "montelux/mc/integrate/sampling.h"
#include "montelux/mc/integrate/unit_points.h"

namespace montelux {
namespace {

class BasicEstimator final : public Estimator {
  public:
    explicit BasicEstimator(const Problem& problem)
        : problem_(problem),
          device_(DeviceValues::of(problem.evaluator)), sum_{empty_moments(),
                                                             {},
                                                             ExtremeValues(problem.evaluator.components())} {}

    StepOutcome step(const StepRequest& request) override {
        const std::uint64_t done = sum_.moments.count();
        const std::uint64_t size = next_step_size(done, 4096, request.max_evaluations);
        if (size == 0) return StepOutcome::exhausted;
        const Evaluator& g = problem_.evaluator;
        if (device_) device_->summarise_above(sum_.extremes.tail().floor());
        auto sum = sum_blocks(
            size, device_.get(),
            [&](std::uint64_t first, std::uint64_t count) {
                device_->draw_random(problem_.seed, 0, done + first, count);
            },
            [&] {
                return SampleMoments{empty_moments(), {}, sum_.extremes.empty()};
            },
            [&](std::uint64_t first, std::uint64_t count, std::uint64_t number, SampleMoments& to) {
                if (const DeviceSummary* s = device_ ? device_->summary(number) : nullptr)
                    return to.add(*s, count);
                ValueBuffer values(count, g.components());
                const auto fill = [&](PointBuffer& u) { fill_random(u, problem_.seed, 0, done + first); };
                if (device_) {
                    device_->read(number, values, fill, to.non_finite);
                } else {
                    PointBuffer u(count, g.dimensions());
                    fill(u);
                    g(u, values, to.non_finite);
                }
                to.add(values);
            },
            request.cancel);
        if (!sum) return StepOutcome::cancelled;
        sum_.merge(*sum);
        return StepOutcome::advanced;
    }

    Tally tally() const override {
        Tally tally;
        tally_mean(sum_, tally);
        tally.evaluations = sum_.moments.count();
        tally.non_finite = sum_.non_finite;
        return tally;
    }
    void save(StateWriter& state) const override {
        montelux::save(state, sum_.moments);
        montelux::save(state, sum_.non_finite);
        sum_.extremes.save(state);
    }
    void load(StateReader& state) override {
        montelux::load(state, sum_.moments);
        montelux::load(state, sum_.non_finite);
        sum_.extremes.load(state);
    }

  private:
    CovarianceMoments empty_moments() const {
        return CovarianceMoments(problem_.evaluator.components(), problem_.full_covariance);
    }

    Problem problem_;
    std::unique_ptr<DeviceValues> device_; // null: the processor
    SampleMoments sum_;
};

} // namespace

std::unique_ptr<Estimator> BasicMonteCarlo::estimator(const Problem& problem) const {
    return std::make_unique<BasicEstimator>(problem);
}

} // namespace montelux
