// The templates of PathIntegrator, for use with any random stream.
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "montelux/scene/material/make_bsdf.h"
#include "montelux/scene/material/soft_terminator.h"
#include "montelux/scene/shape/surface_point.h"
#include "montelux/transport/diffuse_lanes.h"
#include "montelux/transport/guiding/guided_scattering.h"
#include "montelux/transport/light_choice.h"
#include "montelux/transport/manifold/manifold_light.h"
#include "montelux/transport/path_integrator.h"
#include "montelux/transport/uniform_scattering.h"

namespace montelux {

// The scattering at one vertex of a path.
template <RandomStream Stream>
struct PathIntegrator::Vertex {
    const PathIntegrator& path;
    const SceneView& scene;
    PathState& state;
    Stream& stream;
    PathRecorder recorder;
    const Frame& frame;          // of the BSDF
    Vec3f wo;                    // in it
    const GuidingRegion* region; // null: directions are the BSDF's

    // Next-event estimation: one light, one point on it. Lights that scattering cannot find are sampled in
    // every strategy.
    template <BsdfModel B>
    void sample_light(const B& bsdf, std::optional<ShadowRay>& shadow) const {
        using Outcome = DirectLight::Outcome;
        if (scene.light_sampler->empty()) return;
        // Drawn by every path, so that those of a pixel stay stratified.
        const float u_survival = plays_light_roulette() ? stream.next_1d() : 0;
        const ChosenLight chosen = choose_light(scene, state.previous, state.ray.time, state.lambda, stream);
        const float choice = chosen.choice;
        const std::optional<LightSample>& light = chosen.sample;
        if (!light || (!light->invisible && !samples_lights(path.settings_))) {
            if (recorder)
                recorder.sampled_light({.outcome = light ? Outcome::left_to_scattering : Outcome::dark,
                                        .light = chosen.light,
                                        .part = chosen.part,
                                        .choice = choice});
            return;
        }
        const BsdfEvaluation e =
            bsdf.evaluate(wo, frame.to_local(light->wi), TransportMode::radiance, stream);
        const float light_pdf = choice * light->pdf;
        const float scatter_pdf =
            region == nullptr ? e.pdf : region->mixed_pdf(region->pdf(state.previous.p, light->wi), e.pdf);
        auto record = [&](Outcome outcome, float weight) {
            if (recorder)
                recorder.sampled_light({.outcome = outcome,
                                        .light = chosen.light,
                                        .part = chosen.part,
                                        .choice = choice,
                                        .delta = light->delta,
                                        .wi = light->wi,
                                        .shadow = light->shadow,
                                        .radiance = light->radiance,
                                        .f = e.f,
                                        .light_pdf = light_pdf,
                                        .bsdf_pdf = scatter_pdf,
                                        .weight = weight});
        };
        if (is_black(e.f) || is_black(light->radiance)) {
            record(Outcome::no_transport, 0);
            return;
        }
        const Strategy strategy = path.settings_.strategy;
        const auto weight_beside = [&](float pdf) {
            return light->invisible || strategy == Strategy::light
                       ? 1
                       : path_weight(path.settings_, light_pdf, pdf);
        };
        const float weight = weight_beside(scatter_pdf);
        if (strategy == Strategy::mis_bsdf) {
            record(Outcome::other_term, weight);
            return;
        }
        record(Outcome::counted, weight);
        if (state.trace != nullptr) [[unlikely]]
            state.trace->aim(weight, weight_beside(e.pdf));
        ShadowRay& ray = shadow.emplace();
        ray.ray = light->shadow;
        ray.ray.time = state.ray.time;
        ray.contribution = state.throughput * e.f * light->radiance * (weight / light_pdf);
        ray.light = chosen.light;
        if (!plays_light_roulette()) return;
        const float survival = guided_light_survival(*region, ray.contribution, state.expected);
        if (u_survival < survival)
            ray.contribution /= survival;
        else
            shadow.reset();
    }
    // The guide learns from all light samples which of them are occluded.
    bool plays_light_roulette() const { return region != nullptr && state.trace == nullptr; }

    template <BsdfModel B>
    std::optional<BsdfSample> sample_direction(const B& bsdf) const {
        if (path.settings_.strategy == Strategy::uniform && !bsdf.is_specular())
            return sample_uniform(bsdf, wo, stream);
        if (region != nullptr && !bsdf.is_specular())
            return sample_guided(bsdf, frame, state.previous.p, wo, *region, stream, state.trace);
        const std::optional<BsdfSample> s = bsdf.sample(wo, TransportMode::radiance, stream);
        if (state.trace != nullptr && s && !s->specular) [[unlikely]]
            state.trace->scatter(frame.to_world(s->wi), s->pdf, s->pdf, 0);
        return s;
    }

    // Russian roulette. Returns false if the path ends.
    bool lives(float survival) const {
        if (!(survival < 1)) return true;
        const float u = stream.next_1d();
        if (recorder) recorder.played_roulette({.survival = survival, .u = u});
        if (u < survival) {
            state.throughput /= survival;
            return true;
        }
        if (recorder) recorder.ended(PathEnd::roulette);
        return false;
    }
    // With a guide.
    bool lives_with_guide(float survival) const {
        if (!lives(survival)) return false;
        if (state.trace != nullptr) [[unlikely]]
            state.trace->survive(std::min(survival, 1.0f));
        return true;
    }
    // On the throughput to the film, or on what is left of it since the last vertex with a region; none at one.
    bool survives() const {
        const float strength = state.strength(state.throughput);
        if (!(strength > 0)) {
            // A NaN throughput must not end silently: it makes the sample bad.
            state.radiance += state.throughput;
            if (recorder)
                recorder.ended(is_black(state.throughput) ? PathEnd::nothing_carried
                                                          : PathEnd::bad_throughput);
            return false;
        }
        if (state.trace != nullptr) [[unlikely]]
            state.trace->go_on(state.radiance, strength, state.depth);
        if (region != nullptr) {
            state.guided_strength = strength;
            return true;
        }
        const float survival = state.depth > 1 ? std::min(strength / state.guided_strength, 1.0f) : 1;
        if (!lives(survival)) return false;
        if (state.trace != nullptr) [[unlikely]]
            state.trace->survive_on_throughput(survival);
        return true;
    }
};

template <RandomStream Stream>
std::optional<ShadowRay> PathIntegrator::shade(const SceneView& scene, PathState& state, const Hit& hit,
                                               Stream& stream, PathRecorder recorder,
                                               std::vector<PathBranch>* begun) const {
    std::optional<ShadowRay> shadow; // returned by every return statement: built in place
    const Vec3f w = state.ray.d;
    const Index material = scene.shapes[hit.shape].material;
    const bool textured = scene.is_textured(material);
    SurfacePoint s = surface_point(scene, state.ray, hit, textured || scene.frame_follows_tangents(material));
    if (recorder) recorder.hit_surface(state.ray, hit, s, state.throughput);
    state.meet(hit);
    if (state.trace != nullptr) [[unlikely]]
        state.trace->arrive(state.radiance);
    if (const Index light = scene.light_at(hit); light != no_index)
        add_met_light(scene, state, light, {.wi = w, .part = s.primitive, .p = s.p, .n = s.ng, .b = s.b},
                      recorder);
    state.alive = false; // until the path continues
    if (state.depth++ == settings_.max_depth) {
        if (recorder) recorder.ended(PathEnd::max_depth);
        return shadow;
    }

    const TextureContext context = textured ? texture_context(s) : TextureContext();
    const bool widen = settings_.regularize && state.scattered_roughly;
    const bool may_narrow = state.keeps_spectrum && !state.lambda.secondary_terminated();
    SurfaceBsdf surface = make_bsdf(scene, s, -w, context, state.lambda, widen);
    if (scene.soft_terminator) [[unlikely]]
        soften_terminator(scene, state.ray, hit, context, state.lambda, s, surface, widen);
    if (may_narrow && state.lambda.secondary_terminated()) [[unlikely]]
        state.throughput = SampledSpectrum(4 * state.throughput[0], 0, 0, 0);
    const Vec3f wo = surface.frame.to_local(-w);
    if (recorder) recorder.made_bsdf(surface, wo);
    if (state.depth == 1)
        state.first = {
            .albedo = albedo(surface.bsdf, wo), .normal = surface.frame.n, .depth = hit.t, .found = true};
    if (wo.z == 0) {
        if (recorder) recorder.ended(PathEnd::grazing);
        return shadow;
    }

    state.previous = reference_point(s, surface, wo);
    const Facing facing = facing_of(dot(s.ng, w) < 0 ? s.ng : -s.ng);
    const bool guides = (guide_ != nullptr || state.trace != nullptr) && !is_specular(surface.bsdf);
    const GuidingRegion* const region = guides && guide_ != nullptr ? guide_->find(s.p, facing) : nullptr;
    const bool glossy = guides && is_glossy(surface.bsdf);
    const Vertex<Stream> vertex{*this, scene, state, stream, recorder, surface.frame, wo, region};
    if (guides && state.trace != nullptr) [[unlikely]]
        state.trace->begin(s.p, facing, glossy, state.throughput, state.radiance);
    // What a glossy surface scatters depends on the direction: the mean of its region is no judge of it.
    const GuidingRegion* const judge = glossy ? nullptr : region;
    if (region != nullptr &&
        !vertex.lives_with_guide(judge != nullptr
                                     ? guided_survival(*judge, state.throughput, state.depth, state.expected)
                                     : glossy_survival(surface.bsdf, wo, state.depth)))
        return shadow;
    if constexpr (std::same_as<Stream, SampleStream>)
        if (judge != nullptr && begun != nullptr && state.trace == nullptr) {
            const int count = guided_branches(*judge, state.throughput, state.branches, state.expected);
            if (count > 1) state.split(count);
            for (int i = 1; i < count; ++i) {
                PathBranch& b = begun->emplace_back(PathBranch{state, stream.branch(i), std::nullopt});
                b.state.radiance = {};
                scatter(Vertex<Stream>{*this, scene, b.state, b.stream, recorder, surface.frame, wo, region},
                        s, hit, surface, b.shadow);
            }
        }
    scatter(vertex, s, hit, surface, shadow);
    return shadow;
}

template <RandomStream Stream>
void PathIntegrator::scatter(const Vertex<Stream>& vertex, const SurfacePoint& s, const Hit& hit,
                             const SurfaceBsdf& surface, std::optional<ShadowRay>& shadow) const {
    PathState& state = vertex.state;
    const std::optional<BsdfSample> scattered = std::visit(
        [&](const BsdfModel auto& bsdf) {
            if (!bsdf.is_specular()) vertex.sample_light(bsdf, shadow);
            return vertex.sample_direction(bsdf);
        },
        surface.bsdf);
    if (!scattered) {
        if (vertex.recorder) vertex.recorder.ended(PathEnd::no_direction);
        return;
    }
    state.throughput *= scattered->weight;
    state.bsdf_pdf = scattered->pdf;
    state.sees_lights = scattered->specular;
    if (casters_ != nullptr) [[unlikely]] {
        const bool joins = scattered->specular && state.chain == ManifoldChain::begun;
        const bool begins = !scattered->specular && !state.scatters_narrowly;
        state.chain = begins                                                          ? ManifoldChain::begun
                      : joins && hit.instance == no_index && casters_->has(hit.shape) ? ManifoldChain::joined
                                                                                      : ManifoldChain::none;
    }
    if (!scattered->specular) state.scattered_roughly = true;
    if (scattered->transmission) state.roulette_scale *= scattered->eta * scattered->eta;
    const Vec3f wi = surface.frame.to_world(scattered->wi);
    if (vertex.recorder) vertex.recorder.scattered({*scattered, wi});
    state.ray.o = offset_origin(s.p, s.ng, s.error, wi);
    state.ray.d = wi;
    state.ray.t_max = std::numeric_limits<float>::infinity();
    state.alive = vertex.survives();
}

template <RandomStream Stream>
void PathIntegrator::add_light_of_casters(const SceneView& scene, RayTracer& tracer, PathState& state,
                                          const Hit& hit, Stream& stream) const {
    if (state.depth + 2 > settings_.max_depth) return;
    add_manifold_light(*casters_, scene, tracer, state, hit, *camera_, footprint_scale_,
                       PhiloxStream::split(stream));
}

template <RandomStream Stream>
FilmContribution PathIntegrator::estimate(const SceneView& scene, RayTracer& tracer,
                                          const CameraSample& camera, Stream& stream,
                                          PathRecord* record) const {
    if constexpr (std::same_as<Stream, SampleStream>)
        if (guide_ != nullptr) { // several branches
            PathBatch batch;
            std::array starts{PathStart<Stream>{camera, stream}};
            std::array<FilmContribution, 1> result;
            estimate(scene, tracer, std::span<PathStart<Stream>>(starts), batch, result);
            stream = starts[0].stream;
            return result[0];
        }
    const PathRecorder recorder(record);
    PathState state(camera);
    while (state.alive) {
        Hit hit;
        if (!tracer.intersect(state.ray, hit)) {
            escape(scene, state, recorder);
            break;
        }
        if (casters_ != nullptr) [[unlikely]]
            add_light_of_casters(scene, tracer, state, hit, stream);
        const std::optional<ShadowRay> shadow = shade(scene, state, hit, stream, recorder);
        if (!shadow) continue;
        if (!tracer.occluded(shadow->ray))
            state.add(shadow->contribution, shadow->light);
        else if (recorder)
            recorder.occluded();
    }
    if (recorder) recorder.traced(state.radiance);
    return {state.radiance, state.lambda, state.first, state.transparency};
}

template <RandomStream Stream>
void PathIntegrator::estimate(const SceneView& scene, RayTracer& tracer, std::span<PathStart<Stream>> starts,
                              PathBatch& batch, std::span<FilmContribution> results) const {
    batch.reset(starts.size());
    for (const PathStart<Stream>& start : starts) {
        batch.alive.push_back(static_cast<Index>(batch.states.size()));
        batch.states.emplace_back(start.camera);
    }
    constexpr bool in_lanes = std::same_as<Stream, SampleStream>;
    const bool in_plain_lanes =
        settings_.strategy != Strategy::uniform && guide_ == nullptr && casters_ == nullptr;
    const auto sample_of = [&](Index i) {
        return i < starts.size() ? i : batch.origins[i - starts.size()].sample;
    };
    const auto stream_of = [&](Index i) -> Stream& {
        if constexpr (std::same_as<Stream, SampleStream>)
            if (i >= starts.size()) return batch.origins[i - starts.size()].stream;
        return starts[i].stream;
    };
    HitGroup<native_lanes> groups[2];
    constexpr std::array levels{LaneShading::all, LaneShading::scattering};
    while (!batch.alive.empty()) {
        batch.rays.clear();
        for (Index i : batch.alive) batch.rays.push_back(&batch.states[i].ray);
        tracer.intersect(batch.rays, std::span(batch.hits).first(batch.rays.size()));

        if (casters_ != nullptr) [[unlikely]]
            for (std::size_t k = 0; k < batch.alive.size(); ++k)
                if (const Index i = batch.alive[k]; batch.hits[k].shape != no_index)
                    add_light_of_casters(scene, tracer, batch.states[i], batch.hits[k], stream_of(i));

        batch.shadows.clear();
        batch.shadow_owners.clear();
        for (std::size_t k = 0; k < batch.alive.size(); ++k) {
            const Index i = batch.alive[k];
            PathState& state = batch.states[i];
            const Hit& hit = batch.hits[k];
            if (hit.shape == no_index) {
                escape(scene, state);
                continue;
            }
            if constexpr (in_lanes) {
                const LaneShading level = in_plain_lanes && batch.states[i].trace == nullptr
                                              ? lane_shading(scene, hit)
                                              : LaneShading::none;
                if (level != LaneShading::none) {
                    HitGroup<native_lanes>& group = groups[level == LaneShading::all ? 0 : 1];
                    group.add(i, state, hit, stream_of(i));
                    if (group.full()) shade_diffuse(scene, level, group, batch);
                    continue;
                }
            }
            const std::size_t begun = batch.begun.size();
            const auto shading = [&] {
                return shade(scene, state, hit, stream_of(i), PathRecorder(nullptr), &batch.begun);
            };
            if (batch.shadows.emplace_back(InPlace(shading)))
                batch.shadow_owners.push_back(i);
            else
                batch.shadows.pop_back();
            for (PathBranch& b : std::span(batch.begun).subspan(begun)) b.sample = sample_of(i);
        }
        if constexpr (in_lanes)
            for (std::size_t g = 0; g < levels.size(); ++g)
                if (groups[g].size > 0) shade_diffuse(scene, levels[g], groups[g], batch);

        if (!batch.begun.empty()) [[unlikely]]
            batch.take_branches();
        batch.rays.clear();
        for (const std::optional<ShadowRay>& shadow : batch.shadows) batch.rays.push_back(&shadow->ray);
        const std::span<bool> occluded(batch.occluded.get(), batch.rays.size());
        if (!batch.rays.empty()) tracer.occluded(batch.rays, occluded);
        for (std::size_t k = 0; k < occluded.size(); ++k)
            if (!occluded[k])
                batch.states[batch.shadow_owners[k]].add(batch.shadows[k]->contribution,
                                                         batch.shadows[k]->light);
        std::erase_if(batch.alive, [&](Index i) { return !batch.states[i].alive; });
    }
    // In the order in which a sample's branches began, which does not depend on other samples.
    for (std::size_t i = 0; i < batch.origins.size(); ++i)
        batch.states[batch.origins[i].sample].radiance += batch.states[starts.size() + i].radiance;
    for (std::size_t i = 0; i < starts.size(); ++i) {
        const PathState& state = batch.states[i];
        results[i] = {state.radiance, state.keeps_spectrum ? starts[i].camera.lambda : state.lambda,
                      state.first, state.transparency};
    }
}

} // namespace montelux
