// A path written down vertex by vertex: every factor of everything that it adds to a pixel.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "montelux/scene/light/light_sampling.h"
#include "montelux/scene/material/make_bsdf.h"
#include "montelux/scene/shape/surface_point.h"

namespace montelux {

// Light that the path met by following its ray: on the surface that it hit, or from beyond the scene.
struct FoundLight {
    Index light = no_index;
    Index part = 0;             // the triangle of an emissive mesh
    SampledSpectrum radiance{}; // along the ray
    // Light sampling at the vertex before could have found it too. Where it could not (the camera's ray, a
    // delta lobe), the weight is 1 and there are no densities.
    bool shared = false;
    float bsdf_pdf = 0;  // of the ray's direction, per solid angle at the vertex before
    float light_pdf = 0; // of light sampling finding the same, per solid angle, choice of the light included
    float weight = 1;    // of multiple importance sampling
    bool counted = true; // false: the strategy looks at the other term of multiple importance sampling alone
    SampledSpectrum contribution{}; // to the radiance of the path
};

// One light, chosen and sampled by next-event estimation.
struct DirectLight {
    enum class Outcome : std::uint8_t {
        counted,
        occluded,
        // The light cannot shine on the vertex, for example from behind.
        dark,
        // The strategy leaves lights that can be hit to scattering.
        left_to_scattering,
        // The light is black here or the BSDF sends nothing of it along the path.
        no_transport,
        // The strategy looks at the other term of multiple importance sampling alone.
        other_term,
    };
    Outcome outcome = Outcome::dark;
    Index light = no_index;
    Index part = 0;             // the triangle of an emissive mesh
    float choice = 0;           // probability of choosing this light
    bool delta = false;         // a light of a point or one direction
    Vec3f wi{};                 // world space, towards the light
    Ray shadow{};               // free when the light is seen
    SampledSpectrum radiance{}; // for a delta light: irradiance on a plane facing it
    SampledSpectrum f{};        // BSDF times cosine
    float light_pdf = 0;        // per solid angle, choice included; for a delta light the choice alone
    float bsdf_pdf = 0;         // of scattering into wi, per solid angle
    float weight = 0;           // of multiple importance sampling
    SampledSpectrum contribution{};
};

struct Scattering {
    BsdfSample sample; // its wi is in the frame of the shading normal
    Vec3f wi;          // world space
};

struct Roulette {
    float survival = 1; // probability
    float u = 0;        // the number drawn; the path survives below `survival`
};

enum class PathEnd : std::uint8_t {
    left_scene,
    max_depth,
    grazing,         // the ray lies in the plane of the shading normal's surface
    no_direction,    // the BSDF sampled none: absorbed, or to a side of the surface that it does not send
                     // light to
    nothing_carried, // the throughput is black
    bad_throughput,  // it is not a number, or negative: it is added to the radiance, so that the sample is
                     // told of
    roulette,
};

// One ray and what is at its end.
struct PathVertex {
    Ray ray;
    SampledSpectrum throughput; // of the path up to here
    Hit hit;
    std::optional<SurfacePoint> surface; // none where the ray left the scene
    std::vector<FoundLight> found;
    std::optional<SurfaceBsdf> bsdf; // from here on: none where the path ended before
    Vec3f wo;                        // towards the vertex before, in the frame of the shading normal
    std::optional<DirectLight> direct;
    std::optional<Scattering> scattering;
    std::optional<Roulette> roulette;
    SampledSpectrum continued; // throughput of the path that leaves, after the roulette
};

// Refers to the scene and its tables (SurfacePoint::shape, CoatedDiffuseBsdf::table), which must outlive it.
struct PathRecord {
    std::vector<PathVertex> vertices;
    PathEnd end = PathEnd::left_scene;
    SampledSpectrum radiance;
};

// The quantity that made a path's radiance bad.
struct BadOrigin {
    enum class Quantity : std::uint8_t {
        found_radiance,  // of a light that the path met
        found_density,   // of sampling it, or its weight
        direct_radiance, // of a light that was sampled
        direct_density,
        bsdf_value,
        bsdf_weight, // of the direction in which the path went on
        throughput,  // a product of good factors that is too large
        product,     // a contribution that is too large, of good factors
        sum,         // of good contributions
    };
    Quantity quantity = Quantity::sum;
    std::size_t vertex = 0; // index into PathRecord::vertices
};

// Where a radiance that is not finite, or negative, became so: the first bad contribution, and in it the
// first bad factor. Empty for a good radiance.
std::optional<BadOrigin> origin_of_bad(const PathRecord& record);

} // namespace montelux
