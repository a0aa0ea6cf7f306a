// "Did you mean ...?": the valid name that is nearest to a misspelt one.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace montelux {

// The candidate with the fewest single-letter edits (insert, delete, replace, swap neighbours; case is free)
// from `name`; empty when none is near (more edits than a third of the letters, at least 2). Names that
// earlier versions and other programs have for settings come first: "seconds" and "--seconds" are near to
// "time".
std::string_view nearest_name(std::string_view name, std::span<const std::string_view> candidates);

// " (did you mean 'x'?)" or an empty string.
std::string did_you_mean(std::string_view name, std::span<const std::string_view> candidates);

} // namespace montelux
