// Draws of a trained density with what they are worth for a target: w = f(x) / p(x), block by block.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "montelux/mc/integrate/evaluator.h"
#include "montelux/mc/integrate/integrand_scale.h"
#include "montelux/mc/integrate/trained/trained_density.h"
#include "montelux/mc/parallel/cancel_flag.h"

namespace montelux {

struct SamplingOptions {
    std::uint64_t seed = 0;
    // 0: one per processor. The result does not depend on it.
    int threads = 0;
    // What the target's function returns: f, or log f of a positive f.
    IntegrandForm form = IntegrandForm::value;
    NonFinitePolicy non_finite = NonFinitePolicy::skip;
    // Draws after which the sampling ends with fewer samples; 0: no limit.
    std::uint64_t max_draws = 0;
    // Called between blocks with the share of the samples that exist, from the calling thread.
    std::function<void(double)> progress = {};
    const CancelFlag* cancel = nullptr;
};

// Consecutive draws. Those outside of the domain have no entry: their weight is zero.
struct TargetDraws {
    PointBuffer x;
    ValueBuffer f;                  // in the unit of the scale
    std::vector<double> weight;     // f_0(x) / p(x), in that unit
    std::vector<double> choice;     // a further uniform number of each
    std::vector<std::size_t> index; // of each within the block
    NonFiniteCount non_finite;
};

// The target f with the density to draw from. Values are kept within the range of doubles by a running scale.
class Target {
  public:
    static constexpr std::uint64_t block = 4096; // draws

    // Which of the independent sequences of draws.
    enum class Stream : std::uint32_t { samples, pilot, scale };

    // Throws Error where they do not fit together. The density outlives the target.
    Target(const TrainedDensity& density, const Integrand& f, const SamplingOptions& options);

    int components() const { return evaluator_.components(); }
    // Numbers that a block keeps.
    std::uint64_t block_numbers() const;
    // Draws [first, first + count) of a sequence: each a function of seed, stream and index alone.
    void draw(Stream stream, std::uint64_t first, std::uint64_t count, TargetDraws& draws) const;

    // Finds the scale of log f from a few draws; returns their number.
    std::uint64_t find_scale();
    // True: values left the range of the scale, which has moved; all draws so far are void.
    bool rescaled() { return scale_.adjust(); }
    // Of weights: f = value * 2^exponent for values; log f = log(value) + log_reference for logarithms.
    double unscaled(double x, int component = 0) const;
    double unscaled_product(double x, int a, int b) const;
    double log_reference() const;

  private:
    const TrainedDensity& density_;
    IntegrandScale scale_;
    Evaluator evaluator_;
    std::uint64_t key_;
};

// Draws blocks 0, 1, ... on all threads, as many at a time as are likely to be needed, and gives them to
// `take` in order, until that returns false, the draws reach `max_draws`, or the run is cancelled (then
// false). `expected(draws)` is the number of draws likely to be needed after so many.
bool draw_blocks(const Target& target, Target::Stream stream, const SamplingOptions& options,
                 const std::function<std::uint64_t(std::uint64_t)>& expected,
                 const std::function<bool(TargetDraws&, std::uint64_t first, std::uint64_t count)>& take);

} // namespace montelux
