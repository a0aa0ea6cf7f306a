// Path tracing: the radiance that arrives along a camera ray, estimated with one random path.
#pragma once

#include "montelux/mc/random/sample_stream.h"
#include "montelux/scene/camera/camera.h"
#include "montelux/scene/render_settings.h"
#include "montelux/scene/view.h"
#include "montelux/transport/ray_tracer.h"

namespace montelux {

struct PathRecord;

// All that a path reads. The members outlive every path.
struct PathScene {
    const SceneView& scene;
    const Camera& camera;
    IntegratorSettings settings;
    // Size of a texture's footprint in pixels: many samples per pixel need little filtering each.
    float footprint_scale = 1;
};

// What the first surface looks like; zero where there is none.
struct FirstHit {
    SampledSpectrum albedo;
    Normal3f normal;
    float depth = 0; // distance along the camera ray
    bool found = false;
};

// Estimates the rendering equation (MISSION C1-C5; Kajiya 1986, "The Rendering Equation"): at each vertex the
// light is sampled by next-event estimation and by continuing the path, weighted by multiple importance
// sampling, or by one of the two alone, as the settings say. Paths end after max_depth scattering events or
// by Russian roulette; all strategies estimate the same integral. `lambda` may lose its secondary wavelengths
// on the way. `record`, where given, gets the path vertex by vertex; the radiance is the same to the last
// bit.
SampledSpectrum path_radiance(const PathScene& ps, RayTracer& tracer, Ray ray, SampledWavelengths& lambda,
                              SampleStream& stream, FirstHit* first, PathRecord* record = nullptr);

} // namespace montelux
