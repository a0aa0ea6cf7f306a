// The rounds of a render: how many samples each pixel shall have next.
#pragma once

#include <cstdint>
#include <vector>

#include "montelux/film/film.h"
#include "montelux/mc/random/sampler_settings.h"
#include "montelux/render/render_state.h"
#include "montelux/render/render_target.h"
#include "montelux/scene/render_settings.h"

namespace montelux {

// With `replicates` 0 or 1 and a quasi-random sampler: the number that suits. Eight give an error estimate
// with seven degrees of freedom and leave most samples to the point sets: the truth then lies within two
// errors in 91 % of the pixels. From 256 samples on there are sixteen (94 %), and never fewer than slices.
// With fewer than eight samples each stands alone. A target or a time needs many short replicates, of at most
// eight points each, since nobody knows how many samples it takes.
SamplerSettings with_replicates(SamplerSettings settings, const RenderTarget& target);

// Throws Error, a sentence, where a slice is none or would take no samples.
void check_slice(const SceneDescription& description, const RenderTarget& target);

// Samples a pixel of the pilot of an adaptive render, which its first errors are made of.
std::uint64_t pilot_of(const SampleOrder& order);

// The goals of the next round, one a pixel, after one whose goals (`state.goals`, empty at first) all pixels
// have reached; empty when all samples are taken. A function of its arguments alone.
//
// The same for all pixels without adaptive allocation: rounds are short at first, so that a first look comes
// early, and never long. Adaptively: a pilot of equal numbers, then rounds of whole units (allocation.h). The
// pilot is one round; with a limit of time it is made of several short ones, between which it can end.
std::vector<std::uint32_t> next_goals(const RenderState& state, const SamplerSettings& sampler,
                                      const RenderTarget& target);

} // namespace montelux
