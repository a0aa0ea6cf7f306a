#include "bench/integrate/options.h"

#include <charconv>

#include "montelux/mc/math/error.h"

namespace montelux::bench {

namespace {

std::vector<std::string> split(std::string_view text) {
    std::vector<std::string> parts;
    while (!text.empty()) {
        const std::size_t comma = text.find(',');
        if (comma != 0) parts.emplace_back(text.substr(0, comma));
        text = comma == std::string_view::npos ? "" : text.substr(comma + 1);
    }
    return parts;
}

double number(std::string_view option, std::string_view text, double least, double most) {
    double value = 0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (failure != std::errc() || end != text.data() + text.size() || !(value >= least && value <= most))
        throw Error(option, "'" + std::string(text) + "' is not a number in range");
    return value;
}

} // namespace

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
            options.lines = split(value());
        else if (option == "--methods")
            options.methods = split(value());
        else if (option == "--targets") {
            options.targets.clear();
            for (const std::string& target : split(value()))
                if (target != "none") options.targets.push_back(number(option, target, 1e-14, 1));
        } else if (option == "--fixed")
            options.fixed = number(option, value(), 0, 1e12);
        else if (option == "--cap")
            options.cap = number(option, value(), 1, 1e12);
        else if (option == "--seeds")
            options.seeds = static_cast<std::uint64_t>(number(option, value(), 1, 1e6));
        else if (option == "--overhead")
            options.overhead = number(option, value(), 0, 1e12);
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
