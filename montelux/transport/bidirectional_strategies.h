// BidirectionalStrategies: the ways to find a path by the subpaths of a sample, with their weights.
#pragma once

#include <algorithm>
#include <optional>

#include "montelux/scene/light/shadow_ray.h"
#include "montelux/transport/bidirectional_integrator.h"
#include "montelux/transport/found_path.h"
#include "montelux/transport/light_choice.h"
#include "montelux/transport/shadow_transmittance.h"

namespace montelux {

// The part of BidirectionalSample (bidirectional_sample.h) that adds light to the pixel and to the film.
template <RandomStream Stream>
class BidirectionalStrategies {
  protected:
    using Vertices = std::vector<SubpathVertex>;

    BidirectionalStrategies(const BidirectionalIntegrator& integrator, const SceneView& scene,
                            RayTracer& tracer, const CameraSample& camera, Stream& stream,
                            BidirectionalMemory& memory, const PathObserver* observer)
        : integrator_(integrator), settings_(integrator.settings_), scene_(scene), tracer_(tracer),
          camera_(camera), stream_(stream), memory_(memory), observer_(observer),
          splats_(camera.splats != nullptr ? *camera.splats : memory.ignored), time_(camera.ray.time),
          all_strategies_(settings_.method == IntegratorKind::bidirectional), volumes_(integrator.volumes_),
          area_paths_(integrator.map_ != nullptr ? integrator.map_->area_paths() : 0) {}

    // Of the vertex before number i (from 1), given a density per solid angle at that.
    float density_of_previous(const Vertices& path, std::size_t i, TransportMode mode, float pdf) const {
        const SubpathVertex& v = path[i - 1];
        if (i > 1) return path[i - 2].per_area(pdf, v.w, v.distance2);
        return mode == TransportMode::importance ? end_.of_light(pdf, v.w, v.distance2) : 0;
    }

    // s = 0: ray number k of the camera's path meets a light. `density`: of the light's point or direction.
    // `edge` and so on: of the camera's path up to there.
    void meet_light(Index light, const LightHit& hit, const EdgeDensity& edge, SampledSpectrum throughput,
                    const SampledWavelengths& lambda, std::size_t k, float density) {
        const ReferencePoint previous =
            k > 1 ? memory_.camera[k - 2].reference(memory_.camera[k - 2].wo) : ReferencePoint{camera_.ray.o};
        const SampledSpectrum le = incident_radiance({scene_, light, time_}, previous, hit, lambda);
        if (is_black(le)) return;
        const std::size_t t = k + 1;
        LightEnd end = end_at(scene_, time_, light, hit, -hit.wi);
        PathDensities& d = memory_.densities;
        fill(0, t);
        if (k > 1) {
            const SubpathVertex& v = memory_.camera[k - 2];
            const float distance2 = length_squared(hit.p - v.s.p);
            d.from_light[0] = double(end.emission);
            d.from_light[1] = double(end.edge_density(v.cosine(hit.wi), distance2));
            d.from_camera[0] = double(density);
            d.next_event = double(next_event_density(scene_, time_, end, previous, -hit.wi, distance2));
        }
        if (volumes_) memory_.edges[0] = edge;
        add(end, 0, t, throughput * le, lambda);
    }

    // s = 1: next-event estimation at vertex k of the camera's path.
    void sample_light(std::size_t k) {
        if (scene_.light_sampler->empty()) return;
        const SubpathVertex& v = memory_.camera[k - 1];
        const ReferencePoint here = v.reference(v.wo);
        const ChosenLight chosen = choose_light(scene_, here, time_, v.lambda, stream_);
        if (!chosen.sample) return;
        const LightSample& light = *chosen.sample;
        const Vec3f wi = v.surface.frame.to_local(light.wi);
        const BsdfEvaluation e = v.evaluate(v.wo, wi, TransportMode::radiance, stream_);
        const float light_pdf = chosen.choice * light.pdf;
        const SampledSpectrum value = v.throughput * e.f * light.radiance / light_pdf;
        if (is_black(value)) return;
        const auto through = transmittance(light.shadow, v, light.wi, v.lambda);
        if (!through) return;
        LightEnd end = end_at(scene_, time_, chosen.light,
                              {.wi = light.wi, .part = chosen.part, .p = light.p, .n = light.n, .b = light.b},
                              -light.wi);
        end.invisible = light.invisible;
        const Point3f at = end.kind == LightKind::position ? light.shadow.o + light.shadow.d : light.p;
        const float distance2 = end.at_infinity() ? 1 : length_squared(at - v.s.p);
        PathDensities& d = memory_.densities;
        fill(1, k + 1);
        d.from_light[0] = double(end.emission);
        d.from_light[1] = double(end.edge_density(v.cosine(light.wi), distance2));
        d.from_camera[0] = end.invisible ? 0 : double(end.of_light(e.pdf, -light.wi, distance2));
        d.next_event = double(end.of_light(light_pdf, -light.wi, distance2));
        d.delta[1] = 0;
        if (k > 1) {
            const float back = v.evaluate(wi, v.wo, TransportMode::importance, stream_).pdf;
            d.from_light[2] = double(density_of_previous(memory_.camera, k, TransportMode::radiance, back));
        }
        add(end, 1, k + 1, value, v.lambda, &*through);
    }

    // t = 1: vertex j of the light's path seen from the lens.
    void join_lens(std::size_t j) {
        const SubpathVertex& y = memory_.light[j - 1];
        if (!y.connectible) return;
        const Camera& camera = *integrator_.camera_;
        const Vec2f lens = camera.has_lens() ? stream_.next_2d() : Vec2f{0.5f, 0.5f};
        const std::optional<CameraConnection> seen = camera.sample_wi(y.s.p, lens, time_);
        if (!seen || !integrator_.on_film(seen->film)) return;
        const Vec3f wi = y.surface.frame.to_local(seen->wi);
        const BsdfEvaluation e = y.evaluate(y.wo, wi, TransportMode::importance, stream_);
        const SampledSpectrum value = y.throughput * e.f * (y.adjoint_correction(wi) * seen->density);
        if (is_black(value)) return;
        const Point3f o = offset_origin(y.s.p, y.s.ng, y.s.error, seen->wi);
        const auto through = transmittance({o, seen->lens - o, 1}, y, seen->wi, y.lambda);
        if (!through) return;
        lens_ = seen->lens;
        const std::size_t s = j + 1;
        fill(s, 1);
        PathDensities& d = memory_.densities;
        d.from_camera[j] = double(seen->density * y.cosine(seen->wi));
        d.delta[j] = 0;
        const float back = y.evaluate(wi, y.wo, TransportMode::radiance, stream_).pdf;
        set_before_light_vertex(j, back);
        add(end_, s, 1, value, y.lambda, &*through, &seen->film);
    }

    // Vertex j of the light's path with vertex k of the camera's.
    void join(std::size_t j, std::size_t k) {
        const SubpathVertex &y = memory_.light[j - 1], &z = memory_.camera[k - 1];
        if (!y.connectible || !z.connectible) return;
        const Vec3f across = y.s.p - z.s.p;
        const float distance2 = length_squared(across);
        if (!(distance2 > 0)) return;
        const Vec3f w = across / std::sqrt(distance2); // from z to y
        const Vec3f wz = z.surface.frame.to_local(w), wy = y.surface.frame.to_local(-w);
        const BsdfEvaluation at_z = z.evaluate(z.wo, wz, TransportMode::radiance, stream_);
        if (is_black(at_z.f)) return;
        const BsdfEvaluation at_y = y.evaluate(y.wo, wy, TransportMode::importance, stream_);
        const SampledSpectrum value =
            z.throughput * at_z.f * at_y.f * y.throughput * (y.adjoint_correction(wy) / distance2);
        if (is_black(value)) return;
        const SampledWavelengths& lambda = z.lambda.secondary_terminated() ? z.lambda : y.lambda;
        const ReferencePoint from{z.s.p, z.s.ng, z.s.error, Vec3f{}};
        const auto through = transmittance(shadow_ray(from, w, y.s.p, y.s.ng, y.s.error), z, w, lambda);
        if (!through) return;
        const std::size_t s = j + 1, t = k + 1;
        fill(s, t);
        PathDensities& d = memory_.densities;
        d.from_light[s] = double(z.per_area(at_y.pdf, w, distance2));
        d.from_camera[j] = double(y.per_area(at_z.pdf, w, distance2));
        d.delta[j] = d.delta[s] = 0;
        const float back_y = y.evaluate(wy, y.wo, TransportMode::radiance, stream_).pdf;
        set_before_light_vertex(j, back_y);
        if (k > 1) {
            const float back_z = z.evaluate(wz, z.wo, TransportMode::importance, stream_).pdf;
            d.from_light[s + 1] =
                double(density_of_previous(memory_.camera, k, TransportMode::radiance, back_z));
        }
        add(end_, s, t, value, lambda, &*through);
    }

    const BidirectionalIntegrator& integrator_;
    const IntegratorSettings& settings_;
    const SceneView& scene_;
    RayTracer& tracer_;
    const CameraSample& camera_;
    Stream& stream_;
    BidirectionalMemory& memory_;
    const PathObserver* observer_;
    SplatList& splats_;
    float time_;
    bool all_strategies_;
    bool volumes_;             // the scene has media or interfaces
    double area_paths_;        // LightMap::area_paths; 0 without merging
    LightEnd end_;             // of the light's path
    float end_next_event_ = 0; // PathDensities::next_event of it
    Point3f lens_;             // of the last splat
    SampledSpectrum radiance_{};

    // What the camera's subpath knows of the densities of a path of n vertices: of those before its vertex v_first.
    void fill_camera_side(std::size_t n, std::size_t first) {
        PathDensities& d = memory_.densities;
        for (std::size_t k = 1; k + first < n; ++k) {
            const SubpathVertex& z = memory_.camera[k - 1];
            const std::size_t i = n - 1 - k;
            d.from_camera[i] = double(z.forward);
            d.delta[i] = z.delta ? 1 : 0;
            if (area_paths_ > 0) d.merging[i] = area_paths_at(i, z.phase != nullptr);
            if (k > 1) d.from_light[i + 1] = double(z.backward);
            if (volumes_) memory_.edges[i] = z.edge;
        }
        d.light_paths = integrator_.light_paths_;
    }
    void reset_densities(std::size_t n) {
        memory_.densities.reset(n);
        if (volumes_) memory_.edges.resize(n - 1);
        if (area_paths_ > 0) memory_.densities.merging.assign(n - 1, 0);
    }
    // PathDensities::merging of v_i.
    double area_paths_at(std::size_t i, bool in_medium) const {
        return i >= 2 && !in_medium ? area_paths_ : 0;
    }

  private:
    void set_before_light_vertex(std::size_t j, float pdf) {
        const float density = density_of_previous(memory_.light, j, TransportMode::importance, pdf);
        memory_.densities.from_camera[j - 1] = j == 1 && end_.invisible ? 0 : double(density);
    }

    // What the two subpaths know of the densities of a path: all but what depends on its joint.
    void fill(std::size_t s, std::size_t t) {
        const std::size_t n = s + t;
        PathDensities& d = memory_.densities;
        reset_densities(n);
        if (s >= 2) {
            d.from_light[0] = double(end_.emission);
            d.next_event = double(end_next_event_);
        }
        for (std::size_t j = 1; j < s; ++j) {
            const SubpathVertex& y = memory_.light[j - 1];
            d.from_light[j] = double(y.forward);
            d.delta[j] = y.delta ? 1 : 0;
            if (area_paths_ > 0) d.merging[j] = area_paths_at(j, y.phase != nullptr);
            if (j > 1 || !end_.invisible) d.from_camera[j - 1] = double(y.backward);
            if (volumes_) memory_.edges[j - 1] = y.edge;
        }
        fill_camera_side(n, std::max<std::size_t>(s, 1));
    }

    // Along a ray from a vertex, in direction w. Empty if it is blocked.
    std::optional<ShadowTransmittance> transmittance(Ray ray, const SubpathVertex& from, Vec3f w,
                                                     const SampledWavelengths& lambda) {
        ray.time = time_;
        if (volumes_)
            return shadow_transmittance(scene_, tracer_, ray, from.medium_towards(w), lambda, stream_);
        if (tracer_.occluded(ray)) return std::nullopt;
        return ShadowTransmittance();
    }

    // The path's contribution, but for the transmittance of the joined edge; a splat where `film` is not null.
    void add(const LightEnd& end, std::size_t s, std::size_t t, SampledSpectrum value,
             const SampledWavelengths& lambda, const ShadowTransmittance* joint = nullptr,
             const Point2f* film = nullptr) {
        PathDensities& d = memory_.densities;
        if (volumes_) {
            if (joint != nullptr) {
                value *= joint->t;
                memory_.edges[s - 1] = {joint->r_u, joint->r_l};
            }
            media_factors(memory_.edges, lambda.secondary_terminated(), d.media, memory_.scratch);
            value /= static_cast<float>(d.media[s]);
        }
        const double weight =
            all_strategies_ ? strategy_weight(d, s, settings_.heuristic, memory_.scratch) : 1;
        if (lambda.secondary_terminated()) value = SampledSpectrum(4 * value[0], 0, 0, 0);
        if (observer_ != nullptr) [[unlikely]] {
            const std::size_t light = s > 0 ? s - 1 : 0, camera = s > 0 ? t - 1 : t - 2;
            observer_->found(observer_->self,
                             {s, t, end, std::span(memory_.light).first(light),
                              std::span(memory_.camera).first(camera),
                              film != nullptr ? lens_ : camera_.ray.o, d, weight, value, nullptr, film});
        }
        const SampledSpectrum weighted = value * static_cast<float>(weight);
        if (film != nullptr)
            splats_.push_back({*film, weighted});
        else
            radiance_ += weighted;
    }
};

} // namespace montelux
