// Values of options that are read by rules of their own, and refused with a sentence.
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>

namespace montelux::app {

// Throws CLI::ValidationError, which ends the program with exit code 2.
[[noreturn]] void refuse(const std::string& option, const std::string& given, const std::string& expected);

// Of [0, infinity) and (0, infinity).
double parse_not_negative(const std::string& option, const std::string& s);
double parse_positive(const std::string& option, const std::string& s);
// 0.01 or 1%; of (0, 1).
double parse_share(const std::string& option, const std::string& s);

// Seconds, not negative: 90, 90s, 1.5m, 1h30m; and above 0.
double parse_duration(const std::string& option, const std::string& s);
double parse_time_limit(const std::string& option, const std::string& s);
// Bytes: 500M, 1.5G; K, M, G and T are powers of 1024. At least `lowest`.
std::size_t parse_size(const std::string& option, const std::string& s, std::size_t lowest);
// A whole number of [lowest, highest], also as 1e6; signs and fractions make none.
std::uint64_t parse_whole_number(const std::string& option, const std::string& s, std::uint64_t lowest,
                                 std::uint64_t highest);

// For CLI::Option::check. CLI::Range would let NaN pass, and takes what follows a number.
CLI::Validator number_within(double lower, double upper);
CLI::Validator file_name();

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

// An option that takes a whole number of [lowest, highest]; the target may be optional.
template <typename Target>
CLI::Option* add_whole_number(CLI::App& c, const std::string& name, Target& target, std::uint64_t lowest,
                              std::uint64_t highest, const std::string& help) {
    auto read = [lowest, highest](const std::string& option, const std::string& text) {
        using Value = std::conditional_t<std::is_same_v<Target, int>, int, std::uint64_t>;
        return static_cast<Value>(parse_whole_number(option, text, lowest, highest));
    };
    return add_parsed(c, name, "N", target, read, help);
}

} // namespace montelux::app
