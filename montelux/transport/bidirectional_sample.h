// BidirectionalSample: the two subpaths of a sample.
#pragma once

#include <limits>
#include <optional>

#include "montelux/transport/bidirectional_merging.h"
#include "montelux/transport/subpath_walk.h"

namespace montelux {

// Numbers are drawn in this order: the camera's path with next-event estimation at each vertex, the light's path, then
// what joining them takes. Of a sample that merges, the light's path has a stream of its own.
template <RandomStream Stream>
class BidirectionalSample : private BidirectionalMerging<Stream> {
  public:
    BidirectionalSample(const BidirectionalIntegrator& integrator, const SceneView& scene, RayTracer& tracer,
                        const CameraSample& camera, Stream& stream, BidirectionalMemory& memory,
                        const PathObserver* observer)
        : BidirectionalMerging<Stream>(integrator, scene, tracer, camera, stream, memory, observer) {
        memory_.camera.clear();
        memory_.light.clear();
        memory_.ignored.clear();
    }

    FilmContribution take() {
        reserve();
        trace_from_camera();
        if (camera_.merging != nullptr) {
            SampleStream numbers = camera_.merging->light;
            trace_from_light(numbers);
        } else {
            trace_from_light(stream_);
        }
        for (std::size_t j = 1; j <= memory_.light.size(); ++j) {
            join_lens(j);
            if (!all_strategies_) continue;
            for (std::size_t k = 1; k <= memory_.camera.size(); ++k)
                if (memory_.light[j - 1].events + memory_.camera[k - 1].events <= settings_.max_depth)
                    join(j, k);
        }
        if (area_paths_ > 0 && camera_.merging != nullptr)
            for (std::size_t k = 1; k <= memory_.camera.size(); ++k)
                this->merge(k, camera_.merging->narrower);
        return {radiance_, camera_.lambda, first_, transparency_};
    }

    // The light's path alone.
    void store(LightPaths& paths) {
        reserve();
        trace_from_light(stream_);
        this->store_light_path(paths);
    }

  private:
    using Strategies = BidirectionalMerging<Stream>;
    using Strategies::all_strategies_;
    using Strategies::area_paths_;
    using Strategies::camera_;
    using Strategies::density_of_previous;
    using Strategies::end_;
    using Strategies::end_next_event_;
    using Strategies::integrator_;
    using Strategies::join;
    using Strategies::join_lens;
    using Strategies::meet_light;
    using Strategies::memory_;
    using Strategies::radiance_;
    using Strategies::sample_light;
    using Strategies::scene_;
    using Strategies::settings_;
    using Strategies::stream_;
    using Strategies::time_;
    using Strategies::tracer_;
    using Strategies::volumes_;
    using typename Strategies::Vertices;

    // What the camera's path finds between its vertices.
    struct CameraEvents {
        BidirectionalSample& sample;
        std::size_t k;          // number of the ray
        Index light = no_index; // of the surface where it ends

        void passed(const SubpathEnd& end, const SurfacePoint& s, const Hit& hit) {
            const float distance = end.distance + hit.t;
            sample.meet_surface(s, sample.scene_.light_at(hit), end, end.ray.d, k,
                                end.pdf * std::abs(dot(s.ng, end.ray.d)) / (distance * distance));
        }
        void met(const SubpathEnd& end, const Hit& hit) {
            light = sample.scene_.light_at(hit);
            if (end.events == 0 && sample.camera_.extras != nullptr)
                sample.camera_.extras->meet(end.ray, hit);
        }
        void left(const SubpathEnd& end) { sample.leave_scene(end, k); }
        void emitted(const SubpathEnd& end, SampledSpectrum radiance) {
            if (end.lambda.secondary_terminated()) radiance = SampledSpectrum(4 * radiance[0], 0, 0, 0);
            sample.radiance_ += radiance;
        }
        void looped() { sample.report_loop(); }
    };
    // A light's path finds nothing there.
    struct LightEvents {
        BidirectionalSample& sample;

        void passed(const SubpathEnd&, const SurfacePoint&, const Hit&) {}
        void met(const SubpathEnd&, const Hit&) {}
        void left(const SubpathEnd&) {}
        void emitted(const SubpathEnd&, SampledSpectrum) {}
        void looped() { sample.report_loop(); }
    };
    void reserve() {
        const std::size_t usual =
            static_cast<std::size_t>(std::min<std::int64_t>(settings_.max_depth, 64)) + 1;
        memory_.camera.reserve(usual);
        memory_.light.reserve(usual);
    }
    void report_loop() { radiance_ += SampledSpectrum(std::numeric_limits<float>::quiet_NaN()); }

    // Of v, whose ray has just arrived; false where nothing scatters.
    bool make_scattering(SubpathVertex& v, SubpathEnd& end) const {
        return v.phase != nullptr ||
               montelux::make_scattering(scene_, *integrator_.camera_, integrator_.footprint_scale_, v, end);
    }

    // Goes on from the last vertex of a subpath. False if that ends there.
    template <RandomStream Numbers>
    bool scatter(Vertices& path, TransportMode mode, SubpathEnd& end, Numbers& numbers) {
        SubpathVertex& v = path.back();
        if (v.phase != nullptr) {
            const Vec2f u = numbers.next_2d();
            const PhaseSample s =
                std::visit([&](const PhaseModel auto& f) { return f.sample(v.wo, u); }, *v.phase);
            // Phase functions are symmetric.
            v.backward = density_of_previous(path, path.size(), mode, s.pdf);
            end.pdf = s.pdf;
            end.ray.o = v.s.p;
            end.ray.d = normalize(s.wi);
            return true;
        }
        const std::optional<BsdfSample> scattered = std::visit(
            [&](const BsdfModel auto& bsdf) { return bsdf.sample(v.wo, mode, numbers); }, v.surface.bsdf);
        if (!scattered) return false;
        end.throughput *= scattered->weight;
        if (mode == TransportMode::importance)
            end.throughput *= v.adjoint_correction(scattered->wi);
        else if (scattered->transmission)
            end.eta_scale *= scattered->eta * scattered->eta;
        v.delta = scattered->specular;
        if (may_pass() && v.delta && scattered->transmission && scattered->eta == 1) --end.events;
        // Backwards: the vertex before is found from the one to come.
        const float back = v.delta ? 1 : v.evaluate(scattered->wi, v.wo, adjoint(mode), numbers).pdf;
        v.backward = density_of_previous(path, path.size(), mode, back);
        const Vec3f wi = v.surface.frame.to_world(scattered->wi);
        end.medium = v.medium_towards(wi);
        end.ray.o = offset_origin(v.s.p, v.s.ng, v.s.error, wi);
        end.ray.d = normalize(wi);
        end.pdf = v.delta ? 1 : scattered->pdf;
        return true;
    }

    // Passages straight through a surface are not counted. Mitsuba's volumetric integrators do the same.
    bool may_pass() const { return volumes_ && !settings_.count_passages; }

    // Russian roulette as of PathIntegrator, by the share that is left of what set out.
    template <RandomStream Numbers>
    bool survives(SubpathEnd& end, float strength, Numbers& numbers) {
        if (!(strength > 0)) {
            // A NaN throughput must not end silently: it makes the sample bad.
            if (!is_black(end.throughput)) radiance_ += end.throughput;
            return false;
        }
        if (!(strength < 1) || end.events <= 1) return true;
        if (!(numbers.next_1d() < strength)) return false;
        end.throughput /= strength;
        return true;
    }

    void trace_from_camera() {
        SubpathEnd end;
        end.ray = camera_.ray;
        end.lambda = camera_.lambda;
        end.medium = scene_.camera_medium;
        for (std::size_t k = 1; k <= most_interfaces; ++k) {
            CameraEvents events{*this, k};
            SubpathVertex* found = walk_to_vertex(memory_.camera, scene_, tracer_, end, stream_, events);
            if (found == nullptr) return;
            SubpathVertex& v = *found;
            const float distance = std::sqrt(v.distance2);
            v.forward = k == 1 ? integrator_.camera_->density(v.w, distance, time_) * v.cosine(v.w)
                               : v.per_area(end.pdf, v.w, v.distance2);
            if (v.phase == nullptr) meet_surface(v.s, events.light, v, v.w, k, v.forward);
            // Nothing scatters there any more, but the path may pass.
            const bool last = v.events > settings_.max_depth;
            if (last && (v.phase != nullptr || !may_pass())) break;
            if (k > 1 && !all_strategies_) break;
            if (!make_scattering(v, end)) return;
            if (k == 1 && v.phase == nullptr)
                first_ = {.albedo = albedo(v.surface.bsdf, v.wo),
                          .normal = v.surface.frame.n,
                          .depth = distance,
                          .found = true};
            if (!all_strategies_) return;
            if (v.connectible && !last) sample_light(k);
            if (!scatter(memory_.camera, TransportMode::radiance, end, stream_) ||
                end.events > settings_.max_depth ||
                !survives(end, max_value(end.carried()) * end.eta_scale, stream_))
                return;
        }
    }

    // Ray number k meets a surface that may shine; `path`: the end of the subpath, or its last vertex.
    template <typename Path>
    void meet_surface(const SurfacePoint& s, Index light, const Path& path, Vec3f w, std::size_t k,
                      float density) {
        if (light != no_index)
            meet_light(light, {.wi = w, .part = s.primitive, .p = s.p, .n = s.ng, .b = s.b}, path.edge,
                       path.throughput, path.lambda, k, density);
    }

    void leave_scene(const SubpathEnd& end, std::size_t k) {
        if (end.events == 0) {
            transparency_ = average(end.carried());
            if (camera_.extras != nullptr) camera_.extras->transparency = transparency_;
            if (settings_.background) return;
        }
        for (const Index light : scene_.light_tables.infinite_lights)
            meet_light(light, {.wi = end.ray.d}, end.edge, end.throughput, end.lambda, k, end.pdf);
    }

    template <RandomStream Numbers>
    void trace_from_light(Numbers& numbers) {
        if (scene_.emitting_lights->size() == 0) return;
        const float u_choice = numbers.next_1d();
        const LightChoice chosen = scene_.emitting_lights->sample({}, numbers.refined(u_choice));
        const Vec2f u_position = numbers.next_2d(), u_direction = numbers.next_2d();
        SubpathEnd end;
        end.lambda = camera_.lambda;
        const std::optional<EmissionSample> sample =
            sample_le({scene_, chosen.light, time_}, chosen.part, u_position, u_direction, end.lambda);
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
        end.ray = sample->ray;
        end.throughput =
            sample->radiance *
            (sample->cosine / (chosen.probability * sample->pdf_position * sample->pdf_direction));
        if (volumes_ && !enter_medium(end, numbers)) return;
        const float all = max_value(end.carried());
        LightEvents events{*this};
        for (std::size_t j = 1; j <= most_interfaces && end.events < settings_.max_depth; ++j) {
            SubpathVertex* found = walk_to_vertex(memory_.light, scene_, tracer_, end, numbers, events);
            if (found == nullptr) return;
            SubpathVertex& v = *found;
            v.forward = j == 1 ? end_.edge_density(v.cosine(v.w), v.distance2)
                               : v.per_area(end.pdf, v.w, v.distance2);
            if (!make_scattering(v, end)) return;
            if (j == 1)
                end_next_event_ =
                    next_event_density(scene_, time_, end_, v.reference(v.wo), v.w, v.distance2);
            if (v.events == settings_.max_depth && !may_pass()) return;
            if (!scatter(memory_.light, TransportMode::importance, end, numbers) ||
                !survives(end, max_value(end.carried()) / all, numbers))
                return;
        }
    }

    // The light's ray starts in a medium. Light at infinity has passed that around the scene: an unbounded one lets
    // nothing through, bounded ones lie beyond the ray's origin. False if nothing arrives.
    template <RandomStream Numbers>
    bool enter_medium(SubpathEnd& end, Numbers& numbers) {
        end.medium = medium_at_light(scene_, tracer_, end.ray, camera_.ray);
        if (!end_.at_infinity() || end.medium == no_index) return true;
        Ray back{end.ray.o, -end.ray.d};
        back.time = time_;
        const auto through = shadow_transmittance(scene_, tracer_, back, end.medium, end.lambda, numbers);
        if (!through || !(through->t[0] > 0)) return false;
        end.throughput *= through->t;
        end.density *= through->r_u;
        end.edge = {through->r_u, through->r_l};
        return true;
    }

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
void BidirectionalIntegrator::trace_light(const SceneView& scene, RayTracer& tracer,
                                          const CameraSample& camera, Stream& stream, Batch& memory,
                                          LightPaths& paths) const {
    BidirectionalSample<Stream>(*this, scene, tracer, camera, stream, memory, nullptr).store(paths);
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
