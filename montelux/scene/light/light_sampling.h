// Next-event estimation: points on lights and directions to them, with their densities.
#pragma once

#include <optional>

#include "montelux/scene/scene.h"
#include "montelux/scene/scene_tables.h"
#include "montelux/scene/shape/ray.h"

namespace montelux {

// Where light is asked for.
struct ReferencePoint {
    Point3f p;
    Normal3f n;      // geometric normal
    float error = 0; // as SurfacePoint::error
};

struct LightSample {
    SampledSpectrum radiance; // for a delta light: irradiance on a plane facing it
    Vec3f wi;                 // unit, towards the light
    float pdf = 0;            // per solid angle, given the light; 1 for a delta light
    bool delta = false;       // of a point or one direction
    bool invisible = false;   // BSDF sampling cannot find this light: a delta light, or one of alpha 0
    Ray shadow;               // unoccluded when the light is seen
};

// Empty where the light cannot shine on the point. An area light shines with the share of its points that is
// there (Shape::alpha), but one of alpha 0 everywhere shines whole and is not seen, as in pbrt-v4.
std::optional<LightSample> sample_light(const Scene& scene, const SceneTables& tables, Index light,
                                        const ReferencePoint& reference, Vec2f u,
                                        const SampledWavelengths& lambda);

// Density, per solid angle at the reference, with which sample_light finds the point `p` (normal n) of an
// area light.
float area_light_pdf(const Scene& scene, const LightTables& tables, Index light,
                     const ReferencePoint& reference, Point3f p, Normal3f n);
// The same for a direction to an infinite light, at `p`.
float infinite_light_pdf(const Scene& scene, const LightTables& tables, Index light, Point3f p, Vec3f wi);

// Radiance that leaves an area light along w at a point with geometric normal n.
SampledSpectrum emitted_radiance(const AreaLight& light, Normal3f n, Vec3f w,
                                 const SampledWavelengths& lambda);
// Radiance of an infinite light that comes to `p` from direction wi; black for other lights.
SampledSpectrum infinite_radiance(const Scene& scene, const LightTables& tables, Index light, Point3f p,
                                  Vec3f wi, const SampledWavelengths& lambda);

} // namespace montelux
