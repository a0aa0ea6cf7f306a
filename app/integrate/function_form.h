// FunctionForm: how a function in C is declared that is an integrand.
#pragma once

#include <filesystem>
#include <string>

namespace montelux::app {

struct FunctionForm {
    bool components = false; // several values, written to an argument; else one that is returned
    bool parameters = false; // constants follow as the last argument
};

// Throws UsageError where the compiler finds a function of a source in C or C++ to be of another form, which a call
// cannot see. A function may ignore its parameters. `folder` is for temporary files; the source compiles.
void check_form(const std::string& source, const std::string& function, const FunctionForm& form,
                const std::filesystem::path& folder);

} // namespace montelux::app
