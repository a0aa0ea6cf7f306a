// Ridges on which diagonals of a first look lie.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "montelux/mc/integrate/witness/ladder_path.h"
#include "montelux/mc/integrate/witness/raw_values.h"

namespace montelux {

// Measures ridges, or surfaces of poles as that of 1/|x - y|, on which diagonals lie that seem to hold far more than all ladders
// in other directions: sets the thickness of these ladders. `points`, `rows` and `volumes` are those of the shells of each ladder
// in turn. Up to seven evaluations for each such diagonal, or none where these are more than `most_evaluations`.
void measure_diagonals(RawValues& raw, std::span<LadderPath> paths,
                       std::span<const std::vector<double>> points, std::span<const std::vector<double>> rows,
                       std::span<const double> volumes, std::uint64_t most_evaluations);

} // namespace montelux
