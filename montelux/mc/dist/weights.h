// Check of every table of weights.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace montelux {

// Sum of the weights. Throws Error when there are none, or one is negative, infinite or not a number, or
// the sum overflows; the sentence names `where`, the index and the value.
double checked_weight_sum(std::string_view where, std::span<const float> weights);
double checked_weight_sum(std::string_view where, std::span<const double> weights);

} // namespace montelux
