// The loop over rounds, tiles, pixels and samples.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "montelux/accel/accelerator.h"
#include "montelux/film/film.h"
#include "montelux/render/render_control.h"
#include "montelux/render/render_state.h"
#include "montelux/render/render_target.h"
#include "montelux/scene/camera/camera.h"
#include "montelux/scene/render_settings.h"
#include "montelux/scene/scene_digest.h"
#include "montelux/scene/scene_tables.h"
#include "montelux/transport/ray_tracer.h"

namespace montelux {

struct SampleRecord;
class TileRenderer;

// Holds what is built once for a scene. The description must outlive it.
class Renderer {
  public:
    // Throws Error on settings that make no sense. Threads as the caller's ThreadLimit allows.
    // `replicate_points`, where not 0, are those of the render that is resumed.
    explicit Renderer(const SceneDescription& description, const RenderTarget& target = {},
                      std::uint32_t replicate_points = 0);

    const SceneDescription& description() const { return description_; }
    // Of the scene, as it was when the renderer was made.
    const SceneDigest& scene_digest() const { return scene_digest_; }
    const Accelerator& accelerator() const { return *accelerator_; }
    const Camera& camera() const { return camera_; }
    const SceneView& scene() const { return tables_->view(); }
    // As the description says, with the number of replicates decided.
    const SamplerSettings& sampler() const { return sampler_; }
    double build_seconds() const { return build_seconds_; }

    const RenderTarget& target() const { return target_; }

    // Goes on with a render, new or restored, until its target is reached or all samples are taken, and
    // closes the film. Unless time or the caller stopped it, what the film holds depends on description and
    // target alone: not on the number of threads, nor on when it was looked at, stopped, saved and restored.
    void render(RenderState& state, const RenderControl& control = {}) const;
    // A render from the start. The film must be new.
    RenderReport render(Film& film, const ProgressCallback& progress = {},
                        const CancelFlag* cancel = nullptr) const;

    // Takes samples for a render that another process leads: calls `work` with what renders its tiles.
    void serve(const std::function<void(const TileRenderer&)>& work) const;

    // Traces one sample of the render again and writes it down (sample_record.h). The record refers to the
    // renderer's scene and tables. Throws Error, as check_sample does, where the render takes no such sample.
    SampleRecord replay(int x, int y, std::uint64_t index) const;

  private:
    const SceneDescription& description_;
    RenderTarget target_;
    SamplerSettings sampler_;
    SceneDigest scene_digest_;
    double build_seconds_ = 0;
    std::unique_ptr<SceneTables> tables_;
    std::unique_ptr<Accelerator> accelerator_;
    Camera camera_;
};

} // namespace montelux
