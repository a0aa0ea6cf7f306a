#include "app/render/sequence.h"

#include "app/commands.h"
#include "app/interrupt.h"
#include "app/render/frame_list.h"
#include "app/render/frame_log.h"
#include "app/render/picture.h"
#include "app/render/requests.h"
#include "app/usage_error.h"
#include <bit>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "montelux/formats/load_scene.h"
#include "montelux/image/image_write.h"
#include "montelux/mc/random/hash.h"
#include "montelux/render/checkpoint.h"
#include "montelux/scene/light/light_tables.h"

namespace montelux::app {
namespace {

// Between 0 and the end of an animation, the steps at which its bounds are looked at.
constexpr int steps_of_bounds = 16;

void check_options(const RenderOptions& o, const SharedRender& shared) {
    const char* const option = o.turntable ? "--turntable" : "--frames";
    if (shared.is_job())
        throw UsageError(option,
                         "a sequence is rendered by one process; give each machine frames of its own");
    if (o.resume || !o.checkpoint.empty())
        throw UsageError(o.resume ? "--resume" : "--checkpoint",
                         "a sequence has no checkpoint: it skips frames that are finished");
    if (o.debug_sample)
        throw UsageError("--debug-sample", "it replays a sample of one picture, not of a sequence");
    if (o.scene_time && !o.turntable)
        throw UsageError("--time-of-scene", "the frames of --frames have times of their own");
    if (o.turntable && o.frames)
        for (const std::uint32_t frame : *o.frames)
            if (frame > *o.turntable)
                throw UsageError("--frames", "there is no frame " + std::to_string(frame) +
                                                 "; the turntable has " + std::to_string(*o.turntable));
}

// The scenes of frames.
class Frames {
  public:
    Frames(const RenderOptions& options, LoadNotices& notices) : options_(options), notices_(notices) {
        if (options_.turntable)
            turntable_.emplace(load(options_));
        else
            look_at_animation();
    }

    std::vector<std::uint32_t> numbers() const {
        if (options_.frames) return *options_.frames;
        std::vector<std::uint32_t> all;
        for (std::uint32_t frame = 1; frame <= *options_.turntable; ++frame) all.push_back(frame);
        return all;
    }

    std::shared_ptr<SceneDescription> scene(std::uint32_t frame) {
        if (!turntable_) {
            RenderOptions options = options_;
            options.scene_time = time(frame);
            return load(options).description;
        }
        // The frame before has been rendered, so nothing else reads the description.
        turntable_->description->scene.camera =
            turned_camera(turntable_->camera, turntable_->axis,
                          360.0 * (frame - 1) / static_cast<double>(*options_.turntable));
        return turntable_->description;
    }

    // Those of the last scene.
    const std::vector<std::filesystem::path>& files_read() const { return files_read_; }

  private:
    struct Loaded {
        std::shared_ptr<SceneDescription> description;
        CameraSettings camera;
        TurnAxis axis;
    };

    double time(std::uint32_t frame) const { return (frame - 1) / options_.frame_rate; }

    Loaded load(const RenderOptions& options) {
        Warnings warnings;
        files_read_.clear();
        RequestedScene requested = load_requested(options, warnings, nullptr, &files_read_);
        if (!options.quiet) notices_.print(options.scene, warnings, requested.added);
        CameraSettings camera = requested.description.scene.camera;
        return {std::make_shared<SceneDescription>(std::move(requested.description)), std::move(camera),
                requested.axis};
    }

    // Whether there is one, and what a studio is fitted to.
    void look_at_animation() {
        const auto at = [&](double time) {
            Warnings ignored;
            return load_scene(
                options_.scene, ignored,
                {.camera = options_.camera, .variant = options_.variant, .time = time, .pictures = false});
        };
        const SceneDescription first = at(0);
        if (!(first.animation_end > 0))
            throw UsageError("--frames", std::filesystem::path(options_.scene).filename().string() +
                                             " has no animation; --turntable N takes the camera around it");
        for (const std::uint32_t frame : *options_.frames)
            if (time(frame) > first.animation_end && !options_.quiet) {
                std::fprintf(
                    stderr,
                    "montelux: warning: the animation ends at %.7g s; frame %u and those behind it show "
                    "its end\n",
                    first.animation_end, frame);
                break;
            }
        const StudioSettings& studio = options_.studio;
        if (first.has_camera && !studio.orbit && !studio.ground.value_or(false)) return;
        Bounds3 bounds = bounds_of(first.scene);
        for (int i = 1; i <= steps_of_bounds; ++i) {
            const Bounds3 now = bounds_of(at(first.animation_end * i / steps_of_bounds).scene);
            if (now.empty()) continue;
            bounds.add(now.lower);
            bounds.add(now.upper);
        }
        options_.studio.bounds = bounds;
    }

    RenderOptions options_;
    LoadNotices& notices_;
    std::vector<std::filesystem::path> files_read_;
    std::optional<Loaded> turntable_; // empty: an animation
};

// Of everything that the files of a frame depend on.
std::uint64_t settings_of(const SceneDescription& description, const RenderTarget& target,
                          const RenderOptions& o) {
    std::uint64_t h = picture_fingerprint(description, target);
    const ToneOptions& t = o.tone;
    const bool transparent = o.studio.background && o.studio.background->transparent;
    for (const std::uint64_t value :
         {std::uint64_t{std::bit_cast<std::uint32_t>(t.exposure.value_or(1e30f))}, std::uint64_t{t.automatic},
          t.tone ? static_cast<std::uint64_t>(*t.tone) + 1 : 0,
          static_cast<std::uint64_t>(t.bits.value_or(0)), static_cast<std::uint64_t>(t.quality.value_or(0)),
          std::uint64_t{o.denoise}, std::uint64_t{transparent}})
        h = hash_key(h, value);
    return h;
}

} // namespace

int render_sequence(const RenderOptions& options, SharedRender& shared) {
    using Clock = std::chrono::steady_clock;
    check_options(options, shared);
    for (const std::string& output : options.outputs) check_writable(output);
    check(options.tone, options.outputs);
    target_of(options, IntegratorKind::path); // wrong options are refused before scenes are read
    LoadNotices notices;
    Frames frames(options, notices);
    std::optional<Denoiser> denoiser;
    if (options.denoise) denoiser.emplace(Denoiser::load(options.threads));

    const std::vector<std::uint32_t> numbers = frames.numbers();
    std::vector<std::uint32_t> skipped;
    std::optional<FrameLog> log;
    ToneOptions tone =
        options.tone; // with the exposure of the first frame, so that the sequence does not flicker
    int exit_code = exit_done;
    const CancelFlag& cancel = cancel_on_signals();
    std::size_t done = 0;
    for (; done < numbers.size() && !cancel.requested(); ++done) {
        const std::uint32_t number = numbers[done];
        const Clock::time_point begin = Clock::now();
        std::shared_ptr<SceneDescription> scene = frames.scene(number);
        const double load_seconds = std::chrono::duration<double>(Clock::now() - begin).count();
        const RenderTarget target = target_of(options, scene->integrator.method);
        const std::vector<std::string> outputs = outputs_of(options, *scene);
        if (!log) {
            check_requested(*scene, target, false);
            log.emplace(outputs.front());
        }
        std::vector<std::string> files;
        for (const std::string& output : outputs) files.push_back(frame_file(output, number));
        for (const std::string& file : files) check_picture_path(file, frames.files_read());
        const auto keep_exposure = [&](std::optional<float> exposure) {
            if (!exposure || tone.exposure) return;
            tone.exposure = exposure;
            tone.automatic = false;
        };
        const std::uint64_t settings = settings_of(*scene, target, options);
        if (const std::optional<FrameLog::Finished> finished = log->find(files, settings)) {
            keep_exposure(finished->exposure);
            skipped.push_back(number);
            continue;
        }
        const IntegratorKind integrator = scene->integrator.method; // each frame chooses for itself
        const PictureResult result =
            render_picture({.description = scene,
                            .target = target,
                            .outputs = files,
                            .tone = tone,
                            .load_seconds = load_seconds,
                            .is_frame = true,
                            .doing = "frame " + std::to_string(number) + " (" + std::to_string(done + 1) +
                                     " of " + std::to_string(numbers.size()) + ")"},
                           options, shared, denoiser);
        scene->integrator.method = integrator;
        std::fflush(stdout);
        if (result.exit_code == exit_interrupted) break;
        if (result.exit_code != exit_done) exit_code = result.exit_code;
        log->add(files, settings, result.exposure);
        keep_exposure(result.exposure);
        cancel_on_signals();
    }
    if (!options.quiet && !skipped.empty())
        std::printf("finished before and skipped: frames %s (%s)\n", frames_text(skipped).c_str(),
                    log->path().string().c_str());
    if (done == numbers.size()) return exit_code;
    if (!options.quiet)
        std::fprintf(stderr,
                     "montelux: interrupted: %zu of %zu frames are finished; the same command renders the "
                     "others\n",
                     done, numbers.size());
    return exit_interrupted;
}

} // namespace montelux::app
