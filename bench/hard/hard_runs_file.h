// Runs over the bank of hard integrals as JSON: written, and read again for a report of several files.
#pragma once

#include "bench/hard/hard_runner.h"
#include <string>
#include <vector>

namespace montelux::bench {

// Throws Error where the file cannot be written.
void write_hard_json(const std::string& path, const HardPlan& plan, const std::vector<HardRun>& runs);

struct HardRecord {
    HardPlan plan; // its methods have names alone and cannot run
    std::vector<HardRun> runs;
};

// The runs of all files together, so that a comparison of hours can be made in pieces. Throws Error for a file
// that cannot be read, a run that two files have, and runs with different limits.
HardRecord read_hard_json(const std::vector<std::string>& paths);

} // namespace montelux::bench
