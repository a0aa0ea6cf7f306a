// SceneDescription: a scene with its film, sampler and integrator settings. Options of the command line
// override them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "montelux/mc/random/sampler_settings.h"
#include "montelux/scene/film/film_settings.h"
#include "montelux/scene/light/environment/environment_settings.h"
#include "montelux/scene/scene.h"

namespace montelux {

// How paths between lights and camera are found.
enum class IntegratorKind : std::uint8_t {
    path,          // from the camera (transport/path_integrator.h, volume_path_integrator.h)
    bidirectional, // from the camera and from lights, joined in all ways (transport/bidirectional_integrator.h)
    light_tracing, // from lights, joined to the camera; an oracle for the former
    metropolis,    // Markov chains over the random numbers of paths from the camera (docs/metropolis.md)
    automatic, // path, bidirectional or metropolis; decided before the render (render/integrator_choice.h)
};
// Whether paths start at lights, too.
inline constexpr bool traces_light(IntegratorKind kind) {
    return kind == IntegratorKind::bidirectional || kind == IntegratorKind::light_tracing;
}

// How direct light is found (MISSION C5, C9). From `light` on, lights are sampled.
enum class Strategy : std::uint8_t {
    uniform, // directions uniform over the sphere (hemisphere for opaque surfaces)
    bsdf,    // directions by BSDF sampling
    light,   // points on lights; BSDF sampling for light that cannot be sampled (mirrors, visible lights)
    mis,     // both, weighted by multiple importance sampling
    // The two terms of mis, for inspection; with the same random numbers they sum to it. Light that the path
    // hits, weighted, including light seen by the camera and in mirrors.
    mis_bsdf,
    mis_light, // sampled lights, weighted; includes all of lights that cannot be hit
};
enum class Heuristic : std::uint8_t { balance, power };
// How one light is chosen among many (scene/light/sampler).
enum class LightSampling : std::uint8_t { uniform, power, tree };
// What becomes of light that microfacets throw at one another: lost, as pbrt means rough surfaces, or followed until
// it leaves (scene/bsdf/multiple_scattering.h).
enum class MicrofacetScattering : std::uint8_t { single, multiple };
// Where the facets of a mesh with smooth normals turn away from a light: shadow at once, as pbrt means it, or a
// gradual one (scene/shape/shading_terminator.h).
enum class ShadingTerminator : std::uint8_t { hard, soft };

// Whether paths learn where light comes from (transport/guiding): where that pays, always, or never.
enum class Guiding : std::uint8_t { automatic, on, off };

struct SurfaceSettings {
    MicrofacetScattering microfacets = MicrofacetScattering::single;
    ShadingTerminator terminator = ShadingTerminator::hard;

    bool operator==(const SurfaceSettings&) const = default;
};

// Ambient occlusion instead of light (transport/occlusion_integrator.h).
struct OcclusionSettings {
    bool cosine = true; // samples directions by their cosine, or evenly
    float max_distance = std::numeric_limits<float>::infinity();
};

// Vertex merging (transport/light_map.h): light paths of a pass end at all points of camera paths that are near them.
// The picture is then consistent, not unbiased.
struct MergingSettings {
    float radius = 0; // of the first pass, in units of the scene; 0: chosen by the size of pixels there
    std::size_t memory = 192; // MiB that the light paths of a pass may take
};

struct IntegratorSettings {
    IntegratorKind method = IntegratorKind::path;
    int max_depth = 5; // scattering events of a path
    // A straight passage through a thin pane is one of these events. Scenes without media count it in any case.
    bool count_passages = true;
    Strategy strategy = Strategy::mis;
    Heuristic heuristic = Heuristic::power;
    LightSampling light_sampling = LightSampling::tree;
    // Lamps are looked for along rays through media, too (transport/segment_light.h). Effective where
    // lights are sampled.
    bool equiangular = true;
    // Widens the microfacet lobes of surfaces that the path meets after an event that was not specular (Ggx::widened):
    // biased, without the fireflies of caustics.
    bool regularize = false;
    // Of path: caustics of single smooth interfaces by specular manifold sampling (transport/manifold).
    bool manifold_sampling = false;
    Guiding guiding = Guiding::off;
    std::size_t guiding_memory = 256;             // MiB at most, while a guide is trained
    std::optional<MergingSettings> merging{};     // of bidirectional
    std::optional<OcclusionSettings> occlusion{}; // the other settings then have no effect
    EnvironmentSampling environment_sampling = EnvironmentSampling::automatic;
    // MIS compensation; effective only with mis and its terms.
    bool environment_compensation = true;
    EnvironmentLookup environment_lookup = EnvironmentLookup::nearest;
    MicrofacetScattering microfacet_scattering = MicrofacetScattering::single;
    ShadingTerminator shading_terminator = ShadingTerminator::hard;
    // Linear sRGB of the picture where camera rays leave the scene unscattered, in place of the infinite lights there;
    // neither exposed nor clamped as light is. Empty: the lights are seen.
    std::optional<Vec3f> background{};
    // Of metropolis: probability of a large step, in (0, 1]; 0: chosen by a pilot.
    float large_step_probability = 0;

    EnvironmentSettings environments() const {
        return {environment_sampling,
                environment_compensation && strategy >= Strategy::mis &&
                    method != IntegratorKind::light_tracing,
                environment_lookup};
    }
    SurfaceSettings surfaces() const { return {microfacet_scattering, shading_terminator}; }
};

inline bool merges(const IntegratorSettings& s) {
    return s.method == IntegratorKind::bidirectional && s.merging.has_value();
}

struct SceneDescription {
    Scene scene;
    FilmSettings film;
    SamplerSettings sampler;
    IntegratorSettings integrator;
    std::string output_file; // the file's own name; may be empty
    bool has_camera = true;  // false: the file has none
    // False: the file has no lights, or those of glTF, in whose format nothing lights a scene all around.
    bool has_lights = true;
    // What the file lacks of camera and light is added by a studio (formats/studio.h).
    bool wants_studio = false;
    // Where the format says which axis points up, that unit vector; else the camera tells.
    std::optional<Vec3f> up{};
    // What the file offers to choose from; names may be empty.
    std::vector<std::string> camera_names{}, variant_names{}, animation_names{};
    // Of a scene loaded at a time of its animations: the time of their last key, seconds; 0: it has none.
    double animation_end = 0;
};

} // namespace montelux
