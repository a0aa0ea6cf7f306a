// The loop over passes, tiles, pixels and samples.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "montelux/accel/accelerator.h"
#include "montelux/film/film.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/scene/camera/camera.h"
#include "montelux/scene/render_settings.h"
#include "montelux/scene/scene_tables.h"
#include "montelux/transport/ray_tracer.h"

namespace montelux {

struct RenderProgress {
    std::uint64_t samples_done = 0, samples_total = 0;
    double seconds = 0;
    // After each whole pass.
    std::optional<FilmError> error;
};

// Called from one thread at a time, several times a second.
using ProgressCallback = std::function<void(const RenderProgress&)>;

struct BadSampleReport {
    std::uint64_t nan = 0, infinite = 0, negative = 0;
    std::optional<BadSample> first; // the one of lowest sample index, then row, then column

    std::uint64_t count() const { return nan + infinite + negative; }
    void add(const BadSample& bad);
    void merge(const BadSampleReport& other);
};

struct RenderReport {
    std::uint64_t samples = 0;
    double seconds = 0;     // of the loop, wall clock
    double cpu_seconds = 0; // of the loop, CPU time summed over threads
    double ray_seconds = 0; // of those, spent in Embree (extrapolated from timed rays)
    RayStatistics rays;
    BadSampleReport bad;
    bool cancelled = false;
};

struct SampleRecord;

// Holds what is built once for a scene. The description must outlive it.
class Renderer {
  public:
    // Throws Error on settings that make no sense. Threads as the caller's ThreadLimit allows.
    explicit Renderer(const SceneDescription& description);

    const Accelerator& accelerator() const { return *accelerator_; }
    const Camera& camera() const { return camera_; }
    // As the description says, with the number of replicates decided.
    const SamplerSettings& sampler() const { return sampler_; }
    double build_seconds() const { return build_seconds_; }

    // Adds all samples to the film, which must be new. The film depends on the description alone: not on
    // the number of threads, nor on when it was looked at.
    RenderReport render(Film& film, const ProgressCallback& progress = {},
                        const CancelFlag* cancel = nullptr) const;

    // Traces one sample of the render again and writes it down (sample_record.h). The record refers to the
    // renderer's scene and tables. Throws Error, as check_sample does, where the render takes no such sample.
    SampleRecord replay(int x, int y, std::uint64_t index) const;

  private:
    const SceneDescription& description_;
    SamplerSettings sampler_;
    double build_seconds_ = 0;
    std::unique_ptr<SceneTables> tables_;
    std::unique_ptr<Accelerator> accelerator_;
    Camera camera_;
};

} // namespace montelux
