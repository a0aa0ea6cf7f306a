// Light that reaches a point through media and interfaces.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "montelux/scene/medium/medium.h"
#include "montelux/scene/shape/surface_point.h"
#include "montelux/transport/medium_tracking.h"
#include "montelux/transport/ray_tracer.h"

namespace montelux {

// Surfaces that a straight line may pass without scattering: more would be a loop by rounding.
inline constexpr int most_interfaces = 1 << 16;

// The medium beyond a surface, in direction w.
inline Index medium_beyond(const SurfacePoint& s, Vec3f w, Index current) {
    const MediumInterface& media = s.shape->media;
    if (!media.is_transition()) return current;
    return dot(w, s.ng) > 0 ? media.outside : media.inside;
}

// An estimate of the transmittance of the first wavelength's walk at each of the wavelengths, and relative
// densities of that walk: the ones of VolumeState for the same line.
struct ShadowTransmittance {
    SampledSpectrum t{1};
    SampledSpectrum r_u{1}; // of delta tracking passing along the line
    SampledSpectrum r_l{1}; // of ratio tracking
};

namespace shadow_detail {

// Multiplies by a medium along a ray with a direction of unit length. False if nothing gets through. `body`: the
// coefficients of a body that vary over its surface.
template <MediumModel M, RandomStream Stream>
bool pass(const M& medium, const SceneView& scene, Index index, const SampledWavelengths& lambda,
          const Ray& ray, const MediumPoint& body, Stream& stream, ShadowTransmittance& through) {
    auto local = medium.at(scene, index, lambda);
    if constexpr (M::homogeneous) {
        if (medium.surface.is_given()) local.point = body;
        const SampledSpectrum sigma_t = local.point.sigma_a + local.point.sigma_s;
        const float distance = std::min(ray.t_max, std::numeric_limits<float>::max());
        const SampledSpectrum transmittance = exp(sigma_t * -distance);
        through.t *= transmittance;
        // Where nothing scatters, paths pass without sampling, too.
        if (!is_black(local.point.sigma_s)) through.r_u *= transmittance;
        return !is_black(through.t);
    } else {
        // Ratio tracking: Novak, Selle, Jarosz 2014, "Residual Ratio Tracking for Estimating Attenuation in
        // Participating Media".
        CollisionNumbers numbers(stream);
        const auto collision = [&](float t, SampledSpectrum relative, SampledSpectrum majorant) {
            const MediumPoint m = local.coefficients(ray.o + ray.d * t);
            const SampledSpectrum null = clamp_zero(majorant - m.sigma_a - m.sigma_s);
            const float inverse = 1 / majorant[0];
            const SampledSpectrum kept = relative * null * inverse;
            through.t *= kept;
            through.r_u *= kept;
            through.r_l *= relative * majorant * inverse;
            // Russian roulette on what is left.
            const float rest = max_value(through.t) / average(through.r_l + through.r_u);
            if (rest < 0.05f) {
                constexpr float survival = 0.25f;
                if (!(numbers.other() < survival)) through.t = {};
                through.t /= survival;
            }
            return !is_black(through.t);
        };
        const std::optional<SampledSpectrum> relative = track(local, ray, numbers, collision);
        if (!relative) return false;
        through.t *= *relative;
        through.r_u *= *relative;
        through.r_l *= *relative;
        return true;
    }
}

} // namespace shadow_detail

// Along the shadow ray of a light, which starts in `medium`. `body`: VolumeState::body of that medium. Empty if a surface or a medium blocks it.
template <RandomStream Stream>
std::optional<ShadowTransmittance> shadow_transmittance(const SceneView& scene, RayTracer& tracer, Ray ray,
                                                        Index medium, const SampledWavelengths& lambda,
                                                        Stream& stream, const MediumPoint& body = {}) {
    const bool finite = ray.t_max < std::numeric_limits<float>::infinity();
    const Point3f end = finite ? ray.o + ray.d : Point3f();
    std::optional<ShadowTransmittance> through(std::in_place);
    for (int i = 0; i < most_interfaces; ++i) {
        Hit hit;
        const bool found = tracer.intersect(ray, hit);
        if (found && !scene.is_interface(hit.shape)) return std::nullopt;
        if (medium != no_index) {
            const float scale = finite ? length(ray.d) : 1;
            if (!(scale > 0)) return through;
            const Ray part{ray.o, ray.d / scale, (found ? hit.t : ray.t_max) * scale};
            const bool passes = std::visit(
                [&](const auto& m) {
                    return shadow_detail::pass(m, scene, medium, lambda, part, body, stream, *through);
                },
                scene.media[medium]);
            if (!passes) return std::nullopt;
        }
        if (!found) return through;
        const SurfacePoint s = surface_point(scene, ray, hit, false);
        medium = medium_beyond(s, ray.d, medium);
        ray.o = offset_origin(s.p, s.ng, s.error, ray.d);
        if (!finite) continue;
        const Vec3f rest = end - ray.o;
        if (!(dot(rest, ray.d) > 0)) return through; // the interface lies at the light
        ray.d = rest;
    }
    through->t = SampledSpectrum(std::numeric_limits<float>::quiet_NaN()); // reported
    return through;
}

} // namespace montelux
