// IntegratorModel: maps a camera ray and a random stream to a sample's contribution to the film.
#pragma once

#include <concepts>
#include <span>
#include <string_view>

#include "montelux/mc/random/stream.h"
#include "montelux/scene/shape/ray.h"
#include "montelux/scene/view.h"
#include "montelux/spectrum/wavelengths.h"
#include "montelux/transport/ray_tracer.h"
#include "montelux/transport/sample_extras.h"
#include "montelux/transport/splat.h"

namespace montelux {

struct PathRecord;
class GuidingTrace;
struct MergingSample;

struct CameraSample {
    Ray ray;
    SampledWavelengths lambda;
    SampleExtras* extras = nullptr;   // null: not wanted
    GuidingTrace* trace = nullptr;    // null: no guide learns from the path
    float expected = 0;               // GuidingField::expected
    SplatList* splats = nullptr;      // gets those of the sample; null: not wanted
    MergingSample* merging = nullptr; // of a sample whose path merges with others
};

// A sample before its path: the stream has given the camera's numbers.
template <RandomStream Stream>
struct PathStart {
    CameraSample camera;
    Stream stream;
};

// Features of the first surface; zero without one.
struct FirstHit {
    SampledSpectrum albedo;
    Normal3f normal;
    float depth = 0; // distance along the camera ray
    bool found = false;
};

// The contribution of a sample to its pixel.
struct FilmContribution {
    SampledSpectrum radiance;
    SampledWavelengths lambda; // of the camera sample, possibly without the secondary ones
    FirstHit first;
    float transparency = 0; // share of the light behind the scene that the path lets through unscattered
};

// Stateless between samples: `estimate` is a function of the scene, the camera sample and the numbers of the
// stream. Its mean over streams of independent uniform numbers is the radiance along the ray. The tracer
// counts rays.
// `record`, unless null, gets the path; the contribution is the same to the last bit. So is that of each of
// many samples that are estimated together, in the memory of a `Batch`.
template <typename I, typename Stream>
concept IntegratorModel = RandomStream<Stream> &&
    requires(const I& integrator, const SceneView& scene, RayTracer& tracer, const CameraSample& camera,
             Stream& stream, PathRecord* record, std::span<PathStart<Stream>> starts,
             typename I::Batch& batch, std::span<FilmContribution> results) {
    { I::name } -> std::convertible_to<std::string_view>; // for messages
    { integrator.estimate(scene, tracer, camera, stream, record) } -> std::same_as<FilmContribution>;
    integrator.estimate(scene, tracer, starts, batch, results);
};

// For integrators that do not trace the rays of many samples together.
template <typename I, RandomStream Stream>
void estimate_one_by_one(const I& integrator, const SceneView& scene, RayTracer& tracer,
                         std::span<PathStart<Stream>> starts, std::span<FilmContribution> results) {
    for (std::size_t i = 0; i < starts.size(); ++i)
        results[i] = integrator.estimate(scene, tracer, starts[i].camera, starts[i].stream);
}

} // namespace montelux
