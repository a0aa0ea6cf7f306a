// PrimarySampleStream: the numbers of a sample as a state of a Markov chain in primary sample space.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "montelux/mc/math/vec.h"
#include "montelux/mc/random/philox_stream.h"
#include "montelux/mc/random/stream.h"
#include "montelux/mc/random/uniform_bits.h"

namespace montelux {

// A symmetric step on the unit circle [0, 1): its length has a density in proportion to 1 / length between
// `shortest` and `longest`. Kelemen, Szirmay-Kalos, Antal, Csonka 2002, "A Simple and Robust Mutation Strategy
// for the Metropolis Light Transport Algorithm", section 3.2.
class SmallStep {
  public:
    static constexpr double ratio = 64; // of the longest to the shortest
    // 0 < longest < 1/2.
    explicit SmallStep(double longest) : longest_(longest) {}

    double longest() const { return longest_; }
    double operator()(double x, PhiloxStream& numbers) const {
        const std::uint32_t bits = numbers.next_bits();
        const double length = longest_ * std::exp2(-log2_of_ratio * ((bits >> 1) * 0x1p-31));
        // Below 1, for the sum may round up to it.
        if ((bits & 1) != 0) {
            x += length;
            return x < 1 ? x : x - 1;
        }
        x -= length;
        return x >= 0 ? x : std::fmin(x + 1, largest);
    }

  private:
    static constexpr double log2_of_ratio = 6;
    static constexpr double largest = 1 - 0x1p-53;
    double longest_;
};

// The current state of a chain and the proposed one. The target's density is a function of the numbers that it
// draws through a stream; proposals are symmetric: large ones draw all numbers anew, small ones move each by a
// small step.
//
// Numbers beyond those that the current state drew do not affect its density. Given the others they are uniform,
// so each proposal draws them anew (a step of Gibbs sampling, which leaves the target invariant). Therefore no
// number is remembered that the state does not use.
//
// Keys of nested streams (PhiloxStream::split) change everything that follows when they change at all: small
// steps keep most of them.
class PrimarySamples {
  public:
    explicit PrimarySamples(PhiloxStream numbers) : numbers_(numbers) {}

    // As a new object with these numbers; memory is kept.
    void restart(PhiloxStream numbers) {
        numbers_ = numbers;
        current_.clear();
        proposed_.clear();
    }
    // Goes on with other numbers from the same state.
    void set_numbers(PhiloxStream numbers) { numbers_ = numbers; }

    void propose_large() { propose(true); }
    void propose_small(SmallStep step) {
        step_ = step;
        propose(false);
    }
    // The proposed state becomes the current one.
    void accept() {
        std::swap(current_, proposed_);
        proposed_.clear();
    }
    // For the decisions of the chain.
    PhiloxStream& numbers() { return numbers_; }
    // Numbers that the current state draws.
    std::size_t dimensions() const { return current_.samples.size() + 2 * current_.keys.size(); }

    // Of the proposed state, for the stream.
    double sample(std::size_t i) {
        while (proposed_.samples.size() <= i) {
            const std::size_t k = proposed_.samples.size();
            proposed_.samples.push_back(moves(k, current_.samples.size())
                                            ? step_(current_.samples[k], numbers_)
                                            : numbers_.next_double());
        }
        return proposed_.samples[i];
    }
    Vec2f key(std::size_t i) {
        while (proposed_.keys.size() <= i) {
            const std::size_t k = proposed_.keys.size();
            const bool keeps = moves(k, current_.keys.size()) && numbers_.next_1d() < kept_keys;
            proposed_.keys.push_back(keeps ? current_.keys[k] : numbers_.next_2d());
        }
        return proposed_.keys[i];
    }

  private:
    static constexpr float kept_keys = 15.0f / 16; // share

    struct State {
        std::vector<double> samples;
        std::vector<Vec2f> keys;
        void clear() {
            samples.clear();
            keys.clear();
        }
    };
    void propose(bool large) {
        large_ = large;
        proposed_.clear();
    }
    bool moves(std::size_t i, std::size_t current) const { return !large_ && i < current; }

    PhiloxStream numbers_;
    SmallStep step_{0.25};
    bool large_ = true;
    State current_, proposed_;
};

// Draws the numbers of the proposed state, from the first one on.
class PrimarySampleStream {
  public:
    // The samples must outlive it.
    explicit PrimarySampleStream(PrimarySamples& samples) : samples_(&samples) {}

    float next_1d() { return truncated(samples_->sample(used_++)); }
    Vec2f next_2d() {
        const float x = next_1d();
        const float y = next_1d();
        return {x, y};
    }
    // The numbers of a state have these digits already.
    double refined(float u) {
        const double last = samples_->sample(used_ - 1);
        if (truncated(last) == u || used_ < 2) return last;
        return samples_->sample(used_ - 2); // the first one of a pair
    }
    // The pair that PhiloxStream::split makes a stream of.
    Vec2f next_key() { return samples_->key(keys_++); }

  private:
    static float truncated(double u) {
        return static_cast<float>(static_cast<std::uint32_t>(u * 0x1p24)) * 0x1p-24f;
    }

    PrimarySamples* samples_;
    std::size_t used_ = 0, keys_ = 0;
};

static_assert(RandomStream<PrimarySampleStream>);

} // namespace montelux
