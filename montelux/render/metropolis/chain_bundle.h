// ChainBundle: Markov chains in primary sample space that walk in step, so that their paths are traced together.
#pragma once

#include <span>
#include <vector>

#include "montelux/mc/integrate/metropolis/acceptance.h"
#include "montelux/mc/random/primary_sample_stream.h"
#include "montelux/render/metropolis/primary_sampler.h"

namespace montelux {

// One mutation of a chain.
struct Mutation {
    bool large = false;
    double acceptance = 0; // its probability
    bool accepted = false;
    // The states before, unless the chain has none, and proposed.
    const PrimarySample* current = nullptr;
    const PrimarySample* proposed = nullptr;
};

class ChainBundle {
  public:
    // Both must outlive it.
    ChainBundle(const PrimarySampler& sampler, const FilmImportance& importance)
        : sampler_(&sampler), importance_(&importance) {}

    // Chains without a state: of small steps nothing comes, and large ones are not accepted.
    void begin_dark(std::span<const PhiloxStream> walks) {
        resize(walks.size());
        for (std::size_t i = 0; i < walks.size(); ++i) samples_[i].restart(walks[i]);
        dark_ = true;
    }
    // Chains from the states whose numbers these streams draw.
    void begin(RayTracer& tracer, std::span<const PhiloxStream> starts, std::span<const PhiloxStream> walks) {
        resize(starts.size());
        states_.clear();
        for (std::size_t i = 0; i < starts.size(); ++i) {
            samples_[i].restart(starts[i]);
            samples_[i].propose_large();
            states_.push_back(&samples_[i]);
        }
        sampler_->evaluate(tracer, states_, *importance_, memory_, current_);
        for (std::size_t i = 0; i < starts.size(); ++i) {
            samples_[i].accept();
            samples_[i].set_numbers(walks[i]);
        }
        dark_ = false;
    }
    const PrimarySample& current(std::size_t chain) const { return current_[chain]; }
    std::size_t size() const { return samples_.size(); }

    // A step of each chain; visit(chain, mutation) before the chain moves.
    template <typename Visit>
    void step(RayTracer& tracer, double large_step_probability, SmallStep small_step, const Visit& visit) {
        states_.clear();
        chains_.clear();
        large_.clear();
        for (std::size_t i = 0; i < samples_.size(); ++i) {
            const bool large = samples_[i].numbers().next_double() < large_step_probability;
            if (dark_ && !large) continue;
            if (large)
                samples_[i].propose_large();
            else
                samples_[i].propose_small(small_step);
            states_.push_back(&samples_[i]);
            chains_.push_back(i);
            large_.push_back(large);
        }
        if (states_.empty()) return;
        const std::span<PrimarySample> proposed = std::span(proposed_).first(states_.size());
        sampler_->evaluate(tracer, states_, *importance_, memory_, proposed);
        for (std::size_t k = 0; k < chains_.size(); ++k) {
            const std::size_t i = chains_[k];
            Mutation m{.large = large_[k] != 0, .proposed = &proposed[k]};
            if (!dark_) {
                m.current = &current_[i];
                m.acceptance = acceptance_of_densities(current_[i].size, proposed[k].size);
                const double u = samples_[i].numbers().next_double();
                m.accepted = u < m.acceptance;
            }
            visit(i, std::as_const(m));
            if (!m.accepted) continue;
            samples_[i].accept();
            current_[i] = proposed[k];
        }
    }

  private:
    void resize(std::size_t chains) {
        samples_.resize(chains, PrimarySamples(PhiloxStream(0)));
        current_.resize(chains);
        proposed_.resize(chains);
    }

    const PrimarySampler* sampler_;
    const FilmImportance* importance_;
    bool dark_ = false;
    std::vector<PrimarySamples> samples_;
    std::vector<PrimarySample> current_, proposed_;
    // Of a step.
    std::vector<PrimarySamples*> states_;
    std::vector<std::size_t> chains_;
    std::vector<char> large_;
    PrimarySampler::Memory memory_;
};

} // namespace montelux
