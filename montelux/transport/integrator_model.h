// IntegratorModel: from a camera ray and a stream of numbers to what a sample adds to the film.
#pragma once

#include <concepts>
#include <string_view>

#include "montelux/mc/random/stream.h"
#include "montelux/scene/shape/ray.h"
#include "montelux/scene/view.h"
#include "montelux/spectrum/wavelengths.h"
#include "montelux/transport/ray_tracer.h"

namespace montelux {

struct CameraSample {
    Ray ray;
    SampledWavelengths lambda;
};

// What the first surface looks like; zero where there is none.
struct FirstHit {
    SampledSpectrum albedo;
    Normal3f normal;
    float depth = 0; // distance along the camera ray
    bool found = false;
};

// What a sample adds to its pixel.
struct FilmContribution {
    SampledSpectrum radiance;
    SampledWavelengths lambda; // those of the camera sample, perhaps without their secondary ones
    FirstHit first;
};

// Stateless between samples: `estimate` is a function of the scene, the camera sample and the numbers of the
// stream, whose mean over streams of independent uniform numbers is the radiance along the ray. The tracer
// counts rays.
template <typename I, typename Stream>
concept IntegratorModel = RandomStream<Stream> &&
    requires(const I& integrator, const SceneView& scene, RayTracer& tracer, const CameraSample& camera,
             Stream& stream) {
    { I::name } -> std::convertible_to<std::string_view>; // for people
    { integrator.estimate(scene, tracer, camera, stream) } -> std::same_as<FilmContribution>;
};

} // namespace montelux
