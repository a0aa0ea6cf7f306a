// Evidence of a run: what it saw before its first step, the largest values since, and what they say of its result.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "montelux/mc/integrate/estimator.h"
#include "montelux/mc/integrate/witness/first_look.h"
#include "montelux/mc/integrate/witness/largest_values.h"

namespace montelux {

class Evidence {
  public:
    // Watches the values of the evaluator, which outlives it.
    Evidence(Evaluator& evaluator, std::uint64_t seed);
    ~Evidence();
    Evidence(const Evidence&) = delete;
    Evidence& operator=(const Evidence&) = delete;

    // Takes the first look by the landmarks and guides of f, with at most so many evaluations; forgets an earlier one,
    // whose evaluations still count.
    void look(const Integrand& f, std::uint64_t most_evaluations);
    // Estimates what rounding loses of the integral, if f has a rounding function. `evaluations` are those that the run
    // has time for; it takes at most a tenth of them.
    void weigh_rounding(const Integrand& f, double evaluations);
    // Follows a change of the values' unit, by powers of two with these exponents, one per component. Largest values are
    // forgotten: an estimator that starts again meets them again.
    void rescale(std::span<const double> exponents);
    // With the peaks that were examined since.
    const FirstLook& seen() const { return look_; }
    std::uint64_t evaluations() const { return evaluations_; }
    // Do values of a component have both signs, so that its integral may be zero?
    bool cancels(std::size_t component) const { return largest_.cancels(component); }

    // Searches around the largest values of a run for poles, and measures their peaks, if these values are new and far
    // above their mean. At most `most_evaluations`.
    void examine(const Tally& tally, std::uint64_t most_evaluations);
    // Where the integral does not exist, or converges too slowly to tell; empty if it seems to exist.
    const std::string& divergence() const { return divergence_; }
    // Raises errors to what points of `density` (null: uniform points) are expected to miss of known peaks, and by what
    // doubles do not resolve at poles or lose by rounding; warns of what exceeds the target.
    void judge(const UnitDensity* density, const StepRequest& request, Tally& tally) const;

    void save(StateWriter& state) const;
    void load(StateReader& state);

  private:
    // Result of the examination of a component's largest value.
    struct Examined {
        std::vector<double> u; // empty before the first examination
        double size = 0, unresolved = 0;
    };
    void note_slow(const SlowShells& slow);

    Evaluator& evaluator_;
    std::uint64_t seed_;
    LargestValues largest_;
    FirstLook look_;
    std::vector<Examined> examined_; // one per component
    std::vector<double> imprecise_;  // mass of each component, or none
    std::string divergence_;
    std::uint64_t evaluations_ = 0;
};

} // namespace montelux
