// The comparison as Markdown tables and as JSON.
#pragma once

#include "bench/integrate/montelux_methods.h"
#include "bench/integrate/runner.h"
#include "bench/integrate/summary.h"
#include <iosfwd>
#include <span>
#include <string>

namespace montelux::bench {

void print_report(std::ostream& out, const Plan& plan, const std::vector<Run>& runs, const Summary& summary);
void print_scaling(std::ostream& out, std::span<const Scaling> scaling);
void print_overheads(std::ostream& out, std::span<const Overhead> overheads);

// Every run and every cell. Throws Error where the file cannot be written.
void write_json(const std::string& path, const Plan& plan, const std::vector<Run>& runs,
                const Summary& summary, std::span<const Overhead> overheads,
                std::span<const Scaling> scaling);

} // namespace montelux::bench
