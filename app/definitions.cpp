#include "app/definitions.h"

#include "app/option_values.h"
#include <vector>

namespace montelux::app {

void declare_definitions(CLI::App& command, std::map<std::string, std::string>& definitions) {
    command
        .add_option_function<std::vector<std::string>>(
            "-D,--define",
            [&definitions](const std::vector<std::string>& all) {
                for (const std::string& text : all) {
                    const std::size_t equals = text.find('=');
                    if (equals == 0 || equals == std::string::npos)
                        refuse("-D", text, "NAME=VALUE is expected");
                    definitions[text.substr(0, equals)] = text.substr(equals + 1);
                }
            },
            "Of a Mitsuba scene: the value of its parameter $NAME; may be given for each")
        ->type_name("NAME=VALUE")
        ->allow_extra_args(false);
}

} // namespace montelux::app
