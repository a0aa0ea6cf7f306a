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

// Common roots of linear forms, such as 2*x-1, x+y<0.5 or 3+y, come first: of those of one bracket, as in
// (x-1)^2+(y-2)^2, as many as there can be; then of those that are left there; of all forms; and of each alone, closest to
// the origin. Forms of several variables without a constant give their gradient, the direction in which they are greatest.
// Each number follows, with either sign in all variables: as written, by name, as a product or quotient such as pi/4;
// exponents are left out. Each point stands once, without the origin.
// `value_of`: of a formula without variables, such as pi or sqrt(2); NaN where it has none.
std::vector<std::vector<double>> formula_landmarks(const std::vector<std::string>& texts,
                                                   const std::vector<std::string>& variables,
                                                   const std::function<double(std::string_view)>& value_of);

// Texts of what stands in brackets, or on both sides of a comparison as their difference, where a variable is in it:
// functions that are zero where formulas may have features. The longest ones, which hold the others, first.
std::vector<std::string> formula_guides(const std::vector<std::string>& texts,
                                        const std::vector<std::string>& variables);

} // namespace montelux::app
