// What the help text of an option says, in parts: for the manual page and for the completion of shells.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class Option;
}

namespace montelux::app {

bool is_flag(const CLI::Option& option);

// Such as "FILE", "WxH" or "on|off"; empty for a flag.
std::string option_type(const CLI::Option& option);

// The names that it takes, where its help lists them: by its type ("on|off", "AXIS:{y,z}"), or by the first
// list after a colon in its description ("Sampler: halton, sobol"). Else empty.
std::vector<std::string> option_choices(const CLI::Option& option);

} // namespace montelux::app
