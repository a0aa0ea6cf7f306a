#include "python/src/render_job.h"

#include <utility>

#include "montelux/mc/parallel/parallel_for.h"

namespace montelux::python {

RenderJob::RenderJob(std::shared_ptr<const SceneDescription> description, RenderSessionSettings settings,
                     int threads, bool denoise, bool view)
    : session_(std::move(description), std::move(settings)), threads_(threads) {
    // A missing denoiser is reported before the render.
    if (denoise) denoiser_.emplace(Denoiser::load(threads_));
    with_threads(threads_, [&] { session_.prepare(); });
    if (view) {
        ViewedRenderSettings viewed;
        viewed.cancel = &cancel_;
        viewed_.emplace(std::move(viewed));
        ViewServerSettings page;
        page.introduction.name = session_.settings().scene_name;
        page.introduction.spp = session_.description().sampler.spp;
        page.introduction.exposure = 0.0f;
        server_.emplace(*viewed_, page);
    }
    thread_ = std::thread([this] { run(); });
}

RenderJob::~RenderJob() {
    cancel();
    if (thread_.joinable()) thread_.join();
}

void RenderJob::run() {
    RenderCompany company;
    company.cancel = &cancel_;
    company.progress = [this](const RenderProgress& p) {
        std::lock_guard lock(mutex_);
        progress_ = p;
    };
    std::function<void(Image&)> denoise;
    if (denoiser_) denoise = [this](Image& image) { denoise_image(*denoiser_, image); };
    std::exception_ptr failure;
    std::optional<RenderSnapshot> result;
    try {
        with_threads(threads_, [&] {
            if (viewed_)
                viewed_->run(session_, company);
            else
                session_.render(company);
        });
        result = session_.finish(denoise);
        if (viewed_) viewed_->show(*result);
    } catch (...) {
        failure = std::current_exception();
    }
    std::lock_guard lock(mutex_);
    failure_ = failure;
    result_ = std::move(result);
    ended_ = true;
    changed_.notify_all();
}

bool RenderJob::wait(double seconds) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, std::chrono::duration<double>(seconds), [this] { return ended_; });
}

RenderProgress RenderJob::progress() const {
    std::lock_guard lock(mutex_);
    return progress_;
}

RenderSnapshot RenderJob::result() const {
    std::lock_guard lock(mutex_);
    if (failure_) std::rethrow_exception(failure_);
    if (!result_) throw Error("render", "the render has not ended yet");
    return *result_;
}

} // namespace montelux::python
