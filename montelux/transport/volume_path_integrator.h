// VolumePathIntegrator: path tracing through participating media, one random path per camera ray.
#pragma once

#include <span>
#include <string_view>

#include "montelux/scene/camera/camera.h"
#include "montelux/scene/render_settings.h"
#include "montelux/transport/path_batch.h"
#include "montelux/transport/path_recorder.h"

namespace montelux {

class GuidingField;

// Estimates the radiative transfer equation with the surfaces of PathIntegrator. Collisions are sampled by null
// scattering (Woodcock et al. 1965) at the extinction of the first wavelength; all four share the path, weighted
// by its densities at each of them (Miller, Georgiev, Jarosz 2019, "A Null-Scattering Path Integral Formulation
// of Light Transport"). Light is found by next-event estimation through media and interfaces, and by scattering.
//
// Settings mean what they mean for PathIntegrator; max_depth counts scattering by surfaces and media. Paths pass
// interfaces (InterfaceMaterial) without a scattering event. A shape's media apply if they differ; the camera's
// medium is Scene::camera.medium. Include volume_path.h to use a stream other than SampleStream.
class VolumePathIntegrator {
  public:
    static constexpr std::string_view name = "volume path";

    // As PathIntegrator.
    VolumePathIntegrator(const IntegratorSettings& settings, const Camera& camera, float footprint_scale = 1)
        : settings_(settings), camera_(&camera), footprint_scale_(footprint_scale) {}

    // As PathIntegrator; directions are drawn from phase functions and the guide together, too.
    void set_guide(const GuidingField* guide) { guide_ = guide; }

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
    template <RandomStream Stream>
    friend class VolumePath;

    IntegratorSettings settings_;
    const Camera* camera_;
    float footprint_scale_;
    const GuidingField* guide_ = nullptr;
};

} // namespace montelux
