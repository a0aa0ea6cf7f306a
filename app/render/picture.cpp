#include "app/render/picture.h"

#include "app/commands.h"
#include "app/denoised_output.h"
#include "app/interrupt.h"
#include "app/joined.h"
#include "app/output_files.h"
#include "app/picture_notices.h"
#include "app/render/advice.h"
#include "app/render/memory_text.h"
#include "app/render/progress.h"
#include "app/render/session_notices.h"
#include "app/view/render_view.h"
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <utility>

#include "montelux/denoise/oidn_api.h"
#include "montelux/image/half.h"
#include "montelux/image/image_write.h"
#include "montelux/image/visible_error.h"
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

// Why the render ended, unless by the number of samples.
std::string ending_text(const RenderReport& report, const RenderTarget& target, bool lacks_light) {
    switch (report.stop) {
    case RenderStop::cancelled:
        return ", stopped before the end";
    case RenderStop::error:
        return lacks_light ? ", target missed: light is missing" : ", target reached";
    case RenderStop::time:
        return target.error > 0 ? ", time is up before the target was reached" : ", time is up";
    default:
        return target.error > 0 ? ", samples are used up before the target was reached" : "";
    }
}

std::string quantile_text(const std::optional<ErrorQuantile>& quantile) {
    if (!quantile || !std::isfinite(quantile->error)) return "";
    return ", " + percent_text(quantile->share) + " of the pixels within " + percent_text(quantile->error);
}

// By the curve that shows the picture, or would show it.
std::optional<double> visible_error(const Image& image, const ToneOptions& tone, DefaultExposure by_default) {
    if (image.color_channels().empty()) return std::nullopt;
    const Image colors = image.select(std::vector<std::string>{"R", "G", "B"});
    return visible_error_share(image, tone_curve_of(tone, colors, by_default));
}

// Without samples by one integrator there is no picture.
int interrupted_pilot(bool is_frame, bool quiet) {
    if (!is_frame && !quiet)
        std::fprintf(stderr, "montelux: interrupted before the integrator was chosen: nothing is written\n");
    return exit_interrupted;
}

bool denoiser_is_installed() {
    try {
        load_oidn();
        return true;
    } catch (const Error&) {
        return false;
    }
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
    RenderSessionSettings settings{task.target, std::filesystem::path(options.scene).filename().string(),
                                   options.checkpoint, options.checkpoint_every, options.resume};
    if (!decide_integrator(*task.description, settings,
                           {.target = [&](IntegratorKind kind) { return target_of(options, kind); },
                            .cancel = &cancel_on_signals()}))
        return {.exit_code = interrupted_pilot(task.is_frame, options.quiet)};
    const RenderTarget target = settings.target;
    if (settings.chosen && !options.quiet) print_choice(*settings.chosen);
    auto session = std::make_unique<RenderSession>(task.description, std::move(settings));
    print_resume_notices(*session, options.quiet);
    const SamplerSettings sampler = session->sampler();
    check_slice_option(sampler, target);
    RenderCompany company;
    company.executor = shared.begin(session->description(), sampler, target);
    const DefaultExposure by_default = default_exposure(task.description->film);
    std::optional<RenderView> view;
    if (options.view.any())
        view.emplace(options,
                     ToneCurve{task.tone.exposure.value_or(0), task.tone.tone.value_or(ToneKind::srgb)},
                     *task.description, session);
    session->prepare();
    const PixelBounds crop = task.description->film.crop;
    ProgressPrinter printer(options.quiet, task.doing);
    company.progress = [&](const RenderProgress& p) { printer.update(p); };
    company.cancel = &cancel_on_signals();
    // The render continues, and reports it at the end, too.
    company.checkpoint_failed = [](const std::string& reason) {
        std::fprintf(stderr, "\nmontelux: warning: %s; the render continues without this checkpoint\n",
                     reason.c_str());
    };
    if (view)
        view->render(company);
    else
        session->render(company);
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
    const RenderSnapshot result = session->finish(denoise);
    if (view) view->show(result);
    const RenderReport& report = result.report;
    const bool lacks_light = result.missing && result.missing->matters(target.error);
    PictureResult done;
    if (report.cancelled() && task.is_frame) {
        done.exit_code = exit_interrupted;
        return done;
    }
    OutputFiles files;
    for (const std::string& output : task.outputs)
        files.write(output, [&] {
            const std::optional<float> exposure =
                write_output(output, result, options, task.tone, by_default);
            if (!done.exposure) done.exposure = exposure;
        });
    if (!options.quiet) {
        const std::optional<double> visible = visible_error(*result.image, task.tone, by_default);
        if (session->resumed() && result.error.mean_samples == session->samples_before())
            print_nothing_left(*session, report);
        print_bad_samples(report.bad, sampler.seed,
                          !sampler.chains && !session->description().integrator.manifold_sampling);
        print_clamped(static_cast<double>(report.clamped_samples), result.clamped_luminance,
                      result.error.mean_luminance);
        if (!files.written().empty())
            std::printf("%s: %d x %d pixels, %.7g samples per pixel, relative error %s%s%s, %s%s%s\n",
                        joined(files.written()).c_str(), crop.width(), crop.height(),
                        result.error.mean_samples, percent_text(result.error.relative).c_str(),
                        quantile_text(result.quantile).c_str(), visible_text(visible).c_str(),
                        duration_text(report.seconds).c_str(),
                        ending_text(report, target, lacks_light).c_str(), denoised.c_str());
        if (const std::string notice = merging_notice(result, target); !notice.empty())
            std::printf("%s\n", notice.c_str());
        if (const std::string warning = merging_warning(report.merging); !warning.empty())
            std::fprintf(stderr, "montelux: warning: %s\n", warning.c_str());
        if (const std::string warning = manifold_warning(session->renderer()); !warning.empty())
            std::fprintf(stderr, "montelux: warning: %s\n", warning.c_str());
        if (const std::string warning = chain_warning(report.chains); !warning.empty())
            std::fprintf(stderr, "montelux: warning: %s\n", warning.c_str());
        if (const std::string warning = missing_error_warning(result, session->renderer()); !warning.empty())
            std::fprintf(stderr, "montelux: warning: %s\n", warning.c_str());
        if (const std::string warning = missing_light_warning(result, target, session->description());
            !warning.empty())
            std::fprintf(stderr, "montelux: warning: %s\n", warning.c_str());
        if (const std::string warning =
                black_warning(*result.image, result.error.mean_samples, session->description().scene);
            !warning.empty())
            std::fprintf(stderr, "montelux: warning: %s\n", warning.c_str());
        if (!task.is_frame) {
            print_outliers(*result.outliers);
            const std::string advice = advice_text({.target = target,
                                                    .report = report,
                                                    .error = result.error,
                                                    .outliers = *result.outliers,
                                                    .visible = visible,
                                                    .has_checkpoint = !options.checkpoint.empty(),
                                                    .can_denoise = !denoiser && denoiser_is_installed()});
            if (!advice.empty()) std::printf("%s\n", advice.c_str());
        }
        if (options.stats) {
            print_statistics(report, *result.outliers, task.load_seconds, session->renderer());
            shared.print_statistics();
        }
        if (options.memory)
            std::fputs(memory_text(session->renderer().memory_use(), peak_memory()).c_str(), stdout);
    }
    files.throw_failures();
    shared.end_job_if_failed(exit_interrupted);
    if (!result.denoise_failure.empty()) throw Error(result.denoise_failure);
    if (const std::string failure = session->checkpoint_failure(); !failure.empty())
        throw Error("the last checkpoint was not written, the picture was", failure);
    const bool quit_by_page = options.view.stays && !company.cancel->requested();
    if (report.cancelled() && !quit_by_page)
        done.exit_code = exit_interrupted;
    else if (target.error > 0 && (report.stop != RenderStop::error || lacks_light))
        done.exit_code = exit_stopped;
    return done;
}

} // namespace montelux::app
