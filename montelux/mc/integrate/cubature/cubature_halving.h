// How an adaptive cubature divides its regions: which to halve, and what halving tells of their errors.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "montelux/mc/integrate/cubature/cubature_evaluation.h"
#include "montelux/mc/integrate/cubature/cubature_regions.h"

namespace montelux {

// Errors are as many times larger while there is one region alone.
inline constexpr double caution_of_one_region = 9;

// The regions of the largest errors, each measured by scale[c] for component c (not at all where that is 0):
// at most a sixteenth of all, and of these the ones within a factor of four of the worst, but no fewer than a
// 64th, so that choosing takes little time beside the evaluations. In a search the largest volumes.
std::vector<std::size_t> regions_to_halve(const CubatureRegions& regions, std::span<const double> scale,
                                          bool search);

// Leaves out what does not fit into the step or the evaluations allowed. Two rules for each parent, or,
// without parents, one rule.
void fit_evaluations(std::vector<const SymmetricRule*>& rules, std::vector<std::size_t>& parents,
                     std::uint64_t max_evaluations);

// Corrects the errors of the cube as the only region; `before` is the same evaluated by the cheaper rule, or
// empty.
void correct_cube(const CubatureRegions& before, CubatureRegions& fresh);

// A jump close beyond the face that two halves share is seen by neither, but they disagree about the face. As
// long as halving does not show it, half of that error goes to each half that still has the face.
void add_face_errors(const CubatureWork& work);

} // namespace montelux
