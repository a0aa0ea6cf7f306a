// BidirectionalSample: the two subpaths of a sample and the ways to join them.
#pragma once

#include <algorithm>
#include <limits>
#include <optional>

#include "montelux/scene/light/shadow_ray.h"
#include "montelux/transport/bidirectional_integrator.h"
#include "montelux/transport/light_choice.h"

namespace montelux {

// Numbers are drawn in this order: the camera's path with next-event estimation at each vertex, the light's path, then
// what joining them takes.
template <RandomStream Stream>
class BidirectionalSample {
  public:
    BidirectionalSample(const BidirectionalIntegrator& integrator, const SceneView& scene, RayTracer& tracer,
                        const CameraSample& camera, Stream& stream, BidirectionalMemory& memory,
                        const PathObserver* observer)
        : integrator_(integrator), settings_(integrator.settings_), scene_(scene), tracer_(tracer),
          camera_(camera), stream_(stream), memory_(memory), observer_(observer),
          splats_(camera.splats != nullptr ? *camera.splats : memory.ignored), time_(camera.ray.time),
          all_strategies_(settings_.method == IntegratorKind::bidirectional) {
        memory_.camera.clear();
        memory_.light.clear();
        memory_.ignored.clear();
    }

    FilmContribution take() {
        const auto depth = static_cast<std::size_t>(settings_.max_depth);
        memory_.camera.reserve(depth + 1);
        memory_.light.reserve(depth + 1);
        trace_from_camera();
        trace_from_light();
        for (std::size_t j = 1; j <= memory_.light.size(); ++j) {
            join_lens(j);
            if (!all_strategies_) continue;
            for (std::size_t k = 1; k <= memory_.camera.size() && j + k <= depth; ++k) join(j, k);
        }
        return {radiance_, camera_.lambda, first_, transparency_};
    }

  private:
    using Vertices = std::vector<SubpathVertex>;

    // Of v, whose ray has just hit; false where nothing scatters.
    bool make_scattering(SubpathVertex& v, SampledWavelengths& lambda) const {
        return montelux::make_scattering(scene_, *integrator_.camera_, integrator_.footprint_scale_, v,
                                         lambda);
    }

    // Goes on from the last vertex of a subpath. Empty if that ends there; otherwise the density of the ray's direction,
    // 1 of a delta.
    std::optional<float> scatter(Vertices& path, TransportMode mode, Ray& ray, SampledSpectrum& throughput,
                                 float& eta_scale) {
        SubpathVertex& v = path.back();
        const std::optional<BsdfSample> scattered = std::visit(
            [&](const BsdfModel auto& bsdf) { return bsdf.sample(v.wo, mode, stream_); }, v.surface.bsdf);
        if (!scattered) return std::nullopt;
        throughput *= scattered->weight;
        if (mode == TransportMode::importance)
            throughput *= adjoint_correction(v.s, v.surface.frame, v.wo, scattered->wi);
        else if (scattered->transmission)
            eta_scale *= scattered->eta * scattered->eta;
        v.delta = scattered->specular;
        // Backwards: the vertex before is found from the one to come.
        const float back = v.delta ? 1 : evaluate(v.surface, scattered->wi, v.wo, adjoint(mode), stream_).pdf;
        v.backward = density_of_previous(path, path.size(), mode, back);
        const Vec3f wi = v.surface.frame.to_world(scattered->wi);
        ray.o = offset_origin(v.s.p, v.s.ng, v.s.error, wi);
        ray.d = wi;
        ray.t_max = std::numeric_limits<float>::infinity();
        return v.delta ? 1 : scattered->pdf;
    }
    // Of the vertex before number i (from 1), given a density per solid angle at that.
    float density_of_previous(const Vertices& path, std::size_t i, TransportMode mode, float pdf) const {
        const SubpathVertex& v = path[i - 1];
        if (i > 1) return path[i - 2].per_area(pdf, v.w, v.distance2);
        return mode == TransportMode::importance ? end_.of_light(pdf, v.w, v.distance2) : 0;
    }

    // Russian roulette as of PathIntegrator, by the share that is left of what set out.
    bool survives(SampledSpectrum& throughput, float strength, std::size_t events) {
        if (!(strength > 0)) {
            // A NaN throughput must not end silently: it makes the sample bad.
            if (!is_black(throughput)) radiance_ += throughput;
            return false;
        }
        if (!(strength < 1) || events <= 1) return true;
        if (!(stream_.next_1d() < strength)) return false;
        throughput /= strength;
        return true;
    }

    void trace_from_camera() {
        Ray ray = camera_.ray;
        SampledWavelengths lambda = camera_.lambda;
        SampledSpectrum throughput(1);
        float pdf = 0, eta_scale = 1;
        const auto max_depth = static_cast<std::size_t>(settings_.max_depth);
        for (std::size_t k = 1;; ++k) { // ... - 1 scattering events so far
            Hit hit;
            if (!tracer_.intersect(ray, hit)) return leave_scene(ray, throughput, lambda, k, pdf);
            if (k == 1 && camera_.extras != nullptr) camera_.extras->meet(ray, hit);
            SubpathVertex& v = add_vertex(memory_.camera, scene_, ray, hit, throughput);
            v.forward = k == 1
                            ? integrator_.camera_->density(ray.d, hit.t, time_) * std::abs(dot(v.s.ng, ray.d))
                            : v.per_area(pdf, v.w, v.distance2);
            if (const Index light = scene_.light_at(hit); light != no_index)
                meet_light(light, {.wi = v.w, .part = v.s.primitive, .p = v.s.p, .n = v.s.ng, .b = v.s.b},
                           throughput, lambda, k, v.forward);
            const bool last = k > max_depth || (k > 1 && !all_strategies_);
            if (last || !make_scattering(v, lambda)) {
                if (last) memory_.camera.pop_back();
                return;
            }
            if (k == 1)
                first_ = {.albedo = std::visit([&](const auto& b) { return b.albedo(v.wo); }, v.surface.bsdf),
                          .normal = v.surface.frame.n,
                          .depth = hit.t,
                          .found = true};
            if (!all_strategies_) return;
            if (v.connectible) sample_light(k);
            const auto direction =
                scatter(memory_.camera, TransportMode::radiance, ray, throughput, eta_scale);
            if (!direction || !survives(throughput, max_value(throughput) * eta_scale, k)) return;
            pdf = *direction;
        }
    }

    void leave_scene(const Ray& ray, SampledSpectrum throughput, const SampledWavelengths& lambda,
                     std::size_t k, float pdf) {
        if (k == 1) {
            transparency_ = 1;
            if (camera_.extras != nullptr) camera_.extras->transparency = 1;
            if (settings_.background) return;
        }
        for (const Index light : scene_.light_tables.infinite_lights)
            meet_light(light, {.wi = ray.d}, throughput, lambda, k, pdf);
    }

    void trace_from_light() {
        if (scene_.emitting_lights->size() == 0) return;
        const float u_choice = stream_.next_1d();
        const LightChoice chosen = scene_.emitting_lights->sample({}, stream_.refined(u_choice));
        const Vec2f u_position = stream_.next_2d(), u_direction = stream_.next_2d();
        SampledWavelengths lambda = camera_.lambda;
        const std::optional<EmissionSample> sample =
            sample_le({scene_, chosen.light, time_}, chosen.part, u_position, u_direction, lambda);
        if (!sample || is_black(sample->radiance)) return;
        end_ = {
            .light = chosen.light,
            .kind = kind_of(scene_.lights[chosen.light]),
            .hit = {
                .wi = -sample->ray.d, .part = chosen.part, .p = sample->p, .n = sample->n, .b = sample->b}};
        end_.invisible = sample->invisible || end_.is_delta();
        end_.emission =
            chosen.probability * (end_.at_infinity() ? sample->pdf_direction : sample->pdf_position);
        end_.edge = end_.at_infinity() ? sample->pdf_position : sample->pdf_direction;
        Ray ray = sample->ray;
        SampledSpectrum throughput =
            sample->radiance *
            (sample->cosine / (chosen.probability * sample->pdf_position * sample->pdf_direction));
        const float all = max_value(throughput);
        float pdf = 0, ignored = 1;
        const auto max_depth = static_cast<std::size_t>(settings_.max_depth);
        for (std::size_t j = 1; j <= max_depth; ++j) {
            Hit hit;
            if (!tracer_.intersect(ray, hit)) return;
            SubpathVertex& v = add_vertex(memory_.light, scene_, ray, hit, throughput);
            v.forward =
                j == 1 ? end_.edge_density(v.s.ng, v.w, v.distance2) : v.per_area(pdf, v.w, v.distance2);
            if (!make_scattering(v, lambda)) return;
            if (j == 1)
                end_next_event_ =
                    next_event_density(scene_, time_, end_, v.reference(v.wo), v.w, v.distance2);
            if (j == max_depth) return;
            const auto direction =
                scatter(memory_.light, TransportMode::importance, ray, throughput, ignored);
            if (!direction || !survives(throughput, max_value(throughput) / all, j)) return;
            pdf = *direction;
        }
    }

    // s = 0: ray number k of the camera's path meets a light. `density`: of the light's point or direction.
    void meet_light(Index light, const LightHit& hit, SampledSpectrum throughput,
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
            d.from_light[1] = double(end.edge_density(v.s.ng, -hit.wi, distance2));
            d.from_camera[0] = double(density);
            d.next_event = double(next_event_density(scene_, time_, end, previous, -hit.wi, distance2));
        }
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
        const BsdfEvaluation e = evaluate(v.surface, v.wo, wi, TransportMode::radiance, stream_);
        const float light_pdf = chosen.choice * light.pdf;
        const SampledSpectrum value = v.throughput * e.f * light.radiance / light_pdf;
        if (is_black(value) || is_occluded(light.shadow)) return;
        LightEnd end = end_at(scene_, time_, chosen.light,
                              {.wi = light.wi, .part = chosen.part, .p = light.p, .n = light.n, .b = light.b},
                              -light.wi);
        end.invisible = light.invisible;
        const Point3f at = end.kind == LightKind::position ? light.shadow.o + light.shadow.d : light.p;
        const float distance2 = end.at_infinity() ? 1 : length_squared(at - v.s.p);
        PathDensities& d = memory_.densities;
        fill(1, k + 1);
        d.from_light[0] = double(end.emission);
        d.from_light[1] = double(end.edge_density(v.s.ng, -light.wi, distance2));
        d.from_camera[0] = end.invisible ? 0 : double(end.of_light(e.pdf, -light.wi, distance2));
        d.next_event = double(end.of_light(light_pdf, -light.wi, distance2));
        d.delta[1] = 0;
        if (k > 1) {
            const float back = evaluate(v.surface, wi, v.wo, TransportMode::importance, stream_).pdf;
            d.from_light[2] = double(density_of_previous(memory_.camera, k, TransportMode::radiance, back));
        }
        add(end, 1, k + 1, value, v.lambda);
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
        const BsdfEvaluation e = evaluate(y.surface, y.wo, wi, TransportMode::importance, stream_);
        const SampledSpectrum value =
            y.throughput * e.f * (adjoint_correction(y.s, y.surface.frame, y.wo, wi) * seen->density);
        if (is_black(value)) return;
        const Point3f o = offset_origin(y.s.p, y.s.ng, y.s.error, seen->wi);
        if (is_occluded({o, seen->lens - o, 1})) return;
        lens_ = seen->lens;
        const std::size_t s = j + 1;
        fill(s, 1);
        PathDensities& d = memory_.densities;
        d.from_camera[j] = double(seen->density * std::abs(dot(y.s.ng, seen->wi)));
        d.delta[j] = 0;
        const float back = evaluate(y.surface, wi, y.wo, TransportMode::radiance, stream_).pdf;
        set_before_light_vertex(j, back);
        add(end_, s, 1, value, y.lambda, &seen->film);
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
        const BsdfEvaluation at_z = evaluate(z.surface, z.wo, wz, TransportMode::radiance, stream_);
        if (is_black(at_z.f)) return;
        const BsdfEvaluation at_y = evaluate(y.surface, y.wo, wy, TransportMode::importance, stream_);
        const SampledSpectrum value = z.throughput * at_z.f * at_y.f * y.throughput *
                                      (adjoint_correction(y.s, y.surface.frame, y.wo, wy) / distance2);
        if (is_black(value)) return;
        const ReferencePoint from{z.s.p, z.s.ng, z.s.error, Vec3f{}};
        if (is_occluded(shadow_ray(from, w, y.s.p, y.s.ng, y.s.error))) return;
        const std::size_t s = j + 1, t = k + 1;
        fill(s, t);
        PathDensities& d = memory_.densities;
        d.from_light[s] = double(z.per_area(at_y.pdf, w, distance2));
        d.from_camera[j] = double(y.per_area(at_z.pdf, w, distance2));
        d.delta[j] = d.delta[s] = 0;
        const float back_y = evaluate(y.surface, wy, y.wo, TransportMode::radiance, stream_).pdf;
        set_before_light_vertex(j, back_y);
        if (k > 1) {
            const float back_z = evaluate(z.surface, wz, z.wo, TransportMode::importance, stream_).pdf;
            d.from_light[s + 1] =
                double(density_of_previous(memory_.camera, k, TransportMode::radiance, back_z));
        }
        SampledWavelengths lambda = y.lambda;
        if (z.lambda.secondary_terminated()) lambda.terminate_secondary();
        add(end_, s, t, value, lambda);
    }

    void set_before_light_vertex(std::size_t j, float pdf) {
        const float density = density_of_previous(memory_.light, j, TransportMode::importance, pdf);
        memory_.densities.from_camera[j - 1] = j == 1 && end_.invisible ? 0 : double(density);
    }

    // What the two subpaths know of the densities of a path: all but what depends on its joint.
    void fill(std::size_t s, std::size_t t) {
        const std::size_t n = s + t;
        PathDensities& d = memory_.densities;
        d.reset(n);
        if (s >= 2) {
            d.from_light[0] = double(end_.emission);
            d.next_event = double(end_next_event_);
        }
        for (std::size_t j = 1; j < s; ++j) {
            const SubpathVertex& y = memory_.light[j - 1];
            d.from_light[j] = double(y.forward);
            d.delta[j] = y.delta ? 1 : 0;
            if (j > 1 || !end_.invisible) d.from_camera[j - 1] = double(y.backward);
        }
        for (std::size_t k = 1; k + std::max<std::size_t>(s, 1) < n; ++k) {
            const SubpathVertex& z = memory_.camera[k - 1];
            const std::size_t i = n - 1 - k;
            d.from_camera[i] = double(z.forward);
            d.delta[i] = z.delta ? 1 : 0;
            if (k > 1) d.from_light[i + 1] = double(z.backward);
        }
        d.light_paths = integrator_.light_paths_;
    }

    bool is_occluded(Ray ray) {
        ray.time = time_;
        return tracer_.occluded(ray);
    }

    // The path's contribution; a splat where `film` is not null.
    void add(const LightEnd& end, std::size_t s, std::size_t t, SampledSpectrum value,
             const SampledWavelengths& lambda, const Point2f* film = nullptr) {
        const double weight =
            all_strategies_ ? strategy_weight(memory_.densities, s, settings_.heuristic, memory_.scratch) : 1;
        if (lambda.secondary_terminated()) value = SampledSpectrum(4 * value[0], 0, 0, 0);
        if (observer_ != nullptr) [[unlikely]] {
            const std::size_t light = s > 0 ? s - 1 : 0, camera = s > 0 ? t - 1 : t - 2;
            observer_->found(observer_->self,
                             {s, t, end, std::span(memory_.light).first(light),
                              std::span(memory_.camera).first(camera),
                              film != nullptr ? lens_ : camera_.ray.o, memory_.densities, weight, value});
        }
        const SampledSpectrum weighted = value * static_cast<float>(weight);
        if (film != nullptr)
            splats_.push_back({*film, weighted});
        else
            radiance_ += weighted;
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
    LightEnd end_;             // of the light's path
    float end_next_event_ = 0; // PathDensities::next_event of it
    Point3f lens_;             // of the last splat
    SampledSpectrum radiance_{};
    FirstHit first_;
    float transparency_ = 0;
};

template <RandomStream Stream>
FilmContribution BidirectionalIntegrator::estimate(const SceneView& scene, RayTracer& tracer,
                                                   const CameraSample& camera, Stream& stream, Batch& memory,
                                                   const PathObserver* observer) const {
    return BidirectionalSample<Stream>(*this, scene, tracer, camera, stream, memory, observer).take();
}

template <RandomStream Stream>
FilmContribution BidirectionalIntegrator::estimate(const SceneView& scene, RayTracer& tracer,
                                                   const CameraSample& camera, Stream& stream,
                                                   PathRecord*) const {
    Batch memory;
    return estimate(scene, tracer, camera, stream, memory, nullptr);
}

template <RandomStream Stream>
void BidirectionalIntegrator::estimate(const SceneView& scene, RayTracer& tracer,
                                       std::span<PathStart<Stream>> starts, Batch& memory,
                                       std::span<FilmContribution> results) const {
    for (std::size_t i = 0; i < starts.size(); ++i)
        results[i] = estimate(scene, tracer, starts[i].camera, starts[i].stream, memory, nullptr);
}

} // namespace montelux
