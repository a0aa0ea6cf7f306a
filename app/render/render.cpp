// montelux render: from a scene file to a picture with error bars.
#include "app/cluster_job.h"
#include "app/commands.h"
#include "app/denoised_output.h"
#include "app/interrupt.h"
#include "app/output_files.h"
#include "app/picture_notices.h"
#include "app/render/cluster_render.h"
#include "app/render/progress.h"
#include "app/render/render_options.h"
#include "app/render/sample_record_text.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <sys/resource.h>
#include <unistd.h>

#include "montelux/formats/load_scene.h"
#include "montelux/image/image_write.h"
#include "montelux/mc/io/file.h"
#include "montelux/mc/io/generation_file.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/render/checkpoint.h"
#include "montelux/render/render_header.h"
#include "montelux/render/renderer.h"
#include "montelux/render/sample_allocation.h"
#include "montelux/render/sample_order.h"

namespace montelux::app {

namespace {

double seconds_since(std::chrono::steady_clock::time_point begin) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

std::vector<std::string> outputs_of(const RenderOptions& options, const SceneDescription& description) {
    if (!options.outputs.empty()) {
        std::vector<std::string> outputs;
        for (const std::string& output : options.outputs)
            if (std::find(outputs.begin(), outputs.end(), output) == outputs.end()) outputs.push_back(output);
        return outputs;
    }
    // The file's own wish, in the current folder, always with the layers that only EXR can hold.
    std::filesystem::path name = description.output_file.empty() ? options.scene : description.output_file;
    return {name.filename().replace_extension(".exr").string()};
}

void check_not_read(const std::string& output, const std::vector<std::filesystem::path>& files_read) {
    std::error_code ignored;
    for (const std::filesystem::path& file : files_read)
        if (std::filesystem::equivalent(output, file, ignored))
            throw UsageError(output, "the scene is read from this file; what is written needs another name");
}
void check_picture_path(const std::string& output, const std::vector<std::filesystem::path>& files_read) {
    check_writable(output);
    check_not_read(output, files_read);
}
// Before the work rather than after it. Nothing is replaced that is not to be gone on from.
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
        throw UsageError(checkpoint,
                         "the file is there already; add --resume to go on from it, or remove it");
}

// Asking for more than there is would end in the killing of some program, seconds or hours later.
void check_memory(const FilmSettings& film, bool with_checkpoints) {
    auto pages = static_cast<double>(sysconf(_SC_PHYS_PAGES));
    double there = pages * static_cast<double>(sysconf(_SC_PAGESIZE));
    constexpr double layers = 26, copies = 2; // the picture, and its encoding
    double pixels = static_cast<double>(film.crop.width()) * film.crop.height();
    double needed = pixels * ((with_checkpoints ? 2 : 1) * (sizeof(Pixel) + sizeof(std::uint32_t)) +
                              layers * copies * sizeof(float));
    if (pages <= 0 || needed <= there) return;
    constexpr double gib = 1 << 30;
    char text[160];
    std::snprintf(text, sizeof text, "%d x %d pixels need %.1f GiB of memory; this machine has %.1f GiB",
                  film.crop.width(), film.crop.height(), needed / gib, there / gib);
    throw Error("film", text);
}

void print_warnings(const Warnings& warnings) {
    for (const std::string& w : warnings.messages())
        std::fprintf(stderr, "montelux: warning: %s\n", w.c_str());
    if (warnings.left_out() > 0)
        std::fprintf(stderr, "montelux: warning: %zu more warnings were left out\n", warnings.left_out());
}

void print_bad_samples(const BadSampleReport& bad, std::uint64_t seed) {
    if (bad.count() == 0) return;
    const char* kind = bad.first->kind == BadSample::Kind::nan        ? "not a number"
                       : bad.first->kind == BadSample::Kind::infinite ? "infinite"
                                                                      : "negative";
    std::fprintf(
        stderr,
        "montelux: warning: %llu samples were left out (%llu not a number, %llu infinite, %llu "
        "negative); the first, %s, is sample %llu of pixel %d,%d with seed %llu; to see its path, add "
        "--debug-sample %d,%d,%llu\n",
        static_cast<unsigned long long>(bad.count()), static_cast<unsigned long long>(bad.nan),
        static_cast<unsigned long long>(bad.infinite), static_cast<unsigned long long>(bad.negative), kind,
        static_cast<unsigned long long>(bad.first->sample), bad.first->x, bad.first->y,
        static_cast<unsigned long long>(seed), bad.first->x, bad.first->y,
        static_cast<unsigned long long>(bad.first->sample));
}

// A render that was stopped may be without errors, which nothing in its picture would explain.
void print_missing_error(const FilmError& error, const SamplerSettings& sampler, const RenderTarget& target) {
    if (target.slice.count > 1) return; // the joined slices will have them
    const std::uint64_t points = SampleOrder(sampler, target.slice).replicate_size();
    if (std::isfinite(error.relative) || error.mean_samples < 2 || points < 2) return;
    std::fprintf(
        stderr,
        "montelux: warning: the errors are unknown: fewer than two replicates of %llu samples per pixel are "
        "complete; --time and --target-error use short replicates\n",
        static_cast<unsigned long long>(points));
}

// What ended the render, where that is not the number of samples.
std::string ending_text(const RenderReport& report, const RenderTarget& target) {
    switch (report.stop) {
    case RenderStop::cancelled:
        return ", stopped before the end";
    case RenderStop::error:
        return ", target reached";
    case RenderStop::time:
        return target.error > 0 ? ", time is up before the target was reached" : ", time is up";
    default:
        return target.error > 0 ? ", samples are used up before the target was reached" : "";
    }
}

void print_statistics(const RenderReport& report, double load_seconds, double build_seconds) {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    auto samples = static_cast<double>(report.samples), rays = static_cast<double>(report.rays.rays());
    std::printf("load               %.3f s\n", load_seconds);
    std::printf("build              %.3f s\n", build_seconds);
    std::printf("render             %.3f s, %.3f s of CPU\n", report.seconds, report.cpu_seconds);
    std::printf("samples            %ssamples/s, %.3f us of CPU each\n",
                count_text(samples / report.seconds).c_str(), 1e6 * report.cpu_seconds / samples);
    std::printf(
        "rays               %srays/s, %srays/s of CPU, %.2f a sample (%.2f closest hit, %.2f occlusion)\n",
        count_text(rays / report.seconds).c_str(), count_text(rays / report.cpu_seconds).c_str(),
        rays / samples, static_cast<double>(report.rays.closest) / samples,
        static_cast<double>(report.rays.occlusion) / samples);
    std::printf("inside Embree      %.1f %% of the CPU time\n",
                100 * report.ray_seconds / report.cpu_seconds);
    std::printf("peak memory        %.1f MiB\n", static_cast<double>(usage.ru_maxrss) / 1024);
}

void check_slice_option(const SceneDescription& description, const RenderTarget& target) {
    try {
        check_slice(description, target);
    } catch (const Error& e) {
        throw UsageError("--slice", e.what());
    }
}

int replay(const RenderOptions& options, const SceneDescription& description, const RenderTarget& target) {
    const SampleAddress& s = *options.debug_sample;
    try {
        check_sample(description, s.x, s.y, s.index, target);
    } catch (const Error& e) {
        throw UsageError("--debug-sample", e.what());
    }
    if (!options.quiet && (!options.outputs.empty() || options.stats))
        std::fprintf(stderr, "montelux: warning: --debug-sample renders no picture: nothing is written, and "
                             "there are no statistics\n");
    check_slice_option(description, target);
    const Renderer renderer(description, target);
    std::fputs(sample_record_text(renderer.replay(s.x, s.y, s.index), description).c_str(), stdout);
    return exit_done;
}

// A new render, or the one that is to be gone on with, whose replicates the description takes over.
RenderState initial_state(const RenderOptions& options, SceneDescription& description,
                          const RenderTarget& target) {
    if (!options.resume || !generation_exists(options.checkpoint)) {
        if (options.resume && !options.quiet)
            std::fprintf(stderr, "montelux: %s is not there yet: rendering from the start\n",
                         options.checkpoint.c_str());
        return RenderState(description.film);
    }
    RestoredRender restored = load_checkpoint(options.checkpoint, description, target);
    if (!restored.newest_refused_because.empty())
        std::fprintf(stderr, "montelux: warning: going on from the checkpoint before the last: %s\n",
                     restored.newest_refused_because.c_str());
    description.sampler.replicate_points = restored.replicate_points;
    if (const double there = restored.state.film.error().mean_samples;
        !options.quiet && target.slice.count == 1 && there > description.sampler.spp)
        std::fprintf(stderr, "montelux: %s has %.7g samples per pixel already, more than the %u asked for\n",
                     options.checkpoint.c_str(), there, description.sampler.spp);
    return std::move(restored.state);
}

int load_and_render(const RenderOptions& options, SharedRender& shared) {
    using Clock = std::chrono::steady_clock;
    for (const std::string& output : options.outputs) check_writable(output);

    auto load_begin = Clock::now();
    Warnings warnings;
    std::vector<std::filesystem::path> files_read;
    SceneDescription description = load_scene(options.scene, warnings, &files_read, shared.files());
    double load_seconds = seconds_since(load_begin);
    if (!options.quiet) print_warnings(warnings);
    apply(options, description);
    const RenderTarget target = target_of(options);
    if (options.debug_sample) {
        // The replicates of a render that was gone on with are those of its beginning.
        if (options.resume && generation_exists(options.checkpoint))
            description.sampler.replicate_points =
                load_checkpoint(options.checkpoint, description, target).replicate_points;
        return replay(options, description, target);
    }
    const std::vector<std::string> outputs = outputs_of(options, description);
    for (const std::string& output : outputs) check_picture_path(output, files_read);
    if (!options.checkpoint.empty()) check_checkpoint(options, outputs, files_read);
    check_memory(description.film, !options.checkpoint.empty());
    std::optional<Denoiser> denoiser; // one that is missing is told before the render
    if (options.denoise) denoiser.emplace(Denoiser::load(options.threads));

    RenderState state = initial_state(options, description, target);
    check_slice_option(description, target);
    RoundExecutor* const executor = shared.begin(description, target);
    Renderer renderer(description, target);
    const PixelBounds& crop = description.film.crop;
    ProgressPrinter printer(options.quiet, target.quantile > 0 ? 0 : target.error,
                            static_cast<double>(crop.width()) * crop.height() * description.sampler.spp);
    RenderControl control;
    control.progress = [&](const RenderProgress& p) { printer.update(p); };
    control.cancel = &cancel_on_signals();
    control.executor = executor;
    control.checkpoint_seconds = options.checkpoint_every;
    // A full disk must not cost the render: it goes on, and says so in the end too.
    std::string checkpoint_failure;
    if (!options.checkpoint.empty())
        control.checkpoint = [&](const RenderState& s) {
            checkpoint_failure.clear();
            try {
                save_checkpoint(options.checkpoint, renderer, s);
            } catch (const std::exception& e) {
                checkpoint_failure = e.what();
                std::fprintf(stderr, "\nmontelux: warning: %s; the render goes on without this checkpoint\n",
                             e.what());
            }
        };
    renderer.render(state, control);
    printer.finish();
    shared.end();
    const RenderReport& report = state.report;

    const FilmError error = state.film.error();
    Image image = state.film.develop(target.slice.count > 1);
    add_render_header(image, std::filesystem::path(options.scene).filename().string(), renderer, report,
                      error, clamped_luminance(state.film));
    finish_on_signals();
    const DenoiseOutcome denoised = denoise_render(denoiser, image, report.cancelled(), options.quiet);
    OutputFiles files;
    for (const std::string& output : outputs) files.write(output, [&] { write_picture(output, image); });
    if (!options.quiet) {
        print_bad_samples(report.bad, description.sampler.seed);
        print_clamped(static_cast<double>(report.clamped_samples), clamped_luminance(state.film),
                      error.mean_luminance);
        for (const std::string& output : files.written())
            std::printf("%s: %d x %d pixels, %.7g samples per pixel, relative error %s, %s%s%s\n",
                        output.c_str(), image.width(), image.height(), error.mean_samples,
                        percent_text(error.relative).c_str(), duration_text(report.seconds).c_str(),
                        ending_text(report, target).c_str(), denoised.note.c_str());
        print_missing_error(error, renderer.sampler(), target);
        print_outliers(outliers_of(state.film));
        if (options.stats) {
            print_statistics(report, load_seconds, renderer.build_seconds());
            for (const EnvironmentSampler& map : renderer.scene().light_tables.environments)
                std::printf("environment        %s\n", map.description().c_str());
            for (const PortalSampler& map : renderer.scene().light_tables.portals)
                std::printf("environment        %s\n", map.description().c_str());
            shared.print_statistics();
        }
    }
    files.throw_failures();
    shared.end_job_if_failed(exit_interrupted);
    if (!denoised.failure.empty()) throw Error(denoised.failure);
    if (!checkpoint_failure.empty())
        throw Error("the last checkpoint was not written, the picture was", checkpoint_failure);
    if (report.cancelled()) return exit_interrupted;
    return target.error > 0 && report.stop != RenderStop::error ? exit_stopped : exit_done;
}

int run(const RenderOptions& options) {
    end_on_signals();
    // A closed pipe behind the messages must not end the render.
    std::signal(SIGPIPE, SIG_IGN);
    Communicator* const job = join_job(options.rank_timeout);
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

} // namespace

void add_render(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<RenderOptions>();
    CLI::App* command = app.add_subcommand("render", "Render a scene: every pixel with its standard error");
    declare(*command, *options);
    command->callback([options, &exit_code] { exit_code = run(*options); });
}

} // namespace montelux::app
