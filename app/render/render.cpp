// montelux render: from a scene file to a picture with error bars.
#include "app/cluster_job.h"
#include "app/commands.h"
#include "app/denoised_output.h"
#include "app/interrupt.h"
#include "app/output_files.h"
#include "app/picture_notices.h"
#include "app/render/cluster_render.h"
#include "app/render/memory_text.h"
#include "app/render/progress.h"
#include "app/render/render_options.h"
#include "app/render/sample_record_text.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <unistd.h>

#include "montelux/image/image_write.h"
#include "montelux/mc/io/file.h"
#include "montelux/mc/io/generation_file.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/render/checkpoint.h"
#include "montelux/render/render_session.h"
#include "montelux/render/render_warnings.h"
#include "montelux/render/sample_allocation.h"

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
    // The file's own name, in the current folder, always as EXR, the only format with all layers.
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

bool has_extension(const std::filesystem::path& path, std::string_view wanted) {
    std::string extension = path.extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return extension == wanted;
}

// PNG files hold colours that are not yet multiplied by alpha, as EXR's are.
Image with_straight_alpha(const Image& colors, const Image& layers) {
    Image picture(colors.width(), colors.height(), {"R", "G", "B", "A"});
    const int alpha = *layers.find_channel("A");
    std::span<float> out = picture.f32();
    std::size_t i = 0;
    for (int y = 0; y < colors.height(); ++y)
        for (int x = 0; x < colors.width(); ++x) {
            const float a = std::clamp(layers.value(x, y, alpha), 0.0f, 1.0f);
            for (int c = 0; c < 3; ++c) out[i++] = a > 0 ? colors.value(x, y, c) / a : 0.0f;
            out[i++] = a;
        }
    return picture;
}

// Without this check the kernel would kill a process for memory, seconds or hours later.
void check_memory(const FilmSettings& film, const FilmLayers& layers, bool with_checkpoints) {
    auto pages = static_cast<double>(sysconf(_SC_PHYS_PAGES));
    double there = pages * static_cast<double>(sysconf(_SC_PAGESIZE));
    constexpr double copies = 2; // the picture, and its encoding
    const auto channels =
        static_cast<double>(layers.channels().size() + 6); // with those of slices and denoising
    double pixels = static_cast<double>(film.crop.width()) * film.crop.height();
    const double buckets = film.spectral ? film.spectral->buckets : 0;
    double needed =
        pixels * buckets * ((with_checkpoints ? 2 : 1) * sizeof(BucketMoments) + 2 * copies * sizeof(float));
    needed += pixels * ((with_checkpoints ? 2 : 1) * (sizeof(Pixel) + sizeof(std::uint32_t) +
                                                      static_cast<double>(sizeof(double) * layers.sums())) +
                        channels * copies * sizeof(float));
    if (pages <= 0 || needed <= there) return;
    constexpr double gib = 1 << 30;
    char text[160];
    std::snprintf(text, sizeof text, "%d x %d pixels need %.1f GiB of memory; this machine has %.1f GiB",
                  film.crop.width(), film.crop.height(), needed / gib, there / gib);
    throw Error("film", text);
}

// A film whose sensor is set chooses the exposure of its pictures.
DefaultExposure default_exposure(const FilmSettings& film) {
    const FilmSettings unset;
    const bool is_set = film.iso != unset.iso || film.exposure_time != unset.exposure_time;
    return is_set ? DefaultExposure::zero : DefaultExposure::suitable;
}

// Layers that only EXR keeps do not change what other formats show.
// Alpha goes into PNG files where the background is transparent.
void write_output(const std::string& output, const RenderSnapshot& result, const RenderOptions& options,
                  DefaultExposure by_default) {
    const Image& image = *result.image;
    if (has_extension(output, ".exr")) {
        WriteOptions writing;
        if (result.half) writing.exr_half = half_channels_of(image.channel_names());
        const std::uint64_t beyond = half_overflows(image, writing.exr_half);
        if (beyond > 0 && !options.quiet)
            std::fprintf(stderr,
                         "montelux: warning: %s: %llu values beyond the range of 16-bit floats became %g\n",
                         output.c_str(), static_cast<unsigned long long>(beyond), double(largest_half));
        return write_picture(output, image, writing);
    }
    const bool denoised = image.find_channel("denoised.R").has_value();
    Image shown = denoised ? denoised_picture(image) : image.select(std::vector<std::string>{"R", "G", "B"});
    const bool transparent = options.studio.background && options.studio.background->transparent;
    if (transparent && has_extension(output, ".png") && image.find_channel("A"))
        shown = with_straight_alpha(shown, image);
    write_image(output, shown, tone_of(options.tone, output, shown, by_default, options.quiet));
}

void print_warnings(const Warnings& warnings) {
    for (const std::string& w : warnings.messages())
        std::fprintf(stderr, "montelux: warning: %s\n", w.c_str());
    if (warnings.left_out() > 0)
        std::fprintf(stderr, "montelux: warning: %zu more warnings were left out\n", warnings.left_out());
}

void print_studio(const std::string& scene, const StudioParts& added) {
    if (!added.camera && !added.lights) return;
    std::fprintf(stderr,
                 "montelux: %s has no %s: a studio was added (--environment, --orbit, --ground, --background "
                 "change it)\n",
                 std::filesystem::path(scene).filename().c_str(),
                 added.camera && added.lights ? "camera and no lights"
                 : added.camera               ? "camera"
                                              : "lights");
}

void print_bad_samples(const BadSampleReport& bad, std::uint64_t seed) {
    if (bad.count() == 0) return;
    std::fprintf(stderr, "montelux: warning: %s; to see its path, add --debug-sample %d,%d,%llu\n",
                 bad_sample_warning(bad, seed).c_str(), bad.first->x, bad.first->y,
                 static_cast<unsigned long long>(bad.first->sample));
}

// Why the render ended, unless by the number of samples.
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
    auto samples = static_cast<double>(report.samples), rays = static_cast<double>(report.rays.rays());
    std::printf("load               %.3f s\n", load_seconds);
    std::printf("build              %.3f s\n", build_seconds);
    std::printf("render             %.3f s, %.3f s of CPU\n", report.seconds, report.cpu_seconds);
    std::printf("samples            %ssamples/s, %.3f us of CPU each\n",
                count_text(samples / report.seconds).c_str(), 1e6 * report.cpu_seconds / samples);
    std::printf(
        "rays               %srays/s, %srays/s of CPU, %.2f per sample (%.2f closest hit, %.2f occlusion)\n",
        count_text(rays / report.seconds).c_str(), count_text(rays / report.cpu_seconds).c_str(),
        rays / samples, static_cast<double>(report.rays.closest) / samples,
        static_cast<double>(report.rays.occlusion) / samples);
    std::printf("inside Embree      %.1f %% of the CPU time\n",
                100 * report.ray_seconds / report.cpu_seconds);
    std::printf("peak memory        %.1f MiB\n", static_cast<double>(peak_memory()) / (1 << 20));
}

void check_slice_option(const SamplerSettings& sampler, const RenderTarget& target) {
    try {
        check_slice(sampler, target);
    } catch (const Error& e) {
        throw UsageError("--slice", e.what());
    }
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
    check_slice_option(with_points(description.sampler, replicate_points), target);
    const Renderer renderer(description, target, replicate_points);
    std::fputs(sample_record_text(renderer.replay(s.x, s.y, s.index), description).c_str(), stdout);
    return exit_done;
}

void print_resume_notices(const RenderSession& session, bool quiet) {
    const std::string file = session.settings().checkpoint.string();
    if (!session.refused_checkpoint().empty())
        std::fprintf(stderr, "montelux: warning: resuming from the checkpoint before the last: %s\n",
                     session.refused_checkpoint().c_str());
    if (quiet) return;
    if (session.settings().resume && !session.resumed())
        std::fprintf(stderr, "montelux: %s is not there yet: rendering from the start\n", file.c_str());
    const std::uint32_t spp = session.description().sampler.spp;
    if (session.settings().target.slice.count == 1 && session.samples_before() > spp)
        std::fprintf(stderr, "montelux: %s has %.7g samples per pixel already, more than the requested %u\n",
                     file.c_str(), session.samples_before(), spp);
}

int load_and_render(const RenderOptions& options, SharedRender& shared) {
    using Clock = std::chrono::steady_clock;
    for (const std::string& output : options.outputs) check_writable(output);
    check(options.tone, options.outputs);

    auto load_begin = Clock::now();
    Warnings warnings;
    std::vector<std::filesystem::path> files_read;
    auto [description, added] = load_requested(options, warnings, shared.files(), &files_read);
    double load_seconds = seconds_since(load_begin);
    if (!options.quiet) {
        print_warnings(warnings);
        print_studio(options.scene, added);
    }
    const RenderTarget target = target_of(options);
    if (options.debug_sample) return replay(options, description, target);
    const std::vector<std::string> outputs = outputs_of(options, description);
    for (const std::string& output : outputs) check_picture_path(output, files_read);
    if (!options.checkpoint.empty()) check_checkpoint(options, outputs, files_read);
    if (target.slice.count > 1 && description.film.layers.set != LayerSet::standard())
        throw UsageError("--slice", "slices are joined by their standard layers; add --layers default");
    check_memory(description.film, film_layers_of(description), !options.checkpoint.empty());
    std::optional<Denoiser> denoiser; // if it is missing, the error comes before the render
    if (options.denoise) denoiser.emplace(Denoiser::load(options.threads));

    RenderSession session(std::make_shared<const SceneDescription>(std::move(description)),
                          {target, std::filesystem::path(options.scene).filename().string(),
                           options.checkpoint, options.checkpoint_every, options.resume});
    print_resume_notices(session, options.quiet);
    const SamplerSettings sampler = session.sampler();
    check_slice_option(sampler, target);
    RenderCompany company;
    company.executor = shared.begin(session.description(), sampler, target);
    session.prepare();
    const PixelBounds& crop = session.description().film.crop;
    ProgressPrinter printer(options.quiet, target.quantile > 0 ? 0 : target.error,
                            static_cast<double>(crop.width()) * crop.height() * sampler.spp);
    company.progress = [&](const RenderProgress& p) { printer.update(p); };
    company.cancel = &cancel_on_signals();
    // The render continues, and reports it at the end, too.
    company.checkpoint_failed = [](const std::string& reason) {
        std::fprintf(stderr, "\nmontelux: warning: %s; the render continues without this checkpoint\n",
                     reason.c_str());
    };
    session.render(company);
    printer.finish();
    shared.end();
    finish_on_signals();
    std::string denoised = denoiser ? ", not denoised ('montelux denoise' can do it)" : "";
    std::function<void(Image&)> denoise;
    if (denoiser)
        denoise = [&](Image& image) {
            denoised = ", not denoised";
            denoised = ", " + describe(*denoiser, denoise_image(*denoiser, image), options.quiet);
        };
    const RenderSnapshot result = session.finish(denoise);
    const RenderReport& report = result.report;
    const DefaultExposure by_default = default_exposure(session.description().film);
    OutputFiles files;
    for (const std::string& output : outputs)
        files.write(output, [&] { write_output(output, result, options, by_default); });
    if (!options.quiet) {
        print_bad_samples(report.bad, sampler.seed);
        print_clamped(static_cast<double>(report.clamped_samples), result.clamped_luminance,
                      result.error.mean_luminance);
        for (const std::string& output : files.written())
            std::printf("%s: %d x %d pixels, %.7g samples per pixel, relative error %s, %s%s%s\n",
                        output.c_str(), crop.width(), crop.height(), result.error.mean_samples,
                        percent_text(result.error.relative).c_str(), duration_text(report.seconds).c_str(),
                        ending_text(report, target).c_str(), denoised.c_str());
        if (const std::string warning = missing_error_warning(result, session.renderer()); !warning.empty())
            std::fprintf(stderr, "montelux: warning: %s\n", warning.c_str());
        print_outliers(*result.outliers);
        if (options.stats) {
            print_statistics(report, load_seconds, session.renderer().build_seconds());
            for (const EnvironmentSampler& map : session.renderer().scene().light_tables.environments)
                std::printf("environment        %s\n", map.description().c_str());
            for (const PortalSampler& map : session.renderer().scene().light_tables.portals)
                std::printf("environment        %s\n", map.description().c_str());
            shared.print_statistics();
        }
        if (options.memory)
            std::fputs(memory_text(session.renderer().memory_use(), peak_memory()).c_str(), stdout);
    }
    files.throw_failures();
    shared.end_job_if_failed(exit_interrupted);
    if (!result.denoise_failure.empty()) throw Error(result.denoise_failure);
    if (const std::string failure = session.checkpoint_failure(); !failure.empty())
        throw Error("the last checkpoint was not written, the picture was", failure);
    if (report.cancelled()) return exit_interrupted;
    return target.error > 0 && report.stop != RenderStop::error ? exit_stopped : exit_done;
}

int run(const RenderOptions& options) {
    end_on_signals();
    // A closed pipe of messages must not end the render.
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
