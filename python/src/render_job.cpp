#include "python/src/render_job.h"

#include <utility>

#include "montelux/mc/io/generation_file.h"
#include "montelux/render/checkpoint.h"
#include "montelux/render/render_header.h"

namespace montelux::python {

RenderJob::RenderJob(std::shared_ptr<const SceneDescription> description, RenderJobSettings settings)
    : description_(std::move(description)), settings_(std::move(settings)) {
    const std::filesystem::path& path = settings_.checkpoint;
    // Told before the render that it is missing, rather than after it.
    if (settings_.denoise) denoiser_.emplace(Denoiser::load(settings_.threads));
    if (settings_.resume && path.empty())
        throw Error("render", "resume was asked for without a checkpoint file to resume from");
    if (!path.empty() && !settings_.resume && generation_exists(path))
        throw Error(path.string(), "the file is there already; resume=True goes on from it, or remove it");
    if (settings_.resume && generation_exists(path)) {
        RestoredRender restored = load_checkpoint(path, *description_, settings_.target);
        refused_checkpoint_ = restored.newest_refused_because;
        // The replicates of a render that is gone on with are those of its beginning.
        auto with_replicates = std::make_shared<SceneDescription>(*description_);
        with_replicates->sampler.replicate_points = restored.replicate_points;
        description_ = std::move(with_replicates);
        state_.emplace(std::move(restored.state));
    } else {
        state_.emplace(description_->film);
    }
    with_threads(settings_.threads,
                 [&] { renderer_ = std::make_unique<Renderer>(*description_, settings_.target); });
    replicate_size_ = SampleOrder(renderer_->sampler(), settings_.target.slice).replicate_size();
    thread_ = std::thread([this] { run(); });
}

RenderJob::~RenderJob() {
    cancel();
    if (thread_.joinable()) thread_.join();
}

void RenderJob::run() {
    RenderControl control;
    control.cancel = &cancel_;
    control.snapshot = [this](const RenderState& state) { take_snapshot(state); };
    control.snapshot_wanted = &snapshot_wanted_;
    control.checkpoint_seconds = settings_.checkpoint_every;
    if (!settings_.checkpoint.empty()) control.checkpoint = [this](const RenderState& state) { save(state); };
    control.progress = [this](const RenderProgress& p) {
        std::lock_guard lock(mutex_);
        progress_ = p;
    };
    std::exception_ptr failure;
    std::optional<RenderSnapshot> result;
    try {
        with_threads(settings_.threads, [&] { renderer_->render(*state_, control); });
        const RenderReport report = state_->report;
        const std::shared_ptr<Image> image = developed(state_->film, report);
        if (denoiser_ && !report.cancelled()) denoise(*image);
        result = RenderSnapshot{image, state_->film.error(), report};
        state_.reset();
    } catch (...) {
        failure = std::current_exception();
    }
    std::lock_guard lock(mutex_);
    failure_ = failure;
    result_ = std::move(result);
    ended_ = true;
    changed_.notify_all();
}

void RenderJob::take_snapshot(const RenderState& state) {
    std::lock_guard lock(mutex_);
    seen_.emplace(state.film);
    seen_report_ = state.report;
    changed_.notify_all();
}

void RenderJob::save(const RenderState& state) {
    // A full disk must not cost the render.
    std::string failure;
    try {
        save_checkpoint(settings_.checkpoint, *renderer_, state);
    } catch (const std::exception& e) {
        failure = e.what();
    }
    std::lock_guard lock(mutex_);
    checkpoint_failure_ = failure;
}

std::string RenderJob::checkpoint_failure() const {
    std::lock_guard lock(mutex_);
    return checkpoint_failure_;
}

bool RenderJob::wait(double seconds) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, std::chrono::duration<double>(seconds), [this] { return ended_; });
}

RenderProgress RenderJob::progress() const {
    std::lock_guard lock(mutex_);
    return progress_;
}

std::optional<RenderSnapshot> RenderJob::snapshot(double seconds) {
    std::unique_lock lock(mutex_);
    if (ended_) return std::nullopt;
    snapshot_wanted_ = true;
    changed_.wait_for(lock, std::chrono::duration<double>(seconds), [this] { return ended_ || seen_; });
    if (!seen_) return std::nullopt;
    Film film = std::move(*seen_);
    seen_.reset();
    const RenderReport report = seen_report_;
    lock.unlock();
    film.end_replicates(replicate_size_);
    return RenderSnapshot{developed(film, report), film.error(), report};
}

std::shared_ptr<Image> RenderJob::developed(const Film& film, const RenderReport& report) const {
    auto image = std::make_shared<Image>(film.develop(settings_.target.slice.count > 1));
    add_render_header(*image, settings_.scene_name, *renderer_, report, film.error(),
                      clamped_luminance(film));
    return image;
}

void RenderJob::denoise(Image& image) {
    // A denoiser that fails must not cost the render.
    try {
        denoise_image(*denoiser_, image);
    } catch (const std::exception& e) {
        denoise_failure_ = e.what();
    }
}

RenderSnapshot RenderJob::result() const {
    std::lock_guard lock(mutex_);
    if (failure_) std::rethrow_exception(failure_);
    if (!result_) throw Error("render", "the render has not ended yet");
    return *result_;
}

} // namespace montelux::python
