#include "app/render/picture.h"

#include "app/commands.h"
#include "app/denoised_output.h"
#include "app/interrupt.h"
#include "app/output_files.h"
#include "app/picture_notices.h"
#include "app/render/memory_text.h"
#include "app/render/progress.h"
#include <algorithm>
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <span>
#include <string_view>
#include <utility>

#include "montelux/image/image_write.h"
#include "montelux/render/render_session.h"
#include "montelux/render/render_warnings.h"
#include "montelux/render/sample_allocation.h"

namespace montelux::app {

namespace {

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

// A film whose sensor is set chooses the exposure of its pictures.
DefaultExposure default_exposure(const FilmSettings& film) {
    const FilmSettings unset;
    const bool is_set = film.iso != unset.iso || film.exposure_time != unset.exposure_time;
    return is_set ? DefaultExposure::zero : DefaultExposure::suitable;
}

// Layers that only EXR keeps do not change what other formats show.
// Alpha goes into PNG files where the background is transparent.
// Returns the exposure, where the file has one.
std::optional<float> write_output(const std::string& output, const RenderSnapshot& result,
                                  const RenderOptions& options, const ToneOptions& tone,
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
        write_picture(output, image, writing);
        return std::nullopt;
    }
    const bool denoised = image.find_channel("denoised.R").has_value();
    Image shown = denoised ? denoised_picture(image) : image.select(std::vector<std::string>{"R", "G", "B"});
    const bool transparent = options.studio.background && options.studio.background->transparent;
    if (transparent && has_extension(output, ".png") && image.find_channel("A"))
        shown = with_straight_alpha(shown, image);
    const WriteOptions writing = tone_of(tone, output, shown, by_default, options.quiet);
    write_image(output, shown, writing);
    if (!takes_tone_curve(output)) return std::nullopt;
    return writing.tone.exposure;
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

} // namespace

void check_slice_option(const SamplerSettings& sampler, const RenderTarget& target) {
    try {
        check_slice(sampler, target);
    } catch (const Error& e) {
        throw UsageError("--slice", e.what());
    }
}

PictureResult render_picture(const PictureTask& task, const RenderOptions& options, SharedRender& shared,
                             const std::optional<Denoiser>& denoiser) {
    const RenderTarget& target = task.target;
    RenderSession session(task.description, {target, std::filesystem::path(options.scene).filename().string(),
                                             options.checkpoint, options.checkpoint_every, options.resume});
    print_resume_notices(session, options.quiet);
    const SamplerSettings sampler = session.sampler();
    check_slice_option(sampler, target);
    RenderCompany company;
    company.executor = shared.begin(session.description(), sampler, target);
    session.prepare();
    const PixelBounds& crop = session.description().film.crop;
    ProgressPrinter printer(options.quiet, target.quantile > 0 ? 0 : target.error,
                            static_cast<double>(crop.width()) * crop.height() * sampler.spp, task.doing);
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
    // The signal ends a sequence after this frame.
    if (task.is_frame)
        follow_on_signals();
    else
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
    PictureResult done;
    if (report.cancelled() && task.is_frame) {
        done.exit_code = exit_interrupted;
        return done;
    }
    const DefaultExposure by_default = default_exposure(session.description().film);
    OutputFiles files;
    for (const std::string& output : task.outputs)
        files.write(output, [&] {
            const std::optional<float> exposure =
                write_output(output, result, options, task.tone, by_default);
            if (!done.exposure) done.exposure = exposure;
        });
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
        if (!task.is_frame) print_outliers(*result.outliers);
        if (options.stats) {
            print_statistics(report, task.load_seconds, session.renderer().build_seconds());
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
    if (report.cancelled())
        done.exit_code = exit_interrupted;
    else if (target.error > 0 && report.stop != RenderStop::error)
        done.exit_code = exit_stopped;
    return done;
}

} // namespace montelux::app
