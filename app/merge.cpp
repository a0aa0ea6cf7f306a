// montelux merge: slices of one render, joined.
#include "app/commands.h"
#include "app/interrupt.h"
#include "app/joined.h"
#include "app/picture_notices.h"
#include "app/progress_line.h"
#include "app/tone_options.h"
#include "app/usage_error.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "montelux/film/merge_slices.h"
#include "montelux/image/image_read.h"
#include "montelux/image/image_write.h"
#include "montelux/image/visible_error.h"

namespace montelux::app {

namespace {

struct MergeSettings {
    std::vector<std::string> inputs, outputs;
    ToneOptions tone{};
    bool quiet = false;
};

void run(const MergeSettings& settings) {
    end_on_signals();
    for (const std::string& output : settings.outputs) {
        check_writable(output);
        std::error_code ignored;
        for (const std::string& input : settings.inputs)
            if (std::filesystem::equivalent(input, output, ignored))
                throw UsageError(output, "it is one of the slices; the joined picture needs another name");
    }
    check(settings.tone, settings.outputs);
    SliceMerger merger;
    for (const std::string& input : settings.inputs) merger.add(read_image(input), input);
    const MergedSlices merged = merger.finish();
    finish_on_signals();
    for (const std::string& output : settings.outputs)
        write_image(output, merged.image,
                    tone_of(settings.tone, output, merged.image, DefaultExposure::suitable, settings.quiet));
    if (settings.quiet) return;
    if (!merged.missing.empty()) {
        std::string list;
        constexpr std::size_t most = 10;
        for (std::size_t i = 0; i < std::min(most, merged.missing.size()); ++i)
            list += (i > 0 ? ", " : "") + std::to_string(merged.missing[i]);
        if (merged.missing.size() > most)
            list += " and " + std::to_string(merged.missing.size() - most) + " more";
        std::fprintf(stderr,
                     "montelux: warning: without slice%s %s: the picture is right, with fewer samples\n",
                     merged.missing.size() > 1 ? "s" : "", list.c_str());
    }
    print_clamped(merged.clamped_samples, merged.clamped_luminance, merged.mean_luminance);
    const std::optional<double> visible = visible_error_share(
        merged.image,
        tone_curve_of(settings.tone, merged.image.select(std::vector<std::string>{"R", "G", "B"}),
                      DefaultExposure::suitable));
    std::printf("%s: %d x %d pixels of %zu slice%s, %.7g samples per pixel, relative error %s%s\n",
                joined(settings.outputs).c_str(), merged.image.width(), merged.image.height(),
                settings.inputs.size(), settings.inputs.size() > 1 ? "s" : "", merged.mean_samples,
                percent_text(merged.relative_error).c_str(), visible_text(visible).c_str());
    print_outliers(merged.outliers);
}

} // namespace

void add_merge(CLI::App& app, int& exit_code) {
    auto s = std::make_shared<MergeSettings>();
    CLI::App* command = app.add_subcommand("merge", "Join the slices of a render into one picture");
    command->add_option("SLICE", s->inputs, "EXR files that montelux render --slice K/N wrote")->required();
    command->add_option("-o,--output", s->outputs, "Picture to write; may be given several times")
        ->type_name("FILE")
        ->required()
        ->allow_extra_args(false);
    declare(*command, s->tone);
    command->add_flag("--quiet", s->quiet, "Print only errors");
    command->footer(
        "Example:\n"
        "  for k in 1 2 3 4; do montelux render scene.pbrt --spp 256 --slice $k/4 -o part$k.exr; done\n"
        "  montelux merge part*.exr -o whole.exr");
    command->callback([s, &exit_code] {
        run(*s);
        exit_code = exit_done;
    });
}

} // namespace montelux::app
