// PathRecord: a path vertex by vertex, with every factor of its contributions to a pixel.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "montelux/scene/bsdf/bsdf_types.h"
#include "montelux/scene/light/light_sampling.h"
#include "montelux/scene/shape/surface_point.h"

namespace montelux {

struct SurfaceBsdf;

// Light that the path hit: on a surface, or outside the scene.
struct FoundLight {
    Index light = no_index;
    Index part = 0;             // the triangle of an emissive mesh
    SampledSpectrum radiance{}; // along the ray
    // Light sampling at the previous vertex could have found it too. If not (the camera ray, a delta lobe),
    // the weight is 1 and there are no densities.
    bool shared = false;
    float bsdf_pdf = 0;  // of the ray's direction, per solid angle at the previous vertex
    float light_pdf = 0; // of light sampling finding the same, per solid angle, choice of the light included
    float weight = 1;    // of multiple importance sampling
    bool counted = true; // false: the strategy shows only the other MIS term
    SampledSpectrum contribution{}; // to the radiance of the path
};

// One light, chosen and sampled by next-event estimation.
struct DirectLight {
    enum class Outcome : std::uint8_t {
        counted,
        occluded,
        // The light cannot illuminate the vertex, for example from behind.
        dark,
        // The strategy finds lights that can be hit by scattering only.
        left_to_scattering,
        // The light is black here, or the BSDF is zero.
        no_transport,
        // The strategy shows only the other MIS term.
        other_term,
    };
    Outcome outcome = Outcome::dark;
    Index light = no_index;
    Index part = 0;             // the triangle of an emissive mesh
    float choice = 0;           // probability of choosing this light
    bool delta = false;         // a point or directional light
    Vec3f wi{};                 // world space, towards the light
    Ray shadow{};               // unoccluded if the light is visible
    SampledSpectrum radiance{}; // for a delta light: irradiance on a plane facing it
    SampledSpectrum f{};        // BSDF times cosine
    float light_pdf = 0;        // per solid angle, choice included; for a delta light the choice alone
    float bsdf_pdf = 0;         // of scattering into wi, per solid angle
    // In a medium: of SegmentLight finding the same; of light on a ray: of light sampling after a free flight.
    float other_pdf = 0;
    float weight = 0; // of multiple importance sampling
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
    grazing,         // the ray lies in the plane of the shading normal
    no_direction,    // the BSDF returned no sample: absorbed, or on a side where it is zero
    nothing_carried, // the throughput is black
    bad_throughput,  // NaN or negative: added to the radiance, so that the sample is reported
    roulette,
    absorbed, // by a medium
};

// A collision with a medium.
struct MediumEvent {
    Point3f p{};
    SampledSpectrum sigma_a{}, sigma_s{};
    bool scattered = false; // this and the next ones: else absorbed, or the path ended here
    Vec3f wi{};
    float pdf = 0; // of wi, per solid angle
};

// One ray and the vertex at its end: on a surface, in a medium, or outside the scene. In media, throughputs are
// weighted over the wavelengths, radiances include transmittances, and densities are relative to that of the
// path, averaged over the wavelengths.
struct PathVertex {
    Ray ray;
    SampledSpectrum throughput; // of the path up to here
    std::optional<MediumEvent> medium;
    Hit hit;
    std::optional<SurfacePoint> surface; // empty if the ray left the scene or ended in a medium
    std::vector<FoundLight> found;
    std::shared_ptr<const SurfaceBsdf> bsdf; // this and the following are empty if the path ended before
    Vec3f wo; // towards the previous vertex, in the frame of the shading normal
    std::optional<DirectLight> direct;
    std::optional<Scattering> scattering;
    std::optional<Roulette> roulette;
    SampledSpectrum continued; // throughput after scattering and roulette
};

// Light sampled from a point of a ray through a medium (SegmentLight). Its f is transmittance x scattering
// coefficient x phase function, and light_pdf is a density per length as well.
struct RayLight {
    std::size_t vertex = 0; // at the end of the ray: index into PathRecord::vertices
    float distance = 0;     // from the start of the ray
    SampledSpectrum throughput{};
    DirectLight light;
};

// Refers to the scene and its tables (SurfacePoint::shape, CoatedDiffuseBsdf::table), which must outlive it.
struct PathRecord {
    std::vector<PathVertex> vertices;
    std::vector<RayLight> on_rays;
    PathEnd end = PathEnd::left_scene;
    SampledSpectrum emission; // of media, part of the radiance
    SampledSpectrum radiance;
};

// The quantity that made a path's radiance bad.
struct BadOrigin {
    enum class Quantity : std::uint8_t {
        found_radiance,  // of a light that the path hit
        found_density,   // of sampling it, or its weight
        direct_radiance, // of a sampled light
        direct_density,
        bsdf_value,  // or that of a phase function
        bsdf_weight, // of the direction in which the path continued
        throughput,  // a product of good factors overflowed
        product,     // a contribution of good factors overflowed
        sum,         // of good contributions
    };
    Quantity quantity = Quantity::sum;
    std::size_t vertex = 0; // index into PathRecord::vertices
};

// Where a radiance became NaN, infinite or negative: the first bad contribution, and in it the first bad
// factor. Empty for a good radiance.
std::optional<BadOrigin> origin_of_bad(const PathRecord& record);

} // namespace montelux
