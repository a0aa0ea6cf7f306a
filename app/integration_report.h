// The result of an integration for people and for programs.
#pragma once

#include "app/integrate_options.h"
#include <nlohmann/json.hpp>
#include <string>

#include "montelux/mc/integrate/result.h"

namespace montelux::app {

// One line a component as 1.2345(67), then how it came about.
std::string report_text(const IntegrationTask& task, const IntegrationResult& result);

// Scalars for one formula; arrays (the covariance: of rows) for several. null stands for what is unknown or
// infinite.
nlohmann::ordered_json report_json(const IntegrationTask& task, const IntegrationResult& result);

} // namespace montelux::app
