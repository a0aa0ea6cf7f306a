#include "bench/integrate/options.h"

#include "bench/integrate/command_line.h"

namespace montelux::bench {

std::string_view options_help() {
    return "Compares integrators: evaluations, CPU time, claimed and true errors.\n"
           "  --lines A,B       lines, by name or beginning of a name (osc, gauss-5, ...)  [all]\n"
           "  --methods A,B     methods, the same way (montelux, gsl-vegas, ...)  [all]\n"
           "  --targets X,Y     relative errors to be reached; 'none' for none  [1e-3,1e-4]\n"
           "  --fixed N         evaluations to be spent for the table of true errors; 0: none  [1e6]\n"
           "  --cap N           most evaluations of a run  [2e7]\n"
           "  --seeds N         runs of each kind  [20]\n"
           "  --overhead N      evaluations for the table of overheads; 0: none  [4e6]\n"
           "  --json FILE       every run and every summary\n"
           "  --vegas-python P  Python interpreter that can import the package vegas\n"
           "  --list            names of lines and methods\n";
}

Options parse_options(const std::vector<std::string_view>& arguments) {
    Options options;
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        const std::string_view option = arguments[i];
        if (option == "--help" || option == "-h") {
            options.help = true;
            continue;
        }
        if (option == "--list") {
            options.list = true;
            continue;
        }
        auto value = [&] {
            if (i + 1 == arguments.size()) throw Error(option, "expected a value");
            return arguments[++i];
        };
        if (option == "--lines")
            options.lines = comma_separated(value());
        else if (option == "--methods")
            options.methods = comma_separated(value());
        else if (option == "--targets") {
            options.targets.clear();
            for (const std::string& target : comma_separated(value()))
                if (target != "none") options.targets.push_back(number_in_range(option, target, 1e-14, 1));
        } else if (option == "--fixed")
            options.fixed = number_in_range(option, value(), 0, 1e12);
        else if (option == "--cap")
            options.cap = number_in_range(option, value(), 1, 1e12);
        else if (option == "--seeds")
            options.seeds = static_cast<std::uint64_t>(number_in_range(option, value(), 1, 1e6));
        else if (option == "--overhead")
            options.overhead = number_in_range(option, value(), 0, 1e12);
        else if (option == "--json")
            options.json = value();
        else if (option == "--vegas-python")
            options.vegas_python = value();
        else
            throw Error(option, "there is no such option; --help lists them");
    }
    return options;
}

} // namespace montelux::bench
