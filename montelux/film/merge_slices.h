// Pictures of slices of one render, joined into the picture of the whole.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "montelux/image/image.h"

namespace montelux {

struct MergedSlices {
    Image image;
    std::vector<int> missing;  // slices, counted from 1, that no picture was of
    double relative_error = 0; // FilmError::relative
    double mean_samples = 0;
};

// Joins what Film::develop() wrote for slices k/n of one render, in any order. Means, standard errors,
// skewness and counts are those of all units together, as far as 32-bit layers tell (relative differences of
// about 1e-7); the layer `outlier` is that of the slice in which the brightest unit stood out most, against
// all. The standard error is infinite where there are fewer than two units. Pictures say what they are of in
// the attributes `renderHash` and `slice`. Throws Error, naming the picture, where one is no slice, is of
// another render, or is of a slice that another one is of. `names` are for messages.
MergedSlices merge_slices(std::span<const Image> slices, std::span<const std::string> names);

} // namespace montelux
