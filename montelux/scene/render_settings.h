// What a scene file says beside the scene itself: film, sampler, integrator. Options of the command line
// override it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "montelux/mc/random/sampler_settings.h"
#include "montelux/scene/film/film_settings.h"
#include "montelux/scene/light/environment/environment_settings.h"
#include "montelux/scene/scene.h"

namespace montelux {

// How the light at a vertex of a path is found (MISSION C5, C9). From `light` on lights are sampled.
enum class Strategy : std::uint8_t {
    uniform, // directions uniform over the sphere (hemisphere for opaque surfaces)
    bsdf,    // directions by BSDF sampling
    light,   // points on lights; what lights cannot be sampled for (mirrors, seen lights) by BSDF sampling
    mis,     // both, joined by multiple importance sampling
    // The two terms of mis, to be looked at: by the same random numbers they add up to it. Light that the
    // path meets, by its weight: what the camera and mirrors see as well.
    mis_bsdf,
    mis_light, // sampled lights, by their weight: all of lights that nothing can meet
};
enum class Heuristic : std::uint8_t { balance, power };
// How one light is chosen among many (scene/light/sampler).
enum class LightSampling : std::uint8_t { uniform, power };

struct IntegratorSettings {
    int max_depth = 5; // scattering events of a path
    Strategy strategy = Strategy::mis;
    Heuristic heuristic = Heuristic::power;
    LightSampling light_sampling = LightSampling::power;
    EnvironmentSampling environment_sampling = EnvironmentSampling::automatic;
    // MIS compensation, of no effect but where light and BSDF samples are joined: by mis and its terms.
    bool environment_compensation = true;
    EnvironmentLookup environment_lookup = EnvironmentLookup::nearest;

    EnvironmentSettings environments() const {
        return {environment_sampling, environment_compensation && strategy >= Strategy::mis,
                environment_lookup};
    }
};

struct SceneDescription {
    Scene scene;
    FilmSettings film;
    SamplerSettings sampler;
    IntegratorSettings integrator;
    std::string output_file; // the file's own wish; may be empty
};

} // namespace montelux
