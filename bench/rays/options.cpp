#include "bench/rays/options.h"

#include "bench/integrate/command_line.h"

namespace montelux::bench {

std::string_view ray_options_help() {
    return "Records the rays of renders and traces them through Embree alone, on one thread: one by one,\n"
           "in packets and in streams, in several orders.\n"
           "usage: montelux_bench_rays SCENE ... [options]\n"
           "  --width N        pixels of the picture  [400]\n"
           "  --spp N          samples per pixel  [16]\n"
           "  --rays N         at most, of each kind  [1000000]\n"
           "  --repetitions N  of which the least time counts  [3]\n"
           "  --json FILE      every figure\n";
}

RayOptions parse_ray_options(const std::vector<std::string_view>& arguments) {
    RayOptions options;
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        const std::string_view option = arguments[i];
        auto value = [&] {
            if (i + 1 == arguments.size()) throw Error(option, "expected a value");
            return arguments[++i];
        };
        auto count = [&](double most) { return number_in_range(option, value(), 1, most); };
        if (option == "--help" || option == "-h")
            options.help = true;
        else if (option == "--width")
            options.width = static_cast<int>(count(1e5));
        else if (option == "--spp")
            options.spp = static_cast<std::uint32_t>(count(1e6));
        else if (option == "--rays")
            options.rays = static_cast<std::size_t>(count(1e8));
        else if (option == "--repetitions")
            options.repetitions = static_cast<int>(count(1e4));
        else if (option == "--json")
            options.json = value();
        else if (option.starts_with("-"))
            throw Error(option, "there is no such option; --help lists them");
        else
            options.scenes.emplace_back(option);
    }
    if (options.scenes.empty() && !options.help)
        throw Error("montelux_bench_rays", "expected at least one scene; --help explains the options");
    return options;
}

} // namespace montelux::bench
