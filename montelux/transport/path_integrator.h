// PathIntegrator: path tracing, one random path per camera ray.
#pragma once

#include <optional>
#include <string_view>

#include "montelux/mc/integrate/mis.h"
#include "montelux/scene/camera/camera.h"
#include "montelux/scene/render_settings.h"
#include "montelux/transport/path_recorder.h"
#include "montelux/transport/path_state.h"

namespace montelux {

// Estimates the rendering equation (MISSION C1-C5; Kajiya 1986, "The Rendering Equation"): at each vertex the
// light is sampled by next-event estimation and by continuing the path, weighted by multiple importance
// sampling, or by one of the two alone, as the settings say. Paths end after max_depth scattering events or
// by Russian roulette; all strategies estimate the same integral.
//
// A path is a PathState that is taken from vertex to vertex by `shade` and `escape`; the rays between are the
// caller's to trace, one by one as `estimate` does, or many paths at a time. What a path becomes depends on
// its own state, hits and numbers alone, to the last bit. Include path_shading.h to use another stream than SampleStream.
class PathIntegrator {
  public:
    static constexpr std::string_view name = "path";

    // The camera outlives it. `footprint_scale`: size of a texture's footprint in pixels; many samples per
    // pixel need little filtering each.
    PathIntegrator(const IntegratorSettings& settings, const Camera& camera, float footprint_scale = 1)
        : settings_(settings), camera_(&camera), footprint_scale_(footprint_scale) {}

    // `record`, where given, gets the path vertex by vertex; the radiance is the same to the last bit.
    template <RandomStream Stream>
    FilmContribution estimate(const SceneView& scene, RayTracer& tracer, const CameraSample& camera,
                              Stream& stream, PathRecord* record = nullptr) const;

    // The ray of the state met a surface: adds its emission, and scatters. The shadow ray, if there is one,
    // is to be traced before the radiance is read.
    template <RandomStream Stream>
    std::optional<ShadowRay> shade(const SceneView& scene, PathState& state, const Hit& hit, Stream& stream,
                                   PathRecorder recorder = PathRecorder(nullptr)) const;
    // The ray of the state left the scene: adds infinite lights, and ends the path.
    void escape(const SceneView& scene, PathState& state,
                PathRecorder recorder = PathRecorder(nullptr)) const;

  private:
    template <RandomStream Stream>
    struct Vertex;

    bool samples_lights() const { return settings_.strategy >= Strategy::light; }
    // Of multiple importance sampling: of the strategy of density f beside the one of density g.
    float weight(float f, float g) const {
        return settings_.heuristic == Heuristic::power ? power_heuristic(1, f, 1, g)
                                                       : balance_heuristic(1, f, 1, g);
    }
    // How much of the light that was found by following the path counts.
    float hit_weight(float bsdf_pdf, float light_pdf) const;
    // The light that the ray of the state met.
    void add_met_light(const SceneView& scene, PathState& state, Index light, const LightHit& hit,
                       PathRecorder recorder) const;
    TextureContext texture_context(const SurfacePoint& surface) const;

    IntegratorSettings settings_;
    const Camera* camera_;
    float footprint_scale_;
};

} // namespace montelux
