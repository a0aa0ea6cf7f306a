// The command line of the comparison.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace montelux::bench {

struct Options {
    std::vector<std::string> lines;   // names, or beginnings of names; empty: all
    std::vector<std::string> methods; // the same
    std::vector<double> targets{1e-3, 1e-4};
    double fixed = 1e6; // evaluations to be spent; 0: no such table
    double cap = 2e7;
    std::uint64_t seeds = 20;
    double overhead = 4e6; // evaluations; 0: no such table
    std::string json;
    std::string vegas_python;
    bool list = false, help = false;
};

// Throws Error for an unknown option, or a value that cannot be read.
Options parse_options(const std::vector<std::string_view>& arguments);
std::string_view options_help();

} // namespace montelux::bench
