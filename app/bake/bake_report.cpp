// montelux bake report: the split sum compared with the integral that it approximates.
#include "app/bake/bake.h"
#include "app/bake/bake_map.h"
#include "app/bake/bake_run.h"
#include "app/commands.h"
#include "app/json_number.h"
#include "app/option_values.h"
#include "app/output_files.h"
#include "app/tone_options.h"
#include "app/usage_error.h"
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "montelux/bake/split_sum_report.h"
#include "montelux/image/image_write.h"

namespace montelux::app {
namespace {

struct ReportOptions {
    BakeMapOptions map;
    std::vector<std::string> outputs;
    SplitSumSettings settings;
    ToneOptions tone{};
    BakeRunOptions run;
};

void print_json(const ReportOptions& o, const SplitSumReport& report) {
    nlohmann::ordered_json out;
    out["map"] = o.map.file;
    for (const SplitSumRow& r : report.rows)
        out["rows"].push_back({{"roughness", r.roughness},
                               {"n_dot_v", r.n_dot_v},
                               {"f0", r.f0},
                               {"full", json_number(r.full)},
                               {"bias", json_number(r.bias)},
                               {"bias_error", json_number(r.bias_error)},
                               {"rms", json_number(r.rms)}});
    std::printf("%s\n", out.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace).c_str());
}

void print_text(const SplitSumReport& report) {
    std::printf("%9s %6s %6s %12s %20s %10s\n", "roughness", "n.v", "F0", "full", "split - full", "rms");
    for (const SplitSumRow& r : report.rows)
        std::printf("%9.3g %6.3g %6.3g %12.5g %+9.2f +- %4.2f %% %8.2f %%\n", r.roughness, r.n_dot_v, r.f0,
                    r.full, 100 * r.bias, 100 * r.bias_error, 100 * r.rms);
}

int run(const ReportOptions& o) {
    check_output_names(o.outputs, {o.map.file});
    for (const std::string& path : o.outputs) check_writable(path);
    const EnvironmentMap map = read_map(o.map, o.run.quiet);
    SplitSumSettings settings = o.settings;
    settings.frame = frame_of(o.map);
    if (o.outputs.empty()) settings.sphere_size = 0;
    BakeRun bake(o.run.quiet, "the report");
    settings.progress = bake.progress();
    settings.cancel = bake.cancel();
    const SplitSumReport report = split_sum_report(map, settings);
    if (bake.interrupted(report.cancelled)) return exit_interrupted;
    OutputFiles files;
    for (const std::string& path : o.outputs)
        files.write(path, [&] {
            write_image(path, report.spheres,
                        tone_of(o.tone, path, report.spheres, DefaultExposure::suitable, o.run.quiet));
        });
    if (o.run.json)
        print_json(o, report);
    else if (!o.run.quiet)
        print_text(report);
    files.throw_failures();
    return exit_done;
}

} // namespace

void add_bake_report(CLI::App& bake, int& exit_code) {
    auto o = std::make_shared<ReportOptions>();
    SplitSumSettings& s = o->settings;
    CLI::App* command = bake.add_subcommand("report", "Compare the split sum with the full integral");
    declare(*command, o->map);
    command
        ->add_option("-o,--output", o->outputs,
                     "Picture of spheres, a column per roughness: full integral, split sum, size of the "
                     "difference; .exr has "
                     "the standard errors")
        ->type_name("FILE")
        ->allow_extra_args(false);
    command->add_option("--roughness", s.roughness, "Perceptual roughness")
        ->delimiter(',')
        ->check(number_within(0.03, 1.0))
        ->type_name("LIST");
    command->add_option("--n-dot-v", s.n_dot_v, "Cosines of the view in the table")
        ->delimiter(',')
        ->check(number_within(0.01, 1.0))
        ->type_name("LIST");
    command->add_option("--f0", s.f0, "Reflectances along the normal in the table")
        ->delimiter(',')
        ->check(number_within(0.0, 1.0))
        ->type_name("LIST");
    command
        ->add_option("--orientations", s.orientations, "Random surfaces and views for each row of the table")
        ->check(CLI::Range(2, 1 << 20))
        ->type_name("N");
    command->add_option("--sphere-size", s.sphere_size, "Pixels across a sphere")
        ->check(CLI::Range(1, 4096))
        ->type_name("N");
    command->add_option("--sphere-f0", s.sphere_f0, "Reflectance of the spheres")
        ->check(number_within(0.0, 1.0))
        ->type_name("F0");
    add_parsed(*command, "--target-error", "ERROR", s.target_error, parse_share,
               "Standard error of either side at one place: 0.01 (taken without the option) or 1%");
    declare(*command, o->tone);
    add_whole_number(*command, "--seed", s.seed, 0, UINT64_MAX, "Seed of the noise");
    declare(*command, o->run);
    command->footer(
        "split - full is the mean difference over the mean of the integral over random orientations, with "
        "its standard error;\nrms is the root of the mean squared difference.\n\n"
        "Example:\n  montelux bake report sky.hdr -o spheres.png --exposure -1");
    on_command(*command, o->run, exit_code, [o] { return run(*o); });
}

} // namespace montelux::app
