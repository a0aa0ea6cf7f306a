// montelux denoise: a smooth guess at what a noisy picture would become.
#include "app/commands.h"
#include "app/denoised_output.h"
#include "app/interrupt.h"
#include "app/output_files.h"
#include "app/progress_line.h"
#include "app/tone_options.h"
#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <memory>
#include <vector>

#include "montelux/image/image_read.h"
#include "montelux/image/image_write.h"
#include "montelux/mc/parallel/parallel_for.h"

namespace montelux::app {

namespace {

struct DenoiseSettings {
    std::string input;
    std::vector<std::string> outputs;
    ToneOptions tone{};
    int threads = 0;
    bool quiet = false;
};

int run(const DenoiseSettings& settings) {
    end_on_signals();
    for (const std::string& output : settings.outputs) check_writable(output);
    check(settings.tone, settings.outputs);
    const Denoiser denoiser = Denoiser::load(settings.threads);
    Image image = read_image(settings.input);
    auto begin = std::chrono::steady_clock::now();
    const DenoiseReport report = denoise_image(denoiser, image);
    double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const std::string note = describe(denoiser, report, settings.quiet);
    finish_on_signals();
    OutputFiles files;
    for (const std::string& output : settings.outputs)
        files.write(output, [&] {
            write_picture(output, image,
                          tone_of(settings.tone, output, denoised_picture(image), DefaultExposure::suitable,
                                  settings.quiet));
        });
    if (!settings.quiet)
        for (const std::string& output : files.written())
            std::printf("%s: %d x %d pixels, %s, %s\n", output.c_str(), image.width(), image.height(),
                        duration_text(seconds).c_str(), note.c_str());
    files.throw_failures();
    return exit_done;
}

} // namespace

void add_denoise(CLI::App& app, int& exit_code) {
    auto settings = std::make_shared<DenoiseSettings>();
    CLI::App* command =
        app.add_subcommand("denoise", "Denoise a picture by Open Image Denoise, where that is installed");
    command
        ->add_option("FILE", settings->input,
                     "The picture: its R, G, B; the layers albedo and N guide the denoiser where it has them")
        ->required();
    command
        ->add_option(
            "-o,--output", settings->outputs,
            "Picture to write; may be given several times. .exr keeps every layer and gets the layers "
            "denoised.R, G, B; .png, .jpg, .hdr and .pfm show them")
        ->type_name("FILE")
        ->allow_extra_args(false)
        ->required();
    declare(*command, settings->tone);
    command->add_option("--threads", settings->threads, "Threads at most; 0: one per processor")
        ->type_name("N")
        ->check(CLI::Range(0, most_threads));
    command->add_flag("--quiet", settings->quiet, "Print only errors");
    command->footer(
        "Example:\n  montelux denoise out.exr -o out.exr -o out.png\n"
        "\n"
        "The library is libOpenImageDenoise.so.2, .so.1 or .so, or the file that the\n"
        "variable MONTELUX_OIDN_LIBRARY names. A denoised picture is a guess: the layer stderr holds the\n"
        "errors of the picture before denoising, not of the guess.");
    command->callback([settings, &exit_code] {
        exit_code = with_threads(settings->threads, [&] { return run(*settings); });
    });
}

} // namespace montelux::app
