// The option -D NAME=VALUE: values of the parameters of Mitsuba scenes.
#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <string>

namespace montelux::app {

// May be given several times; the last value of a name holds. A text without '=' or a name ends the parse with a
// CLI::ValidationError.
void declare_definitions(CLI::App& command, std::map<std::string, std::string>& definitions);

} // namespace montelux::app
