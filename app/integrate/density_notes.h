// The problem of a trained density, kept as texts in its file: the options of `montelux integrate` that
// define integrand and domain.
#pragma once

#include "app/integrate/integrate_options.h"
#include <map>
#include <string>

namespace montelux::app {

std::map<std::string, std::string> density_notes(const IntegrateOptions& options);

// The options again. Throws Error that names the file where the notes hold no integrand.
IntegrateOptions options_of_notes(const std::map<std::string, std::string>& notes, const std::string& path);

// A sentence where the source or library of the integrand is not the file that it was; else "".
std::string changed_function(const std::map<std::string, std::string>& notes);

} // namespace montelux::app
