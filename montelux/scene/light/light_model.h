// LightModel: the concept of a light, and the values that its functions exchange.
#pragma once

#include <concepts>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "montelux/mc/math/transform.h"
#include "montelux/scene/index.h"
#include "montelux/scene/shape/bounds.h"
#include "montelux/scene/shape/ray.h"
#include "montelux/spectrum/sampled_spectrum.h"
#include "montelux/spectrum/wavelengths.h"

namespace montelux {

// Scene, index of a light and time (light_context.h).
struct LightContext;

// Where rays hit a light. An exhaustive list: it determines how a path treats a light.
enum class LightKind : std::uint8_t {
    surface,   // points of shapes
    infinite,  // directions that leave the scene
    position,  // a single point, which no ray hits
    direction, // a single direction, which no ray hits
};

// A point to be lit.
struct ReferencePoint {
    Point3f p{};
    Normal3f n{};    // geometric normal
    float error = 0; // as SurfacePoint::error
    // Light is scattered from directions on the side of this unit vector only; zero: from all.
    Vec3f facing{};
};

// A direction to a light, with the incident light.
struct LightSample {
    SampledSpectrum radiance; // of kinds position and direction: irradiance on a plane facing the light
    Vec3f wi;                 // unit, towards the light
    float pdf = 0;            // per solid angle, given light and part; 1 of kinds position and direction
    bool delta = false;       // kinds position and direction
    bool invisible = false;   // BSDF sampling cannot find this light: delta, or a surface of alpha 0
    Ray shadow;               // unoccluded if the light is visible
    // As LightHit, of kind surface.
    Point3f p{};
    Normal3f n{};
    Vec2f b{};
};

// Where a ray hits a light.
struct LightHit {
    Vec3f wi{};     // unit, towards the light
    Index part = 0; // this and the next ones for surfaces only
    Point3f p{};    // on the surface
    Normal3f n{};   // geometric normal, on the emitting side
    Vec2f b{};      // Hit::b1 and b2
};

// A ray that leaves a light. The flux of the light is the mean of radiance * cosine / (pdf_position *
// pdf_direction), in W/nm for radiance in W/(m^2 sr nm); for infinite lights and kind direction, the flux
// through the disk around the scene, or through the portal.
struct EmissionSample {
    SampledSpectrum radiance; // kind position: intensity; kind direction: irradiance across the beam
    Ray ray;                  // unit direction; starts off the surface, or outside the scene
    Normal3f n{};             // on the emitting side of the surface; zero for other kinds
    float cosine = 1;         // between n and the ray; 1 for kinds without a surface
    float pdf_position = 0;   // per area of the surface, or of a plane across the ray; 1 for kind position
    float pdf_direction = 0;  // per solid angle; 1 for kind direction
    bool invisible = false;   // as LightSample
    // As LightHit, of kind surface.
    Point3f p{};
    Vec2f b{};
};
// Densities of EmissionSample; 0 where a position or direction is a delta.
struct EmissionPdf {
    float position = 0, direction = 0;
};

// Bounds of a part of a light for light trees (Conty Estevez and Kulla 2018, "Importance Sampling of Many
// Lights with Adaptive Tree Splitting", section 4.1): all light leaves the box within the angle theta_e of a
// normal that lies within the angle theta_o of the axis.
struct LightBounds {
    Bounds3 box;
    Vec3f axis{0, 0, 1}; // unit
    float cos_theta_o = -1, cos_theta_e = -1;
    bool two_sided = false; // the same about -axis
};

// A light consists of parts that are chosen individually: the primitives of an emissive mesh; other lights
// have one. All is as it is at the context's time. Functions take random numbers in [0, 1)^2, do not allocate,
// and do not throw, except `powers`.
// Samples are large: where every return statement names the same variable, it is built in place.
template <typename L>
concept LightModel = requires(const L& light, const LightContext& context, Index part,
                              const ReferencePoint& from, const LightHit& hit, Vec3f w, Vec2f u,
                              const SampledWavelengths& lambda, std::span<double> powers) {
    { L::kind } -> std::convertible_to<LightKind>;
    { L::name } -> std::convertible_to<std::string_view>; // for messages
    { light.part_count(context) } -> std::same_as<Index>;
    // Incident light. Empty if the part cannot illuminate the point.
    { light.sample_li(context, part, from, u, lambda) } -> std::same_as<std::optional<LightSample>>;
    // Density of sample_li, given hit.part, per solid angle at `from`; 0 of kinds position and direction.
    { light.pdf_li(context, from, hit) } -> std::same_as<float>;
    // Light that arrives at `from` from the hit; black for kinds position and direction.
    { light.radiance(context, from, hit, lambda) } -> std::same_as<SampledSpectrum>;
    // Emission. Empty if nothing is emitted, which counts as a value of 0. u: position, then direction.
    { light.sample_le(context, part, u, u, lambda) } -> std::same_as<std::optional<EmissionSample>>;
    // Densities of sample_le at hit.p (surfaces only) along w, which points away from the light.
    { light.pdf_le(context, hit, w) } -> std::same_as<EmissionPdf>;
    // Estimate of each part's flux into the scene, W/nm averaged over the visible wavelengths.
    { light.powers(context, powers) } -> std::same_as<void>;
    // Empty for lights without a position.
    { light.bounds(context, part) } -> std::same_as<std::optional<LightBounds>>;
};

// A light that may move: its fields are in its own space, which a motion places in the world (Scene::motions);
// no_index: in the world, where it stands still. `moved` is the still light in the world when the motion has got
// to that transformation. The light of a shape moves with the shape instead.
template <typename L>
concept MovableLight = LightModel<L> && requires(const L& light, const Transform& world_from_light) {
    { light.motion } -> std::convertible_to<Index>;
    { light.moved(world_from_light) } -> std::same_as<L>;
};

// Declares the functions of LightModel in the struct of a light.
#define MONTELUX_LIGHT_MODEL                                                                                 \
    Index part_count(const LightContext& context) const;                                                     \
    std::optional<LightSample> sample_li(const LightContext& context, Index part,                            \
                                         const ReferencePoint& from, Vec2f u,                                \
                                         const SampledWavelengths& lambda) const;                            \
    float pdf_li(const LightContext& context, const ReferencePoint& from, const LightHit& hit) const;        \
    SampledSpectrum radiance(const LightContext& context, const ReferencePoint& from, const LightHit& hit,   \
                             const SampledWavelengths& lambda) const;                                        \
    std::optional<EmissionSample> sample_le(const LightContext& context, Index part, Vec2f u_position,       \
                                            Vec2f u_direction, const SampledWavelengths& lambda) const;      \
    EmissionPdf pdf_le(const LightContext& context, const LightHit& hit, Vec3f w) const;                     \
    void powers(const LightContext& context, std::span<double> parts) const;                                 \
    std::optional<LightBounds> bounds(const LightContext& context, Index part) const

} // namespace montelux
