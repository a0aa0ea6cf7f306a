#include "bench/hard/hard_options.h"

#include "bench/hard/quick.h"
#include "bench/integrate/command_line.h"
#include <iterator>

namespace montelux::bench {

std::string_view hard_options_help() {
    return "Runs integrators over the bank of hard integrals: silent failures, honest convergence, "
           "coverage.\n"
           "  --bank NAME       judging, or tuning: the families that constants of integrators are set on  "
           "[judging]\n"
           "  --families A,B    families, by name or beginning of a name (ring, mixture, ...)  [all]\n"
           "  --methods A,B     methods by name (auto, adaptive, vegas+, ...)\n"
           "                    [auto, adaptive, cubature, vegas, vegas_sobol, quasi, basic, stratified,\n"
           "                    recursive, vegas+]\n"
           "  --targets X,Y     relative errors  [1e-2,1e-3,1e-4]\n"
           "  --seeds N         integrals of each family  [40]\n"
           "  --first-seed N    seed of the first  [0]\n"
           "  --cap N           most evaluations of a run  [3e6]\n"
           "  --time S          wall time of a run, for methods that know a limit of it  [60]\n"
           "  --jobs N          processes at a time  [1]\n"
           "  --json FILE       every run\n"
           "  --report A,B      runs nothing: prints the tables of files that --json wrote, taken together\n"
           "  --vegas-python P  Python interpreter that can import the package vegas\n"
           "  --quick           as a test: auto and adaptive on a few seeds (--seeds changes how many), "
           "exit\n"
           "                    code 1 where there are more silent failures than allowed\n"
           "  --verbose         each silent failure in words\n"
           "  --list            families with their formulas, and methods\n";
}

HardOptions parse_hard_options(const std::vector<std::string_view>& arguments) {
    HardOptions options;
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        const std::string_view option = arguments[i];
        auto value = [&] {
            if (i + 1 == arguments.size()) throw Error(option, "expected a value");
            return arguments[++i];
        };
        auto number = [&](double least, double most) {
            return number_in_range(option, value(), least, most);
        };
        if (option == "--help" || option == "-h")
            options.help = true;
        else if (option == "--list")
            options.list = true;
        else if (option == "--verbose")
            options.verbose = true;
        else if (option == "--quick") {
            options.quick = options.verbose = true;
            options.bank = "tuning";
            options.methods = {"auto", "adaptive"};
            options.targets.assign(std::begin(quick_targets), std::end(quick_targets));
            options.cap = quick_cap;
            options.seconds = quick_seconds;
            options.seeds = quick_seeds;
        } else if (option == "--bank") {
            options.bank = value();
            if (options.bank != "judging" && options.bank != "tuning")
                throw Error(option, "'" + options.bank + "' was given; expected judging or tuning");
        } else if (option == "--families")
            options.families = comma_separated(value());
        else if (option == "--methods")
            options.methods = comma_separated(value());
        else if (option == "--targets") {
            options.targets.clear();
            for (const std::string& target : comma_separated(value()))
                options.targets.push_back(number_in_range(option, target, 1e-14, 1));
        } else if (option == "--cap")
            options.cap = number(1, 1e12);
        else if (option == "--time")
            options.seconds = number(0.001, 1e6);
        else if (option == "--seeds")
            options.seeds = static_cast<std::uint64_t>(number(1, 1e6));
        else if (option == "--first-seed")
            options.first_seed = static_cast<std::uint64_t>(number(0, 1e15));
        else if (option == "--jobs")
            options.jobs = static_cast<int>(number(1, 1000));
        else if (option == "--json")
            options.json = value();
        else if (option == "--report") {
            options.report = comma_separated(value());
            if (options.report.empty()) throw Error(option, "expected files that --json wrote");
        } else if (option == "--vegas-python")
            options.vegas_python = value();
        else
            throw Error(option, "there is no such option; --help lists them");
    }
    if (options.targets.empty()) throw Error("--targets", "expected at least one relative error");
    return options;
}

} // namespace montelux::bench
