// PathState: a path between two of its vertices, as a plain value.
#pragma once

#include <type_traits>

#include "montelux/transport/integrator_model.h"

namespace montelux {

struct PathState {
    Ray ray;                   // to be traced next
    SampledWavelengths lambda; // may lose its secondary wavelengths
    SampledSpectrum radiance{}, throughput{1};
    ReferencePoint previous;        // the last scattering vertex; at first the origin of the camera ray
    float bsdf_pdf = 0;             // of the ray's direction there
    float eta_scale = 1;            // squared index of refraction along the path, undone for Russian roulette
    int depth = 0;                  // scattering events so far
    bool sees_lights = true;        // no other strategy can find the light that the ray hits
    bool scattered_roughly = false; // some event so far was not specular
    bool alive = true;              // false: the path has ended; do not trace the ray
    FirstHit first;

    PathState(const CameraSample& camera) : ray(camera.ray), lambda(camera.lambda) {
        previous.p = camera.ray.o;
    }
};
static_assert(std::is_trivially_copyable_v<PathState>);

// What next-event estimation adds to the radiance of a path if nothing occludes the ray.
struct ShadowRay {
    Ray ray;
    SampledSpectrum contribution;
};

} // namespace montelux
