// Sample allocation: the replicates of a render, and how many samples each pixel gets in the next round.
#pragma once

#include <cstdint>
#include <vector>

#include "montelux/film/film.h"
#include "montelux/mc/random/sampler_settings.h"
#include "montelux/render/render_state.h"
#include "montelux/render/render_target.h"
#include "montelux/render/sample_order.h"
#include "montelux/scene/render_settings.h"

namespace montelux {

// Chooses the number if `replicates` is 0 or 1 and the sampler quasi-random. Eight give an error estimate
// with seven degrees of freedom and leave most samples to the point sets: the truth then lies within two
// errors in 91 % of the pixels. From 256 samples on there are sixteen (94 %), and never fewer than slices.
// Below eight samples each is a replicate. A target or a time needs many short replicates, of at most eight
// points each, since the number of samples is not known beforehand. Chains come in 32 groups, never fewer than
// slices; with a target or a time, of at most two samples per pixel each.
SamplerSettings with_replicates(SamplerSettings settings, const RenderTarget& target);

// The same for a resumed render, with its original points per replicate; 0: as chosen above.
SamplerSettings with_points(SamplerSettings settings, std::uint32_t replicate_points);

// Throws Error if the slice does not exist or would take no samples.
void check_slice(const SamplerSettings& sampler, const RenderTarget& target);

// Samples per pixel of the pilot of an adaptive render, from which its first errors are computed.
std::uint64_t pilot_of(const SampleOrder& order);

// The target sample counts of the next round, one per pixel, when all pixels have reached those of the last
// (`state.target_samples`, empty at first); empty when all samples are taken. A function of its arguments
// only.
//
// Without adaptive allocation all pixels get the same: rounds are short at first, so that a first snapshot
// comes early, and never long. Adaptively: a pilot of equal counts, then rounds of whole replicates
// (neyman_allocation). The pilot is one round; with a time limit it consists of several short ones, between
// which it can end. Where a quantile of the errors meets its target before all pixels have the samples that make it
// credible (samples_to_trust), a round gives these to the pixels that lack them.
std::vector<std::uint32_t> next_target_samples(const RenderState& state, const SamplerSettings& sampler,
                                               const RenderTarget& target);

// Of a render that several processes share, whose ends of rounds are expensive: lets the next round go further, once every
// pixel has a sample. If no decision depends on the error it takes all remaining samples, and so does that of a pilot.
// With splats it ends with the pass.
void join_rounds(RenderState& state, const SampleOrder& order, const RenderTarget& target);

// The adaptive part of the above: no count decreases; empty if no pixel may get more.
//
// The mean squared error over pixels of n_p samples and variances v_p is least, for a given sum of n_p, where
// n_p is proportional to sqrt(v_p) (Neyman 1934, "On the Two Different Aspects of the Representative
// Method"). Two things keep the picture unbiased and rare bright paths from being starved:
// - v_p is estimated from the pixels around p, without p itself. A pixel's own samples thus do not decide how
//   many it gets, which would end pixels early that happen to look dark and smooth (Kirk, Arvo 1991,
//   "Unbiased Sampling Techniques for Image Synthesis"); through its neighbours they do in the round after
//   next, too little to be measured (docs/render-to-an-error.md).
// - No weight is below a third of the mean weight, so that no pixel gets less than a quarter of the mean
//   number.
// A round at most doubles the samples; with a target it goes as far as the target seems to need.
std::vector<std::uint32_t> neyman_allocation(const Film& film, const SampleOrder& order,
                                             const RenderTarget& target);

} // namespace montelux
