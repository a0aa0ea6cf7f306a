// VolumePathLights: how a path through media finds light, by meeting lights and by sampling them.
#pragma once

#include <limits>
#include <optional>
#include <variant>

#include "montelux/scene/material/make_bsdf.h"
#include "montelux/transport/guiding/guided_scattering.h"
#include "montelux/transport/light_choice.h"
#include "montelux/transport/path_recorder.h"
#include "montelux/transport/path_weights.h"
#include "montelux/transport/shadow_transmittance.h"
#include "montelux/transport/volume_state.h"

namespace montelux {

// The part of VolumePath (volume_path.h) that adds the light of lamps to the path's radiance, with its weights.
template <RandomStream Stream>
class VolumePathLights {
  protected:
    VolumePathLights(const IntegratorSettings& settings, const GuidingField* guide, const SceneView& scene,
                     RayTracer& tracer, const CameraSample& camera, Stream& stream, PathRecord* record)
        : settings_(settings), guide_(guide), scene_(scene), tracer_(tracer), stream_(stream),
          recorder_(record), state_(camera, scene.camera_medium) {}

    // Null where directions are not drawn from the guide.
    const GuidingRegion* guide_at(Point3f p, Facing facing) const {
        return guide_ != nullptr ? guide_->find(p, facing) : nullptr;
    }
    // The density of a direction from p where scattering alone has the density `pdf`.
    static float mixed_pdf(const GuidingRegion* region, Point3f p, Vec3f wi, float pdf) {
        return region != nullptr ? region->mixed_pdf(region->pdf(p, wi), pdf) : pdf;
    }

    // A light that the state's ray hit.
    void add_met_light(Index light, const LightHit& hit) {
        const LightContext context{scene_, light, state_.ray.time};
        const SampledSpectrum le = incident_radiance(context, state_.previous, hit, state_.lambda);
        if (is_black(le)) return;
        const bool shared = !state_.sees_lights;
        const float ratio = average(state_.r_l) / average(state_.r_u);
        float pdf = 0;
        if (shared) {
            const float of_point = pdf_li(context, state_.previous, hit);
            pdf = joint_density(settings_,
                                scene_.light_sampler->probability(state_.previous, light, hit.part) *
                                    of_point * ratio,
                                segment_pdf(light, hit.part, of_point));
        }
        const float weight = shared ? hit_weight(settings_, state_.bsdf_pdf, pdf) : 1;
        const bool counted = settings_.strategy != Strategy::mis_light;
        if (recorder_)
            recorder_.found_light({.light = light,
                                   .part = hit.part,
                                   .radiance = le,
                                   .shared = shared,
                                   .bsdf_pdf = shared ? state_.bsdf_pdf : 0,
                                   .light_pdf = pdf,
                                   .weight = weight,
                                   .counted = counted});
        if (state_.trace != nullptr && shared) [[unlikely]]
            state_.trace->meet_light(
                state_.carried() * le, weight,
                counted ? hit_weight(settings_, state_.trace->unguided_pdf(state_.bsdf_pdf), pdf) : weight);
        if (counted) state_.add(state_.carried() * le * weight, light);
    }

    // Next-event estimation from a point of the ray that is chosen for a lamp (SegmentLight). Returns what its
    // density at other points follows from.
    template <MediumModel M, SampledMedium S>
    SegmentLight sample_segment(const M& medium, const S& sampled, const Ray& ray) {
        using Outcome = DirectLight::Outcome;
        if (scene_.segment_lights == nullptr || !settings_.equiangular || !samples_lights(settings_) ||
            state_.depth >= settings_.max_depth)
            return {};
        if constexpr (M::homogeneous)
            if (medium.is_body) return {};
        const MediumExtent extent = medium_extent<M>(sampled, ray);
        if (extent.empty()) return {};
        SegmentLight segment{ray.o + ray.d * extent.t0, ray.d, extent.t1 - extent.t0, extent.extinction,
                             extent.t0};
        segment.time = state_.ray.time;
        const Vec2f u = stream_.next_2d(), of_light = stream_.next_2d();
        const LightChoice chosen = segment.choose(scene_, stream_.refined(u.x));
        const auto distances = segment.distances(scene_, chosen.light, chosen.part);
        if (!distances) return segment;
        segment.at = distances->sample(u.y);
        const float choice = chosen.probability * distances->pdf(segment.at);
        if (!(choice > 0 && segment.at < segment.length)) return segment;
        const float distance = segment.start + segment.at;
        const ReferencePoint here{ray.o + ray.d * distance};
        const std::optional<LightSample> light =
            sample_li({scene_, chosen.light, segment.time}, chosen.part, here, of_light, state_.lambda);
        if (!light) return segment;
        const float phase =
            std::visit([&](const PhaseModel auto& f) { return f.pdf(-ray.d, light->wi); }, medium.phase);
        const MediumPoint m = sampled.coefficients(here.p);
        DirectLight record{.outcome = Outcome::no_transport,
                           .light = chosen.light,
                           .part = chosen.part,
                           .choice = chosen.probability,
                           .delta = light->delta,
                           .wi = light->wi,
                           .shadow = light->shadow,
                           .radiance = light->radiance,
                           .f = m.sigma_s * phase};
        const auto finish = [&](Outcome outcome) {
            record.outcome = outcome;
            if (recorder_) recorder_.sampled_light_on_ray(distance, record, state_.carried());
            return segment;
        };
        if (is_black(record.f) || is_black(light->radiance)) return finish(Outcome::no_transport);
        ShadowTransmittance to_here; // nothing is in the way
        if (!shadow_detail::pass(medium, scene_, state_.medium, state_.lambda, Ray{ray.o, ray.d, distance},
                                 {}, stream_, to_here))
            return finish(Outcome::occluded);
        Ray shadow = light->shadow;
        shadow.time = state_.ray.time;
        const std::optional<ShadowTransmittance> through =
            shadow_transmittance(scene_, tracer_, shadow, state_.medium, state_.lambda, stream_);
        if (!through) return finish(Outcome::occluded);
        const float before = average(state_.r_u);
        record.f *= to_here.t;
        record.radiance *= through->t;
        record.light_pdf = choice * light->pdf * average(state_.r_u * to_here.r_l * through->r_l) / before;
        // The free flight that ends here, with light sampling or scattering.
        const bool alone = light->invisible || settings_.strategy == Strategy::light;
        const SampledSpectrum flight = state_.r_u * m.sigma_s * to_here.r_u;
        record.other_pdf = scene_.light_sampler->probability(here, chosen.light, chosen.part) * light->pdf *
                           average(flight * through->r_l) / before;
        const float scatter_pdf = mixed_pdf(guide_at(here.p, Facing::medium), here.p, light->wi, phase);
        record.bsdf_pdf = alone ? 0 : scatter_pdf * average(flight * through->r_u) / before;
        record.weight = path_weight(settings_, record.light_pdf,
                                    joint_density(settings_, record.bsdf_pdf, record.other_pdf));
        if (settings_.strategy == Strategy::mis_bsdf) return finish(Outcome::other_term);
        state_.add(state_.carried() * record.f * record.radiance * (record.weight / record.light_pdf),
                   chosen.light, 1);
        return finish(Outcome::counted);
    }

    // Density of SegmentLight finding the last vertex and, from there, a point of a light that light sampling
    // finds with density `pdf`: per solid angle, relative to the path's density.
    float segment_pdf(Index light, Index part, float pdf,
                      SampledSpectrum through = SampledSpectrum(1)) const {
        const float choice = state_.segment.length > 0 ? state_.segment.pdf(scene_, light, part) : 0;
        return choice > 0 ? choice * pdf * average(state_.r_s * through) / average(state_.r_u) : 0;
    }

    // Next-event estimation: one light, one point on it. evaluate(wi) gives value and density of scattering, which
    // has that of `region` besides.
    // `surface` and `context`: of what scatters, if it is no medium.
    template <typename Evaluate>
    void sample_light(Index medium, const GuidingRegion* region, const Evaluate& evaluate,
                      const SurfacePoint* surface = nullptr, const TextureContext* context = nullptr) {
        using Outcome = DirectLight::Outcome;
        if (scene_.light_sampler->empty()) return;
        // Drawn by every path, so that those of a pixel stay stratified. The guide learns from all light samples which of
        // them are occluded.
        const bool plays_roulette = region != nullptr && state_.trace == nullptr;
        const float u_survival = plays_roulette ? stream_.next_1d() : 0;
        const ChosenLight chosen =
            choose_light(scene_, state_.previous, state_.ray.time, state_.lambda, stream_);
        const std::optional<LightSample>& light = chosen.sample;
        DirectLight record{.light = chosen.light, .part = chosen.part, .choice = chosen.choice};
        const auto finish = [&](Outcome outcome) {
            record.outcome = outcome;
            if (recorder_) recorder_.sampled_light(record);
        };
        if (!light || (!light->invisible && !samples_lights(settings_)))
            return finish(light ? Outcome::left_to_scattering : Outcome::dark);
        const BsdfEvaluation e = evaluate(light->wi);
        record.delta = light->delta;
        record.wi = light->wi;
        record.shadow = light->shadow;
        record.radiance = light->radiance;
        record.f = e.f;
        record.bsdf_pdf = mixed_pdf(region, state_.previous.p, light->wi, e.pdf);
        record.light_pdf = chosen.choice * light->pdf;
        if (is_black(e.f) || is_black(light->radiance)) return finish(Outcome::no_transport);
        if (state_.trace != nullptr) [[unlikely]]
            state_.trace->aim(1, 1);
        float survival = 1; // of Russian roulette
        if (plays_roulette) {
            survival = guided_light_survival(
                *region, state_.carried() * e.f * light->radiance / record.light_pdf, state_.expected);
            if (!(u_survival < survival)) return finish(Outcome::occluded);
        }
        if (surface != nullptr) medium = medium_beyond(*surface, light->wi, medium);
        Ray shadow = light->shadow;
        shadow.time = state_.ray.time;
        const MediumPoint body =
            context != nullptr && medium != state_.medium ? body_at(medium, *context) : state_.body;
        const std::optional<ShadowTransmittance> through =
            shadow_transmittance(scene_, tracer_, shadow, medium, state_.lambda, stream_, body);
        if (!through) return finish(Outcome::occluded);
        // Densities relative to that of the path so far, averaged over the wavelengths.
        const float before = average(state_.r_u);
        record.radiance *= through->t;
        record.bsdf_pdf *= average(state_.r_u * through->r_u) / before;
        record.light_pdf *= average(state_.r_u * through->r_l) / before;
        const bool alone = light->invisible || settings_.strategy == Strategy::light;
        record.other_pdf = segment_pdf(chosen.light, chosen.part, light->pdf, through->r_l);
        const auto weight_beside = [&](float scatter_pdf) {
            const float others = joint_density(settings_, alone ? 0 : scatter_pdf, record.other_pdf);
            return alone && others == 0 ? 1 : path_weight(settings_, record.light_pdf, others);
        };
        record.weight = weight_beside(record.bsdf_pdf);
        if (state_.trace != nullptr && record.bsdf_pdf > 0) [[unlikely]]
            state_.trace->aim(record.weight,
                              weight_beside(e.pdf * average(state_.r_u * through->r_u) / before));
        if (settings_.strategy == Strategy::mis_bsdf) return finish(Outcome::other_term);
        finish(Outcome::counted);
        state_.add(state_.carried() * e.f * record.radiance * (record.weight / (record.light_pdf * survival)),
                   chosen.light);
    }

    // What surrounds the ray is the inside of a translucent body.
    bool is_in_body() const {
        if (state_.medium == no_index) return false;
        const auto* medium = std::get_if<HomogeneousMedium>(&scene_.media[state_.medium]);
        return medium != nullptr && medium->is_body;
    }

    // The coefficients of a body below a surface point; those of the path where they do not vary.
    MediumPoint body_at(Index medium, const TextureContext& context) const {
        if (medium == no_index) return state_.body;
        const auto* m = std::get_if<HomogeneousMedium>(&scene_.media[medium]);
        if (m == nullptr || !m->surface.is_given()) return state_.body;
        return m->surface.at(scene_, context, state_.lambda);
    }

    const IntegratorSettings& settings_;
    const GuidingField* guide_;
    const SceneView& scene_;
    RayTracer& tracer_;
    Stream& stream_;
    PathRecorder recorder_;
    VolumeState state_;
};

} // namespace montelux
