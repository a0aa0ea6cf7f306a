// How a value and its error came down with the number of evaluations: a picture in SVG.
#pragma once

#include "app/integrate/integrate_options.h"
#include <string>

#include "montelux/mc/integrate/result.h"

namespace montelux::app {

// Above the value with a band of one and of two standard errors, below the standard error with a line that
// falls as 1 / sqrt(N); both against the evaluations N on a logarithmic scale. Of the first formula. Throws
// Error when the file cannot be written.
void write_convergence_plot(const std::string& path, const IntegrationTask& task,
                            const IntegrationResult& result);

// The picture as text.
std::string convergence_svg(const std::string& title, const IntegrationResult& result);

} // namespace montelux::app
