// Options of `montelux integrate`: flags as typed, and the task that they describe.
#pragma once

#include "app/variables.h"
#include <cstdint>
#include <string>
#include <vector>

#include "montelux/mc/integrate/integrate.h"

namespace CLI {
class App;
}

namespace montelux::app {

// As typed; numbers may be formulas ("1e6", "pi/2") and are read by make_task.
struct IntegrateOptions {
    std::vector<std::string> formulas, let, over, densities;
    std::string library, source, components;
    std::string domain = "box", radius, centre;
    std::string method, device;
    std::string relative_error, absolute_error, norm = "component", evaluations, time, seed = "0",
                                                threads = "0";
    std::string non_finite = "skip";
    std::string checkpoint, checkpoint_every, plot, points, save_density, points_limit = "10000";
    bool log = false, resume = false, json = false, quiet = false;
};

// An integration that is ready to run. `options` lacks progress and cancel.
struct IntegrationTask {
    std::vector<std::string> variables;
    NamedConstants constants;
    NamedIntegrand integrand;
    Domain domain;
    Method method;
    Budget budget;
    IntegrationOptions options;
    std::uint64_t points_limit;
    bool logarithm; // the integrand is log f

    bool targeted() const { return budget.relative_error > 0 || budget.absolute_error > 0; }
};

void declare(CLI::App& command, IntegrateOptions& options);

// Words of a command's line, its name left out, in which formulas such as -x^2 have got a blank before the
// minus sign, so that they are not taken for options. Values of options stay as they are.
std::vector<std::string> with_negative_formulas(const CLI::App& command, std::vector<std::string> words);

// Throws UsageError for what makes no sense, and Error for a density that does not suit the integrand.
IntegrationTask make_task(const IntegrateOptions& options);

// A whole number of [lowest, highest], which may be written as 1e6, 10k, 1.5M or 2G; throws UsageError.
std::uint64_t whole_number(const std::string& text, const std::string& option, std::uint64_t lowest,
                           std::uint64_t highest);

} // namespace montelux::app
