// Adaptive sampling: more samples where the error of a pixel falls most by them.
#pragma once

#include <cstdint>
#include <vector>

#include "montelux/film/film.h"
#include "montelux/render/render_target.h"
#include "montelux/render/sample_order.h"

namespace montelux {

// The samples that each pixel shall have next, none fewer than it has; empty when no pixel may have more.
//
// The mean squared error over pixels of n_p samples and variances v_p is least, for a given sum of n_p, where
// n_p is proportional to sqrt(v_p) (Neyman 1934, "On the Two Different Aspects of the Representative
// Method"). Two things keep the picture unbiased and rare bright paths from being starved:
// - v_p is estimated from the pixels around p, without p itself. A pixel's own samples have then no part in
//   how many it gets, which would end pixels early that happen to look dark and smooth (Kirk, Arvo 1991,
//   "Unbiased Sampling Techniques for Image Synthesis"); through its neighbours they have one in the round
//   after next, too small to be found (docs/render-to-an-error.md).
// - No weight is below a third of the mean weight, so that no pixel gets less than a quarter of the mean
//   number.
// A round at most doubles the samples; with a target it goes as far as the target seems to need.
std::vector<std::uint32_t> allocate(const Film& film, const SampleOrder& order, const RenderTarget& target);

} // namespace montelux
