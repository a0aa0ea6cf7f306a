// RenderSession: one render from its settings to its picture, with checkpoints, snapshots and header.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "montelux/film/film_error.h"
#include "montelux/image/image.h"
#include "montelux/render/integrator_choice.h"
#include "montelux/render/live_film.h"
#include "montelux/render/missing_light.h"
#include "montelux/render/render_control.h"
#include "montelux/render/renderer.h"

namespace montelux {

struct RenderSessionSettings {
    RenderTarget target{};
    std::string scene_name{};           // for the header of the picture
    std::filesystem::path checkpoint{}; // empty: none
    double checkpoint_every = 60;       // seconds
    bool resume = false;                // from the checkpoint, if it exists
    // Of an earlier session with the same scene (Renderer); null: built by this one.
    std::shared_ptr<const PreparedScene> prepared{};
    // Of a description whose integrator was chosen by a pilot: the render begins with its samples.
    std::shared_ptr<ChosenIntegrator> chosen{};
};

// Sets the integrator of a description for which it is automatic, and the target of the settings: that of the
// checkpoint to be resumed, or one that a pilot chooses. Returns false, and sets nothing, if it was cancelled.
bool decide_integrator(SceneDescription& description, RenderSessionSettings& settings,
                       const IntegratorChoiceSettings& choice);

// The picture of a render at some moment.
struct RenderSnapshot {
    std::shared_ptr<const Image> image; // the layers of Film::develop() with the header of a render
    FilmError error;
    RenderReport report;
    double clamped_luminance = 0; // mean over pixels, removed by the film's limit
    // Of the finished picture.
    std::optional<OutlierReport> outliers{};
    std::optional<ErrorQuantile> quantile{}; // with a target quantile
    std::optional<MissingLight> missing{};   // of a finished render by path tracing
    std::string denoise_failure{};           // why requested denoising failed
    bool half = false; // an EXR file of it holds 16-bit floats where those suffice (half_channels_of)
};

// The callbacks, cancel flag and executor of a render.
struct RenderCompany {
    ProgressCallback progress{};
    std::function<void(const FinishedTile&)> tile{}; // RenderControl::tile
    const CancelFlag* cancel = nullptr;
    RoundExecutor* executor = nullptr;
    bool keep_open = false; // RenderControl::keep_open
    // A checkpoint could not be written; the render continues without it.
    std::function<void(const std::string& reason)> checkpoint_failed{};
};

// Common to the program and the Python package. Uses threads as the caller's ThreadLimit allows.
class RenderSession {
  public:
    // Starts a render, or resumes it from the checkpoint. The description must not change while the session lives. Throws
    // Error for invalid settings, for a checkpoint of another render (load_checkpoint), and for an existing
    // checkpoint without `resume`.
    RenderSession(std::shared_ptr<const SceneDescription> description, RenderSessionSettings settings);

    const SceneDescription& description() const { return *description_; }
    const std::shared_ptr<const SceneDescription>& shared_description() const { return description_; }
    const RenderSessionSettings& settings() const { return settings_; }
    // The description's, with the replicates of the resumed render.
    SamplerSettings sampler() const;
    bool resumed() const { return replicate_points_ != 0; }
    // Mean samples per pixel of the checkpoint.
    double samples_before() const { return samples_before_; }
    // Why the newest checkpoint was not resumed but the previous one; empty if it was.
    const std::string& refused_checkpoint() const { return refused_checkpoint_; }

    // Builds the scene's tables; render() does so if this was not called.
    void prepare();
    // Valid after prepare().
    const Renderer& renderer() const { return *renderer_; }

    // Takes samples until the target is reached, all are taken, or the render is cancelled. Call once, and again to
    // continue a render that was kept open.
    void render(const RenderCompany& company = {});
    // Between calls of render: Renderer::set_target.
    void set_target(const RenderTarget& target);
    // Between calls of render, after the first one: the picture so far. Changes no bit of the result.
    RenderSnapshot picture() const;
    const RenderReport& report() const { return state_->report; }
    // Samples per replicate of the picture. Valid after prepare().
    std::uint32_t replicate_size() const;
    // The finished picture, after render(). `denoise` adds layers to it, unless the render was cancelled; if
    // it throws, only these layers are lost. Frees the film's memory.
    RenderSnapshot finish(const std::function<void(Image&)>& denoise = {});
    // After finish(): what paths of the render followed, or null.
    const std::shared_ptr<const GuidingField>& guide() const { return guide_; }

    // The current picture, from any thread while render() runs in another. Pauses nothing, writes no
    // checkpoint, and changes no bit of the result. Waits at most `seconds`; empty if LiveFilm gives no copy.
    // Must not be called from the callbacks of the render.
    std::optional<RenderSnapshot> snapshot(double seconds);

    // Why the last checkpoint was not written; empty if it was. From any thread.
    std::string checkpoint_failure() const;

  private:
    // Of a picture that gets no more samples.
    void end_replicates(Film& film) const;
    RenderSnapshot picture_of(const Film& film, const RenderReport& report) const;
    void save(const RenderState& state, const RenderCompany& company);

    std::shared_ptr<const SceneDescription> description_;
    RenderSessionSettings settings_;
    std::optional<RenderState> state_;
    std::uint32_t replicate_points_ = 0;
    double samples_before_ = 0;
    std::string refused_checkpoint_;
    std::unique_ptr<Renderer> renderer_;
    std::shared_ptr<const GuidingField> guide_;
    LiveFilm live_;
    mutable std::mutex mutex_; // of the next member
    std::string checkpoint_failure_;
};

} // namespace montelux
