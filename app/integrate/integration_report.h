// The result of an integration for people and for programs.
#pragma once

#include "app/integrate/integrate_options.h"
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "montelux/mc/integrate/integrate_log.h"

namespace montelux::app {

// One line a component as 1.2345(67), then how it came about.
std::string report_text(const IntegrationTask& task, const IntegrationResult& result);
std::string report_text(const LogIntegrationResult& result);

// Scalars for one formula; arrays (the covariance: of rows) for several. null means unknown or
// infinite.
nlohmann::ordered_json report_json(const IntegrationTask& task, const IntegrationResult& result);
// log_value, log_error and log_reference, to which the history is relative, in the place of the values.
nlohmann::ordered_json report_json(const IntegrationTask& task, const LogIntegrationResult& result);

} // namespace montelux::app
