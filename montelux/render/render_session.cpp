#include "montelux/render/render_session.h"

#include <utility>

#include "montelux/mc/io/generation_file.h"
#include "montelux/mc/math/error.h"
#include "montelux/render/check_render.h"
#include "montelux/render/checkpoint.h"
#include "montelux/render/render_header.h"
#include "montelux/render/sample_allocation.h"
#include "montelux/render/sample_order.h"
#include "montelux/render/splat_pass.h"

namespace montelux {

bool decide_integrator(SceneDescription& description, RenderSessionSettings& settings,
                       const IntegratorChoiceSettings& choice) {
    if (description.integrator.method != IntegratorKind::automatic) return true;
    if (settings.resume && generation_exists(settings.checkpoint)) {
        description.integrator.method = integrator_of_checkpoint(settings.checkpoint, description);
    } else {
        settings.chosen = choose_integrator(description, choice);
        if (!settings.chosen) return false;
    }
    settings.target = choice.target(description.integrator.method);
    return true;
}

RenderSession::RenderSession(std::shared_ptr<const SceneDescription> description,
                             RenderSessionSettings settings)
    : description_(std::move(description)), settings_(std::move(settings)) {
    const std::filesystem::path& path = settings_.checkpoint;
    if (path.empty() && settings_.resume)
        throw Error("render", "resume was asked for without a checkpoint file to resume from");
    const bool exists = !path.empty() && generation_exists(path);
    if (exists && !settings_.resume)
        throw Error(path.string(), "the file exists; resume the render that it holds, or remove it");
    if (exists) {
        RestoredRender restored = load_checkpoint(path, *description_, settings_.target);
        refused_checkpoint_ = std::move(restored.newest_refused_because);
        replicate_points_ = restored.replicate_points;
        state_.emplace(std::move(restored.state));
        samples_before_ = state_->film.error().mean_samples;
    } else if (settings_.chosen) {
        state_.emplace(std::move(settings_.chosen->state));
        settings_.prepared = std::move(settings_.chosen->prepared);
    } else {
        state_.emplace(*description_);
    }
    settings_.chosen.reset(); // later sessions with these settings render anew
}

SamplerSettings RenderSession::sampler() const {
    return with_points(sampler_of(*description_), replicate_points_);
}

void RenderSession::prepare() {
    if (!renderer_)
        renderer_ = std::make_unique<Renderer>(*description_, settings_.target, replicate_points_,
                                               std::move(settings_.prepared));
}

void RenderSession::set_target(const RenderTarget& target) {
    if (renderer_) renderer_->set_target(target);
    settings_.target = target;
}

std::uint32_t RenderSession::replicate_size() const {
    return SampleOrder(renderer_->sampler(), settings_.target.slice).replicate_size();
}

void RenderSession::render(const RenderCompany& company) {
    prepare();
    RenderControl control;
    control.progress = company.progress;
    control.tile = company.tile;
    control.live = &live_;
    control.cancel = company.cancel;
    control.executor = company.executor;
    control.keep_open = company.keep_open;
    control.checkpoint_seconds = settings_.checkpoint_every;
    if (!settings_.checkpoint.empty())
        control.checkpoint = [&](const RenderState& state) { save(state, company); };
    renderer_->render(*state_, control);
}

void RenderSession::save(const RenderState& state, const RenderCompany& company) {
    // A full disk must not end the render.
    std::string failure;
    try {
        save_checkpoint(settings_.checkpoint, *renderer_, state);
    } catch (const std::exception& e) {
        failure = e.what();
        if (company.checkpoint_failed) company.checkpoint_failed(failure);
    }
    std::lock_guard lock(mutex_);
    checkpoint_failure_ = std::move(failure);
}

std::string RenderSession::checkpoint_failure() const {
    std::lock_guard lock(mutex_);
    return checkpoint_failure_;
}

RenderSnapshot RenderSession::finish(const std::function<void(Image&)>& denoise) {
    const RenderReport report = state_->report;
    end_replicates(state_->film); // of a render that was kept open
    RenderSnapshot result = picture_of(state_->film, report);
    result.outliers = outliers_of(state_->film);
    if (settings_.target.quantile > 0)
        result.quantile = {settings_.target.quantile,
                           error_quantile(state_->film, settings_.target.quantile)};
    if (!report.cancelled() && settings_.target.slice.count == 1)
        result.missing =
            missing_light(*description_, *renderer_->prepared(),
                          result.error.mean_samples * static_cast<double>(state_->film.pixels().size()),
                          state_->guide != nullptr);
    guide_ = state_->guide;
    state_.reset();
    if (denoise && !report.cancelled()) {
        try {
            denoise(*std::const_pointer_cast<Image>(result.image)); // not shared yet
        } catch (const std::exception& e) {
            result.denoise_failure = e.what();
        }
    }
    return result;
}

std::optional<RenderSnapshot> RenderSession::snapshot(double seconds) {
    std::optional<LiveCopy> now = live_.copy(seconds);
    if (!now) return std::nullopt;
    // A copy is made while samples are taken: the splats of its open pass are not known.
    if (traces_light(description_->integrator.method))
        drop_pass(now->film);
    else
        now->film.end_replicates(replicate_size());
    return picture_of(now->film, now->report);
}

RenderSnapshot RenderSession::picture() const {
    Film film = state_->film;
    end_replicates(film);
    return picture_of(film, state_->report);
}

void RenderSession::end_replicates(Film& film) const {
    if (state_->splats)
        end_pass(film, *state_->splats, replicate_size());
    else
        film.end_replicates(replicate_size());
}

RenderSnapshot RenderSession::picture_of(const Film& film, const RenderReport& report) const {
    auto image = std::make_shared<Image>(film.develop(settings_.target.slice.count > 1));
    const FilmError error = film.error();
    const double clamped = clamped_luminance(film);
    add_render_header(*image, settings_.scene_name, *renderer_, report, error, clamped);
    RenderSnapshot snapshot{std::move(image), error, report, clamped};
    snapshot.half = description_->film.layers.half;
    return snapshot;
}

} // namespace montelux
