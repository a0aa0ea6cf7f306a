// PathState: a path between two of its vertices, as a plain value.
#pragma once

#include <cstdint>
#include <type_traits>

#include "montelux/transport/integrator_model.h"

namespace montelux {

// What manifold sampling has to do with the next light that a path meets (transport/manifold).
enum class ManifoldChain : std::uint8_t {
    none,
    begun,  // the path scattered at a vertex that manifold sampling has joined to lights
    joined, // ... and then at a caster: the light is counted already
};

// A path that a guide splits continues as several branches; these bound the work of a sample.
inline constexpr int most_branches_at_vertex = 4, most_branches_of_sample = 64;

struct PathState {
    Ray ray;                   // to be traced next
    SampledWavelengths lambda; // may lose its secondary wavelengths
    SampledSpectrum radiance{}, throughput{1};
    ReferencePoint previous; // the last scattering vertex; at first the origin of the camera ray
    float bsdf_pdf = 0;      // of the ray's direction there
    // Of throughputs in Russian roulette: squared index of refraction along the path, times the branches it is one of.
    float roulette_scale = 1;
    // strength() after the last vertex with a GuidingRegion; 1 before that.
    float guided_strength = 1;
    int depth = 0;                  // scattering events so far
    bool sees_lights = true;        // no other strategy can find the light that the ray hits
    bool scattered_roughly = false; // some event so far was not specular
    ManifoldChain chain = ManifoldChain::none;
    bool scatters_narrowly = false; // at this vertex: manifold sampling leaves lamps to scattering
    bool alive = true;              // false: the path has ended; do not trace the ray
    FirstHit first;
    float transparency = 0;                 // as in FilmContribution
    SampleExtras* extras = nullptr;         // null: not wanted
    GuidingTrace* trace = nullptr;          // null: no guide learns from the path
    float expected = 0;                     // GuidingField::expected
    int branches = most_branches_of_sample; // that the path may still become
    // The path has been split: its radiance stays at the wavelengths of the camera ray, whatever `lambda` loses.
    bool keeps_spectrum = false;

    PathState(const CameraSample& camera)
        : ray(camera.ray), lambda(camera.lambda), extras(camera.extras), trace(camera.trace),
          expected(camera.expected) {
        previous.p = camera.ray.o;
    }
    // Radiance of a light, or of a medium (no_index), after `depth` scattering events, and `more` on the ray.
    void add(SampledSpectrum contribution, Index light, int more = 0) {
        radiance += contribution;
        if (extras != nullptr) [[unlikely]]
            extras->add(contribution, depth + more, light);
    }
    // The ray hits a surface, or leaves the scene.
    void meet(const Hit& hit) {
        if (extras != nullptr && depth == 0) [[unlikely]]
            extras->meet(ray, hit);
    }
    void leave(SampledSpectrum carried) {
        if (depth > 0) return;
        transparency += average(carried);
        if (extras != nullptr) [[unlikely]]
            extras->transparency = transparency;
    }
    // What Russian roulette on the throughput goes by.
    float strength(SampledSpectrum carried) const { return max_value(carried) * roulette_scale; }
    // The path is one of `count` branches.
    void split(int count) {
        throughput /= static_cast<float>(count);
        roulette_scale *= static_cast<float>(count); // or roulette would undo the split where nothing guides
        branches /= count;
        keeps_spectrum = keeps_spectrum || !lambda.secondary_terminated();
    }
};
static_assert(std::is_trivially_copyable_v<PathState>);

// What next-event estimation adds to the radiance of a path if nothing occludes the ray.
struct ShadowRay {
    Ray ray;
    SampledSpectrum contribution;
    Index light = no_index;
};

} // namespace montelux
