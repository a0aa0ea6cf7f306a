// Points near which formulas may have peaks, poles and jumps: the numbers that stand in them.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace montelux::app {

// Length of the name at the beginning of a text: a letter or '_', then digits too; 0 where there is none.
std::size_t name_length(std::string_view text);

// Roots of what is linear in one variable, such as 2*x-1, x<0.5 or 3+y, come first: the first of each variable form a
// point, then the second, and so on (0 for a variable that has fewer). Each number follows, with either sign in all
// variables: as written, by name, as a product or quotient such as pi/4; exponents are left out. Each point stands once.
// `value_of`: of a formula without variables, such as pi or sqrt(2); NaN where it has none.
std::vector<std::vector<double>> formula_landmarks(const std::vector<std::string>& texts,
                                                   const std::vector<std::string>& variables,
                                                   const std::function<double(std::string_view)>& value_of);

} // namespace montelux::app
