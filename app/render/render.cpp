// montelux render: from a scene file to a picture with error bars.
#include "app/cluster_job.h"
#include "app/commands.h"
#include "app/interrupt.h"
#include "app/render/cluster_render.h"
#include "app/render/picture.h"
#include "app/render/render_command.h"
#include "app/render/render_options.h"
#include "app/render/requests.h"
#include "app/render/sequence.h"
#include <CLI/CLI.hpp>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "montelux/image/image_write.h"
#include "montelux/mc/io/generation_file.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/render/check_render.h"
#include "montelux/render/checkpoint.h"
#include "montelux/render/sample_allocation.h"
#include "montelux/render/sample_record_text.h"

namespace montelux::app {

namespace {

// Checks outputs before the work. Never overwrites a checkpoint without --resume.
void check_checkpoint(const RenderOptions& options, const std::vector<std::string>& outputs,
                      const std::vector<std::filesystem::path>& files_read) {
    const std::string& checkpoint = options.checkpoint;
    check_not_read(checkpoint, files_read);
    for (const std::string& output : outputs)
        for (const std::filesystem::path& file :
             {std::filesystem::path(checkpoint), previous_generation(checkpoint)})
            if (std::filesystem::absolute(output).lexically_normal() ==
                std::filesystem::absolute(file).lexically_normal())
                throw UsageError(output, "the checkpoint has this name; the picture needs another");
    check_generation_writable(checkpoint);
    if (!options.resume && generation_exists(checkpoint))
        throw UsageError(checkpoint, "the file exists; add --resume to resume from it, or remove it");
}

int replay(const RenderOptions& options, const SceneDescription& description, const RenderTarget& target) {
    // A resumed render keeps its original replicates.
    std::uint32_t replicate_points = 0;
    if (options.resume && generation_exists(options.checkpoint))
        replicate_points = load_checkpoint(options.checkpoint, description, target).replicate_points;
    const SampleAddress& s = *options.debug_sample;
    try {
        check_sample(description, s.x, s.y, s.index, target);
    } catch (const Error& e) {
        throw UsageError("--debug-sample", e.what());
    }
    if (!options.quiet && (!options.outputs.empty() || options.stats))
        std::fprintf(stderr, "montelux: warning: --debug-sample renders no picture: nothing is written, and "
                             "there are no statistics\n");
    check_slice_option(with_points(sampler_of(description), replicate_points), target);
    const Renderer renderer(description, target, replicate_points);
    std::fputs(sample_record_text(renderer.replay(s.x, s.y, s.index), description).c_str(), stdout);
    return exit_done;
}

int load_and_render(const RenderOptions& options, SharedRender& shared) {
    if (options.frames || options.turntable) return render_sequence(options, shared);
    using Clock = std::chrono::steady_clock;
    for (const std::string& output : options.outputs) check_writable(output);
    check(options.tone, options.outputs);

    auto load_begin = Clock::now();
    Warnings warnings;
    std::vector<std::filesystem::path> files_read;
    RequestedScene requested = load_requested(options, warnings, shared.files(), &files_read);
    SceneDescription& description = requested.description;
    const double load_seconds = std::chrono::duration<double>(Clock::now() - load_begin).count();
    if (!options.quiet) LoadNotices().print(options.scene, warnings, requested.added);
    const RenderTarget target = target_of(options, description.integrator.method);
    if (options.debug_sample) return replay(options, description, target);
    // The command view writes what it is asked for.
    const bool writes = !options.view.stays || !options.outputs.empty();
    const std::vector<std::string> outputs =
        writes ? outputs_of(options, description) : std::vector<std::string>();
    for (const std::string& output : outputs) check_picture_path(output, files_read);
    if (!options.checkpoint.empty()) check_checkpoint(options, outputs, files_read);
    check_requested(description, target, !options.checkpoint.empty());
    std::optional<Denoiser> denoiser; // if it is missing, the error comes before the render
    if (options.denoise) denoiser.emplace(Denoiser::load(options.threads));
    return render_picture({.description = std::make_shared<SceneDescription>(std::move(description)),
                           .target = target,
                           .outputs = outputs,
                           .tone = options.tone,
                           .load_seconds = load_seconds},
                          options, shared, denoiser)
        .exit_code;
}

} // namespace

int run_render(const RenderOptions& options) {
    check(options.view);
    if (options.view.any() && (options.frames || options.turntable))
        throw UsageError("--view", "it shows one picture, not a sequence");
    end_on_signals();
    // A closed pipe of messages must not end the render.
    std::signal(SIGPIPE, SIG_IGN);
    Communicator* const job = join_job(options.rank_timeout);
    if (job != nullptr && options.view.any())
        throw UsageError("--view", "a render that mpirun shares among ranks cannot be shown while it runs");
    const int fair_threads = job != nullptr ? job->fair_threads() : 0;
    const int threads = options.threads > 0 ? options.threads : fair_threads;
    return with_threads(threads, [&] {
        if (job != nullptr && job->rank() != 0) {
            help_rendering(*job, options, threads);
            return exit_done;
        }
        SharedRender shared(job, threads, options.rank_timeout);
        return load_and_render(options, shared);
    });
}

void add_render(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<RenderOptions>();
    CLI::App* command = app.add_subcommand("render", "Render a scene: every pixel with its standard error");
    declare(*command, *options);
    command->callback([options, &exit_code] { exit_code = run_render(*options); });
}

} // namespace montelux::app
