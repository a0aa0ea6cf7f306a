// The templates of VolumePathIntegrator, for use with any random stream.
#pragma once

#include <algorithm>
#include <limits>

#include "montelux/mc/warp/sphere.h"
#include "montelux/scene/material/make_bsdf.h"
#include "montelux/scene/material/soft_terminator.h"
#include "montelux/transport/guiding/guided_scattering.h"
#include "montelux/transport/texture_footprint.h"
#include "montelux/transport/uniform_scattering.h"
#include "montelux/transport/volume_path_branches.h"
#include "montelux/transport/volume_path_integrator.h"

namespace montelux {

// Scattering events of a path inside translucent bodies. In a body without absorption that fills a half-space, one path
// in 500 is longer.
inline constexpr int most_body_events = 1 << 16;

// One path, or the branches of one.
template <RandomStream Stream>
class VolumePath : private VolumePathBranches<Stream> {
  public:
    VolumePath(const VolumePathIntegrator& integrator, const SceneView& scene, RayTracer& tracer,
               const CameraSample& camera, Stream& stream, PathRecord* record)
        : VolumePathBranches<Stream>(integrator.settings_, integrator.guide_, scene, tracer, camera, stream,
                                     record),
          integrator_(integrator) {}

    FilmContribution trace() {
        const SampledWavelengths lambda = state_.lambda;
        while (state_.alive || takes_up_branch()) {
            if (state_.trace != nullptr) [[unlikely]]
                state_.trace->arrive(state_.radiance);
            Hit hit;
            const bool found = tracer_.intersect(state_.ray, hit);
            if (state_.medium != no_index &&
                !passes_medium(found ? hit.t : std::numeric_limits<float>::infinity()))
                continue;
            if (found)
                shade(hit);
            else
                escape();
        }
        if (recorder_) recorder_.traced(state_.radiance);
        return {state_.radiance, lambda, state_.first, state_.transparency};
    }

  private:
    using Lights = VolumePathLights<Stream>;
    using Branches = VolumePathBranches<Stream>;
    using Branches::begin_guided;
    using Branches::body_events_;
    using Branches::end;
    using Branches::passages_;
    using Branches::split;
    using Branches::takes_up_branch;
    using Lights::add_met_light;
    using Lights::body_at;
    using Lights::guide_;
    using Lights::guide_at;
    using Lights::is_in_body;
    using Lights::recorder_;
    using Lights::sample_light;
    using Lights::sample_segment;
    using Lights::scene_;
    using Lights::settings_;
    using Lights::state_;
    using Lights::stream_;
    using Lights::tracer_;

    // Follows the ray through its medium. False if the path ended or scattered before that distance.
    bool passes_medium(float distance) {
        return std::visit([&](const auto& m) { return passes(m, distance); }, scene_.media[state_.medium]);
    }

    template <MediumModel M>
    bool passes(const M& medium, float distance) {
        auto local = medium.at(scene_, state_.medium, state_.lambda);
        if constexpr (M::homogeneous)
            if (medium.surface.is_given()) local.point = state_.body;
        const Ray ray{state_.ray.o, state_.ray.d, distance};
        if constexpr (M::homogeneous)
            if (is_black(local.point.sigma_s)) return absorbs(local.point, distance);
        SegmentLight segment = sample_segment(medium, local, ray);
        // Density of SegmentLight reaching a point of the ray, as r_u is that of the path: by ratio tracking in grids, 1
        // in homogeneous media.
        SampledSpectrum of_segment = state_.r_u;
        CollisionNumbers numbers(stream_);
        const auto collision = [&](float t, SampledSpectrum relative, SampledSpectrum majorant) {
            state_.take(relative);
            if constexpr (!M::homogeneous) of_segment *= relative;
            const Point3f p = ray.o + ray.d * t;
            const MediumPoint m = local.coefficients(p);
            const float hero = majorant[0];
            if (!is_black(m.emission))
                emit(state_.throughput * m.emission / (hero * average(state_.r_u * majorant / hero)));
            const float u = numbers.event() * hero, absorbed = m.sigma_a[0], scattered = m.sigma_s[0];
            if (u < absorbed) {
                if (recorder_)
                    recorder_.collided(ray, {.p = p, .sigma_a = m.sigma_a, .sigma_s = m.sigma_s},
                                       state_.carried());
                return end(PathEnd::absorbed);
            }
            if (M::homogeneous || u < absorbed + scattered) {
                if (!(scattered > 0)) return end(PathEnd::absorbed); // by rounding
                state_.take(m.sigma_s / scattered);
                segment.at = t - segment.start;
                state_.scatter(segment, of_segment,
                               M::homogeneous ? scattered * std::exp(-hero * t) : scattered);
                state_.distance += t;
                scatter(p, medium.phase, m);
                return false;
            }
            const SampledSpectrum null = clamp_zero(majorant - m.sigma_a - m.sigma_s);
            if (!(null[0] > 0)) return end(PathEnd::absorbed); // by rounding
            state_.throughput *= null / null[0];
            state_.r_u *= null / null[0];
            state_.r_l *= majorant / null[0];
            state_.r_s *= majorant / null[0];
            of_segment *= majorant / null[0];
            of_segment *= state_.rescale();
            return true;
        };
        const std::optional<SampledSpectrum> relative = track(local, ray, numbers, collision);
        if (!relative) return false;
        if constexpr (M::homogeneous) {
            // Light sampling computes this transmittance, so that its density is 1 at all wavelengths.
            const SampledSpectrum of_light = state_.r_l, of_last_segment = state_.r_s;
            state_.take(*relative);
            const float hero = local.point.sigma_a[0] + local.point.sigma_s[0];
            const float inverse = hero > 0 ? std::exp(hero * distance) : 1.0f;
            state_.r_l = of_light * inverse;
            state_.r_s = of_last_segment * inverse;
        } else {
            state_.take(*relative);
        }
        state_.rescale();
        return true;
    }

    // A homogeneous medium without scattering: all is known.
    bool absorbs(const MediumPoint& m, float distance) {
        const float finite = std::min(distance, std::numeric_limits<float>::max());
        const SampledSpectrum transmittance = exp(m.sigma_a * -finite);
        if (!is_black(m.emission))
            emit(state_.carried() * safe_div(m.emission, m.sigma_a) * one_minus_exp(m.sigma_a * finite));
        state_.throughput *= transmittance;
        if (is_black(transmittance)) return end(PathEnd::absorbed);
        return true;
    }

    // Of media: no strategy but following the path finds it.
    void emit(SampledSpectrum radiance) {
        if (settings_.strategy == Strategy::mis_light) return;
        state_.add(radiance, no_index);
        if (recorder_) recorder_.emitted(radiance);
    }

    void end_in_loop() {
        state_.radiance += SampledSpectrum(std::numeric_limits<float>::quiet_NaN()); // reported
        end(PathEnd::bad_throughput);
    }

    void scatter(Point3f p, const PhaseFunction& phase, const MediumPoint& m) {
        if (recorder_)
            recorder_.collided(state_.ray, {.p = p, .sigma_a = m.sigma_a, .sigma_s = m.sigma_s},
                               state_.carried());
        passages_ = 0;
        const bool in_body = is_in_body();
        if (in_body ? ++body_events_ == most_body_events : state_.depth++ == settings_.max_depth) {
            end(PathEnd::max_depth);
            return;
        }
        const Vec3f wo = -state_.ray.d;
        state_.previous = {p, {}, 0, Vec3f{}};
        const GuidingRegion* const region = in_body ? nullptr : guide_at(p, Facing::medium);
        if (!in_body &&
            !begin_guided(p, Facing::medium, false, region, [&] { return this->survival_of(*region); }))
            return;
        split(region, [&] { scatter_in_phase(p, wo, phase, region, in_body); });
    }

    void scatter_in_phase(Point3f p, Vec3f wo, const PhaseFunction& phase, const GuidingRegion* region,
                          bool in_body) {
        std::visit(
            [&](const PhaseModel auto& f) {
                if (!in_body)
                    sample_light(state_.medium, region, [&](Vec3f wi) {
                        const float pdf = f.pdf(wo, wi);
                        return BsdfEvaluation{SampledSpectrum(pdf), pdf};
                    });
                if (region != nullptr) {
                    const GuidedDirection d = sample_guided(f, p, wo, *region, stream_, state_.trace);
                    state_.bsdf_pdf = d.pdf;
                    state_.throughput *= d.weight;
                    continue_in_medium(p, d.wi);
                    return;
                }
                const Vec2f u = stream_.next_2d();
                Vec3f wi;
                if (settings_.strategy == Strategy::uniform) {
                    wi = sample_uniform_sphere(u);
                    state_.bsdf_pdf = inv_four_pi_f;
                    state_.throughput *= f.pdf(wo, wi) / inv_four_pi_f;
                } else {
                    const PhaseSample s = f.sample(wo, u);
                    wi = normalize(s.wi);
                    state_.bsdf_pdf = s.pdf;
                }
                if (state_.trace != nullptr && !in_body) [[unlikely]]
                    state_.trace->scatter(wi, state_.bsdf_pdf, state_.bsdf_pdf, 0);
                continue_in_medium(p, wi);
            },
            phase);
        state_.sees_lights = in_body;
        state_.scattered_roughly = true;
        state_.alive = survives(region != nullptr);
    }

    void continue_in_medium(Point3f p, Vec3f wi) {
        state_.ray.o = p;
        state_.ray.d = wi;
        state_.ray.t_max = std::numeric_limits<float>::infinity();
        if (recorder_) recorder_.scattered_in_medium(wi, state_.bsdf_pdf, state_.carried());
    }

    void shade(const Hit& hit) {
        const Vec3f w = state_.ray.d;
        const Index material = scene_.shapes[hit.shape].material;
        const bool interface = scene_.is_interface(hit.shape), textured = scene_.is_textured(material);
        SurfacePoint s =
            surface_point(scene_, state_.ray, hit, textured || scene_.frame_follows_tangents(material));
        if (recorder_) recorder_.hit_surface(state_.ray, hit, s, state_.carried());
        if (const Index light = scene_.light_at(hit); light != no_index)
            add_met_light(light, {.wi = w, .part = s.primitive, .p = s.p, .n = s.ng, .b = s.b});
        state_.distance += hit.t;
        if (interface) {
            leave(s, w);
            if (++passages_ == most_interfaces) end_in_loop();
            return;
        }
        const bool in_body = is_in_body();
        if (!in_body) state_.meet(hit);
        const bool last =
            in_body ? ++body_events_ == most_body_events : state_.depth++ == settings_.max_depth;
        const bool may_pass = !settings_.count_passages && !in_body;
        if (last && !may_pass) {
            end(PathEnd::max_depth);
            return;
        }
        state_.alive = false; // until the path continues
        const TextureContext context =
            textured ? texture_context(*integrator_.camera_, integrator_.footprint_scale_, s)
                     : TextureContext();
        const bool was_terminated = state_.lambda.secondary_terminated();
        const bool widen = settings_.regularize && state_.scattered_roughly;
        SurfaceBsdf surface = make_bsdf(scene_, s, -w, context, state_.lambda, widen);
        if (scene_.soft_terminator) [[unlikely]]
            soften_terminator(scene_, state_.ray, hit, context, state_.lambda, s, surface, widen);
        if (!was_terminated && state_.lambda.secondary_terminated()) state_.terminate_secondary();
        const Vec3f wo = surface.frame.to_local(-w);
        if (recorder_) recorder_.made_bsdf(surface, wo);
        if (state_.depth == 1 && !in_body && !state_.first.found)
            state_.first = {.albedo = albedo(surface.bsdf, wo),
                            .normal = surface.frame.n,
                            .depth = state_.distance,
                            .found = true};
        if (wo.z == 0) {
            end(PathEnd::grazing);
            return;
        }
        state_.previous = reference_point(s, surface, wo);
        state_.scatter(); // before lights are sampled: no SegmentLight finds this vertex
        const Facing facing = facing_of(dot(s.ng, w) < 0 ? s.ng : -s.ng);
        const bool guides =
            (guide_ != nullptr || state_.trace != nullptr) && !in_body && !last && !is_specular(surface.bsdf);
        const GuidingRegion* const region = guides ? guide_at(s.p, facing) : nullptr;
        const bool glossy = guides && is_glossy(surface.bsdf);
        if (guides && !begin_guided(s.p, facing, glossy, region, [&] {
                return glossy ? glossy_survival(surface.bsdf, wo, state_.depth) : this->survival_of(*region);
            }))
            return;
        // What a glossy surface scatters depends on the direction: the mean of its region is no judge of it.
        split(glossy ? nullptr : region, [&] { continue_from(s, surface, wo, context, region, last); });
    }

    // From a surface; `last`: unless the path passes it.
    void continue_from(const SurfacePoint& s, const SurfaceBsdf& surface, Vec3f wo,
                       const TextureContext& context, const GuidingRegion* region, bool last) {
        const bool in_body = is_in_body(), may_pass = !settings_.count_passages && !in_body;
        const std::optional<BsdfSample> scattered = std::visit(
            [&](const BsdfModel auto& bsdf) {
                if (!bsdf.is_specular() && !last)
                    sample_light(
                        state_.medium, region,
                        [&](Vec3f wi) {
                            return bsdf.evaluate(wo, surface.frame.to_local(wi), TransportMode::radiance,
                                                 stream_);
                        },
                        &s, &context);
                if (settings_.strategy == Strategy::uniform && !bsdf.is_specular())
                    return sample_uniform(bsdf, wo, stream_);
                if (region != nullptr)
                    return sample_guided(bsdf, surface.frame, s.p, wo, *region, stream_, state_.trace);
                const auto sample = bsdf.sample(wo, TransportMode::radiance, stream_);
                if (state_.trace != nullptr && !in_body && !last && sample && !sample->specular) [[unlikely]]
                    state_.trace->scatter(surface.frame.to_world(sample->wi), sample->pdf, sample->pdf, 0);
                return sample;
            },
            surface.bsdf);
        if (!scattered) {
            end(PathEnd::no_direction);
            return;
        }
        const Vec3f wi = surface.frame.to_world(scattered->wi);
        // As Mitsuba's flag Null of a sampled BSDF, which its volumetric integrators do not count.
        if (may_pass && scattered->specular && scattered->transmission && scattered->eta == 1) {
            --state_.depth;
            if (++passages_ == most_interfaces) return end_in_loop();
        } else {
            if (last) {
                end(PathEnd::max_depth);
                return;
            }
            passages_ = 0;
        }
        state_.throughput *= scattered->weight;
        state_.bsdf_pdf = scattered->pdf;
        state_.sees_lights = scattered->specular;
        if (!scattered->specular) state_.scattered_roughly = true;
        if (scattered->transmission) state_.roulette_scale *= scattered->eta * scattered->eta;
        if (recorder_) recorder_.scattered({*scattered, wi});
        leave(s, wi);
        if (scattered->transmission) state_.body = body_at(state_.medium, context);
        state_.alive = survives(region != nullptr);
    }

    // The ray continues from a surface in direction w.
    void leave(const SurfacePoint& s, Vec3f w) {
        state_.medium = medium_beyond(s, w, state_.medium);
        state_.ray.o = offset_origin(s.p, s.ng, s.error, w);
        state_.ray.d = normalize(w);
        state_.ray.t_max = std::numeric_limits<float>::infinity();
    }

    void escape() {
        if (recorder_) recorder_.left_scene(state_.ray, state_.carried());
        state_.leave(state_.carried());
        if (!integrator_.settings_.background || state_.depth > 0)
            for (Index light : scene_.light_tables.infinite_lights)
                add_met_light(light, {.wi = state_.ray.d});
        end(PathEnd::left_scene);
    }

    // Russian roulette on what the path carries to the film, or on what is left of it since the last vertex with a region;
    // none at one. Returns false if the path ends.
    bool survives(bool guided) {
        const float strength = state_.strength(state_.carried());
        if (!(strength > 0)) {
            // A NaN must not end silently: it makes the sample bad.
            state_.radiance += state_.carried();
            return end(is_black(state_.throughput) ? PathEnd::nothing_carried : PathEnd::bad_throughput);
        }
        if (state_.trace != nullptr) [[unlikely]]
            state_.trace->go_on(state_.radiance, strength, state_.depth);
        if (guided) {
            state_.guided_strength = strength;
            return true;
        }
        const float survival = state_.depth > 1 ? std::min(strength / state_.guided_strength, 1.0f) : 1;
        if (!this->lives(survival)) return false;
        if (state_.trace != nullptr) [[unlikely]]
            state_.trace->survive_on_throughput(survival);
        return true;
    }

    const VolumePathIntegrator& integrator_;
};

template <RandomStream Stream>
FilmContribution VolumePathIntegrator::estimate(const SceneView& scene, RayTracer& tracer,
                                                const CameraSample& camera, Stream& stream,
                                                PathRecord* record) const {
    return VolumePath<Stream>(*this, scene, tracer, camera, stream, record).trace();
}

} // namespace montelux
