// PathIntegrator: path tracing, one random path per camera ray; a guide may split it.
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "montelux/scene/render_settings.h"
#include "montelux/transport/guiding/guiding_field.h"
#include "montelux/transport/manifold/casters.h"
#include "montelux/transport/path_batch.h"
#include "montelux/transport/path_recorder.h"
#include "montelux/transport/path_state.h"
#include "montelux/transport/path_weights.h"
#include "montelux/transport/texture_footprint.h"

namespace montelux {

enum class LaneShading : std::uint8_t;
template <int W>
struct HitGroup;

// Estimates the rendering equation (MISSION C1-C5; Kajiya 1986, "The Rendering Equation"). At each vertex
// light is found by next-event estimation and by continuing the path; multiple importance sampling weights
// both, or one is used alone, as the settings say. Paths end after max_depth scattering events or by Russian
// roulette; all strategies estimate the same integral.
//
// `shade` and `escape` take a PathState from vertex to vertex. The caller traces the rays between: one by one
// as `estimate` does, or those of many paths at a time. A path depends on its own state, hits and random
// numbers only, to the last bit. Include path_shading.h to use a stream other than SampleStream.
class PathIntegrator {
  public:
    static constexpr std::string_view name = "path";

    // The camera must outlive it. `footprint_scale`: size of a texture's footprint in pixels; with many
    // samples per pixel each needs little filtering.
    PathIntegrator(const IntegratorSettings& settings, const Camera& camera, float footprint_scale = 1)
        : settings_(settings), camera_(&camera), footprint_scale_(footprint_scale) {}

    // From now on directions are also drawn from what the guide has learned (transport/guiding); null: from BSDFs
    // alone. It must outlive the paths.
    void set_guide(const GuidingField* guide) { guide_ = guide; }

    // From now on covered lights are also found across casters (transport/manifold), and there by nothing else; null:
    // by scattering. They must outlive the paths. Not with a guide.
    void set_casters(const Casters* casters) { casters_ = casters; }

    // `record`, if given, receives the path vertex by vertex; the radiance is the same to the last bit. Not with a
    // guide, which makes samples trees of paths.
    template <RandomStream Stream>
    FilmContribution estimate(const SceneView& scene, RayTracer& tracer, const CameraSample& camera,
                              Stream& stream, PathRecord* record = nullptr) const;

    // The same for many samples: all rays of one depth are traced together. `results` has the size of
    // `starts`, whose streams are used up.
    using Batch = PathBatch;
    template <RandomStream Stream>
    void estimate(const SceneView& scene, RayTracer& tracer, std::span<PathStart<Stream>> starts,
                  PathBatch& batch, std::span<FilmContribution> results) const;

    // The state's ray hit a surface: adds emission, and scatters. The caller traces the shadow ray, if any,
    // before reading the radiance. With a guide the path may be split: `begun`, unless null, gets its other branches.
    template <RandomStream Stream>
    std::optional<ShadowRay> shade(const SceneView& scene, PathState& state, const Hit& hit, Stream& stream,
                                   PathRecorder recorder = PathRecorder(nullptr),
                                   std::vector<PathBranch>* begun = nullptr) const;
    // The state's ray left the scene: adds infinite lights, and ends the path.
    void escape(const SceneView& scene, PathState& state,
                PathRecorder recorder = PathRecorder(nullptr)) const;

  private:
    template <RandomStream Stream>
    struct Vertex;

    // Light sampling and the direction in which a path, or a branch of it, continues from a vertex.
    template <RandomStream Stream>
    void scatter(const Vertex<Stream>& vertex, const SurfacePoint& s, const Hit& hit,
                 const SurfaceBsdf& surface, std::optional<ShadowRay>& shadow) const;
    // `shade` of several hits that have at least this level; empties the group.
    template <int W>
    void shade_diffuse(const SceneView& scene, LaneShading level, HitGroup<W>& group, PathBatch& batch) const;
    // Light across casters at a hit that is not shaded yet.
    template <RandomStream Stream>
    void add_light_of_casters(const SceneView& scene, RayTracer& tracer, PathState& state, const Hit& hit,
                              Stream& stream) const;
    // Adds a light that the state's ray hit.
    void add_met_light(const SceneView& scene, PathState& state, Index light, const LightHit& hit,
                       PathRecorder recorder) const;
    TextureContext texture_context(const SurfacePoint& surface) const {
        return montelux::texture_context(*camera_, footprint_scale_, surface);
    }

    IntegratorSettings settings_;
    const Camera* camera_;
    float footprint_scale_;
    const GuidingField* guide_ = nullptr;
    const Casters* casters_ = nullptr;
};

} // namespace montelux
