// Values of options that are read by rules of their own, and refused with a sentence.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace montelux::app {

// Throws CLI::ValidationError, which ends the program with exit code 2.
[[noreturn]] void refuse(const std::string& option, const std::string& given, const std::string& expected);

// Of [0, infinity) and (0, infinity).
double parse_not_negative(const std::string& option, const std::string& s);
double parse_positive(const std::string& option, const std::string& s);
// 0.01 or 1%; of (0, 1).
double parse_share(const std::string& option, const std::string& s);

// An option that `parse(name, text)` reads, or refuses. Given twice, the last counts.
template <typename Target, typename Parse>
CLI::Option* add_parsed(CLI::App& c, const std::string& name, const char* type, Target& target,
                        const Parse& parse, const std::string& help) {
    return c
        .add_option_function<std::string>(
            name, [name, &target, parse](const std::string& text) { target = parse(name, text); }, help)
        ->type_name(type)
        ->take_last();
}

} // namespace montelux::app
