// The walk of a subpath through media and interfaces to its next vertex.
#pragma once

#include <cmath>
#include <limits>

#include "montelux/scene/medium/medium.h"
#include "montelux/transport/medium_tracking.h"
#include "montelux/transport/ray_tracer.h"
#include "montelux/transport/subpath.h"

namespace montelux {

namespace subpath_detail {

enum class Flight { passed, scattered, ended };

// A homogeneous medium without scattering: all is known.
template <typename Events>
Flight absorb(const MediumPoint& m, float distance, SubpathEnd& end, Events& events) {
    const float finite = std::min(distance, std::numeric_limits<float>::max());
    if (!is_black(m.emission))
        events.emitted(end,
                       end.carried() * safe_div(m.emission, m.sigma_a) * one_minus_exp(m.sigma_a * finite));
    const SampledSpectrum transmittance = exp(m.sigma_a * -finite);
    end.throughput *= transmittance;
    return is_black(transmittance) ? Flight::ended : Flight::passed;
}

// Follows the ray through its medium up to a distance, or to a scattering event at `p`, by delta tracking at the
// extinction of the first wavelength, as VolumePath does.
template <MediumModel M, RandomStream Stream, typename Events>
Flight fly(const M& medium, const SceneView& scene, float distance, SubpathEnd& end, Stream& stream,
           Events& events, Point3f& p) {
    const auto local = medium.at(scene, end.medium, end.lambda);
    const Ray ray{end.ray.o, end.ray.d, distance};
    if constexpr (M::homogeneous)
        if (is_black(local.point.sigma_s)) return absorb(local.point, distance, end, events);
    CollisionNumbers numbers(stream);
    Flight flight = Flight::ended;
    // Of homogeneous media: joining has the same density at all distances.
    const SampledSpectrum joined = end.edge.joined;
    const auto collision = [&](float t, SampledSpectrum relative, SampledSpectrum majorant) {
        end.take(relative);
        p = ray.o + ray.d * t;
        const MediumPoint m = local.coefficients(p);
        const float hero = majorant[0];
        if (!is_black(m.emission))
            events.emitted(end,
                           end.throughput * m.emission / (hero * average(end.density * majorant / hero)));
        const float u = numbers.event() * hero, absorbed = m.sigma_a[0], scattered = m.sigma_s[0];
        if (u < absorbed) return false;
        if (M::homogeneous || u < absorbed + scattered) {
            if (!(scattered > 0)) return false; // by rounding
            if constexpr (M::homogeneous) end.edge.joined = joined * std::exp(hero * t);
            end.take(m.sigma_s / scattered);
            flight = Flight::scattered;
            return false;
        }
        const SampledSpectrum null = clamp_zero(majorant - m.sigma_a - m.sigma_s);
        if (!(null[0] > 0)) return false; // by rounding
        const SampledSpectrum of_joining = end.edge.joined * (majorant / null[0]);
        end.take(null / null[0]);
        end.edge.joined = of_joining;
        end.rescale();
        return true;
    };
    const std::optional<SampledSpectrum> relative = track(local, ray, numbers, collision);
    if (relative) {
        flight = Flight::passed;
        end.take(*relative);
        if constexpr (M::homogeneous) {
            const float hero = local.point.sigma_a[0] + local.point.sigma_s[0];
            end.edge.joined = hero > 0 ? joined * std::exp(hero * distance) : joined;
        }
    }
    end.rescale();
    return flight;
}

} // namespace subpath_detail

// Follows the ray of `end` to the next vertex and adds it to the path: a scattering event in a medium, or a surface
// without its BSDF. Null if the subpath ends. Events:
//   passed(end, surface, hit)  an interface
//   met(end, hit)              the surface where it ends
//   left(end)                  the scene ends
//   emitted(end, radiance)     a medium shines; weighted over the wavelengths
//   looped()                   too many interfaces
template <RandomStream Stream, typename Events>
SubpathVertex* walk_to_vertex(std::vector<SubpathVertex>& path, const SceneView& scene, RayTracer& tracer,
                              SubpathEnd& end, Stream& stream, Events& events) {
    using subpath_detail::Flight;
    for (int passages = 0; passages < most_interfaces; ++passages) {
        Hit hit;
        const bool found = tracer.intersect(end.ray, hit);
        if (end.medium != no_index) {
            const float distance = found ? hit.t : std::numeric_limits<float>::infinity();
            Point3f p;
            const Medium& medium = scene.media[end.medium];
            const Flight flight = std::visit(
                [&](const auto& m) {
                    return subpath_detail::fly(m, scene, distance, end, stream, events, p);
                },
                medium);
            if (flight == Flight::ended) return nullptr;
            if (flight == Flight::scattered)
                return &add_vertex(
                    path, end, p,
                    std::visit([](const auto& m) -> const PhaseFunction& { return m.phase; }, medium));
        }
        if (!found) {
            events.left(end);
            return nullptr;
        }
        if (!scene.is_interface(hit.shape)) {
            events.met(end, hit);
            return &add_vertex(path, scene, end, hit);
        }
        const SurfacePoint s = surface_point(scene, end.ray, hit, false);
        events.passed(end, s, hit);
        end.distance += hit.t;
        end.medium = medium_beyond(s, end.ray.d, end.medium);
        end.ray.o = offset_origin(s.p, s.ng, s.error, end.ray.d);
    }
    events.looped();
    return nullptr;
}

// The medium in which a ray of light starts, at a light or at infinity: that on this side of the first surface which
// separates media, as next-event estimation has it; if the ray meets none, that to which the way from the camera leads.
// `camera`: a ray from the camera.
Index medium_at_light(const SceneView& scene, RayTracer& tracer, const Ray& light, const Ray& camera);

} // namespace montelux
