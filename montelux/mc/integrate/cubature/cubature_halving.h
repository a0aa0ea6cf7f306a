// How an adaptive cubature divides its regions: which to halve, and the errors that halving reveals.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "montelux/mc/integrate/cubature/cubature_evaluation.h"
#include "montelux/mc/integrate/cubature/cubature_regions.h"

namespace montelux {

// Factor on errors while there is a single region.
inline constexpr double caution_of_one_region = 9;

// The regions of the largest errors, each measured by scale[c] for component c (not at all where that is 0):
// at most a sixteenth of all, and of these the ones within a factor of four of the worst, but at least a
// 64th, so that choosing is cheap compared with the evaluations. In a search: the largest volumes.
std::vector<std::size_t> regions_to_halve(const CubatureRegions& regions, std::span<const double> scale,
                                          bool search);

// Drops regions that exceed the step or the allowed evaluations. Two rules for each parent, or, without
// parents, one rule.
void fit_evaluations(std::vector<const SymmetricRule*>& rules, std::vector<std::size_t>& parents,
                     std::uint64_t max_evaluations);

// Corrects the errors of the cube as the only region; `before` is the same evaluated by the cheaper rule, or
// empty.
void correct_cube(const CubatureRegions& before, CubatureRegions& fresh);

// Neither half sees a jump close to their shared face, but they disagree about the face. Until halving
// resolves it, half of that error goes to each half that still has the face.
void add_face_errors(const CubatureWork& work);

} // namespace montelux
