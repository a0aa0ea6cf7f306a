// OcclusionIntegrator: ambient occlusion, the share of the sky that the first surface sees.
#pragma once

#include <span>
#include <string_view>

#include "montelux/scene/camera/camera.h"
#include "montelux/scene/render_settings.h"
#include "montelux/spectrum/spectrum_table.h"
#include "montelux/transport/path_batch.h"
#include "montelux/transport/path_recorder.h"

namespace montelux {

// Estimates V = 1/pi times the integral of visibility times cosine over the hemisphere of the geometric normal on the
// viewer's side (Landis 2002, "Production-Ready Global Illumination"), as white light: a surface that nothing shades has
// the film value (1, 1, 1), whatever the scene's lights and materials are. Shapes farther away than `max_distance` do not
// shade. Interfaces are passed; media have no effect. The background is black.
class OcclusionIntegrator {
  public:
    static constexpr std::string_view name = "ambient occlusion";

    // As PathIntegrator. `settings.occlusion` is given.
    OcclusionIntegrator(const IntegratorSettings& settings, const Camera& camera, float footprint_scale = 1);

    template <RandomStream Stream>
    FilmContribution estimate(const SceneView& scene, RayTracer& tracer, const CameraSample& camera,
                              Stream& stream, PathRecord* record = nullptr) const;

    using Batch = PathBatch;
    template <RandomStream Stream>
    void estimate(const SceneView& scene, RayTracer& tracer, std::span<PathStart<Stream>> starts, Batch&,
                  std::span<FilmContribution> results) const {
        estimate_one_by_one(*this, scene, tracer, starts, results);
    }

  private:
    OcclusionSettings settings_;
    const Camera* camera_;
    float footprint_scale_;
    const SpectrumTable* white_;
    float white_scale_;
};

} // namespace montelux
