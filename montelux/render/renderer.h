// Renderer: the loop over rounds, tiles, pixels and samples.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "montelux/film/film.h"
#include "montelux/render/prepared_scene.h"
#include "montelux/render/render_control.h"
#include "montelux/render/render_state.h"
#include "montelux/render/render_target.h"
#include "montelux/scene/camera/camera.h"
#include "montelux/scene/memory_use.h"
#include "montelux/scene/render_settings.h"
#include "montelux/scene/scene_digest.h"
#include "montelux/transport/ray_tracer.h"

namespace montelux {

class ChainRenderer;
class SampleContext;
struct SampleRecord;
class TileRenderer;

// What takes the samples of a render.
struct SampleTakers {
    SampleContext& context; // of the tiles
    const TileRenderer& tiles;
    ChainRenderer* chains = nullptr; // take them in place of tiles, if not null
};

// The description must outlive it.
class Renderer {
  public:
    // Throws Error on invalid settings. Uses threads as the caller's ThreadLimit allows. `replicate_points`,
    // if not 0, are those of the resumed render. `prepared`: by an earlier renderer of the same scene, where only film,
    // samples and the place of the camera have changed since; null: made here.
    explicit Renderer(const SceneDescription& description, const RenderTarget& target = {},
                      std::uint32_t replicate_points = 0,
                      std::shared_ptr<const PreparedScene> prepared = nullptr);

    const SceneDescription& description() const { return description_; }
    // Digest of the scene when the renderer was made.
    const SceneDigest& scene_digest() const { return scene_digest_; }
    const std::shared_ptr<const PreparedScene>& prepared() const { return prepared_; }
    const Accelerator& accelerator() const { return prepared_->accelerator(); }
    const Camera& camera() const { return camera_; }
    const SceneView& scene() const { return prepared_->view(); }
    // The description's, with the number of replicates decided.
    const SamplerSettings& sampler() const { return sampler_; }
    double build_seconds() const { return prepared_->build_seconds(); }
    // Of the scene, its tables, the ray tracer and a film, by kind.
    std::vector<MemoryUse> memory_use() const;

    const RenderTarget& target() const { return target_; }
    // Between runs of a render that was left open: other limits, of error and time. Throws Error if allocation or slice
    // differ, on which the samples depend.
    void set_target(const RenderTarget& target);

    // Continues a render, new or restored, until its target is reached or all samples are taken, and closes
    // the film. Unless time or the caller stops it, the film depends on description and target only: not on
    // the number of threads, snapshots, interruptions or checkpoints.
    void render(RenderState& state, const RenderControl& control = {}) const;
    // A render from the start. The film must be new.
    RenderReport render(Film& film, const ProgressCallback& progress = {},
                        const CancelFlag* cancel = nullptr) const;

    // Takes samples for a render led by another process: calls `work` with what takes them.
    void serve(const std::function<void(const SampleTakers&)>& work) const;

    // Replays one sample of the render (sample_record.h). The record refers to the renderer's scene and
    // tables. Throws Error, as check_sample does, if the render does not take this sample.
    SampleRecord replay(int x, int y, std::uint64_t index) const;

  private:
    const SceneDescription& description_;
    RenderTarget target_;
    SamplerSettings sampler_;
    SceneDigest scene_digest_;
    std::shared_ptr<const PreparedScene> prepared_;
    Camera camera_;
};

} // namespace montelux
