// PreparedScene: the tables and the ray tracer of a scene, built once and shared by its renders.
#pragma once

#include <chrono>
#include <vector>

#include "montelux/accel/accelerator.h"
#include "montelux/scene/memory_use.h"
#include "montelux/scene/render_settings.h"
#include "montelux/scene/scene_tables.h"

namespace montelux {

// Refers to the scene, which must outlive it. Depends neither on the film nor on where the camera stands: these may
// differ between renders that share it.
class PreparedScene {
  public:
    // Throws Error on invalid settings. Uses threads as the caller's ThreadLimit allows.
    explicit PreparedScene(const SceneDescription& description);

    const SceneView& view() const { return tables_.view(); }
    const Accelerator& accelerator() const { return accelerator_; }
    double build_seconds() const { return build_seconds_; }
    // Of the tables and the ray tracer, by kind.
    std::vector<MemoryUse> memory_use() const;

  private:
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
    const Scene& scene_;
    SceneTables tables_;
    Accelerator accelerator_;
    double build_seconds_;
};

} // namespace montelux
