// The command line of montelux_bench_hard.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace montelux::bench {

struct HardOptions {
    std::vector<std::string> families; // names, or beginnings of names; empty: all
    std::vector<std::string> methods;  // names; empty: those of the comparison
    std::vector<double> targets{1e-2, 1e-3, 1e-4};
    std::string bank = "judging"; // or "tuning": the families that constants are set on
    double cap = 3e6;
    double seconds = 60;
    std::uint64_t seeds = 40, first_seed = 0;
    int jobs = 1;
    std::string json;
    std::vector<std::string> report; // files of earlier runs; empty: runs are made
    std::string vegas_python;
    bool quick = false, verbose = false, list = false, help = false;
};

// Throws Error for an unknown option, or a value that cannot be read.
HardOptions parse_hard_options(const std::vector<std::string_view>& arguments);
std::string_view hard_options_help();

} // namespace montelux::bench
