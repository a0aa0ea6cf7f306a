#include "montelux/transport/path.h"

#include <algorithm>
#include <cmath>

#include "montelux/mc/integrate/mis.h"
#include "montelux/mc/warp/hemisphere.h"
#include "montelux/mc/warp/sphere.h"
#include "montelux/scene/light/light_sampling.h"
#include "montelux/scene/material/make_bsdf.h"
#include "montelux/scene/shape/surface_point.h"
#include "montelux/transport/one_copy.h"
#include "montelux/transport/path_recorder.h"

namespace montelux {

namespace {

float mis_weight(Heuristic heuristic, float f, float g) {
    return heuristic == Heuristic::power ? power_heuristic(1, f, 1, g) : balance_heuristic(1, f, 1, g);
}

// u such that a = x dpdu + y dpdv in the least-squares sense.
Vec2f in_tangents(Vec3f a, Vec3f dpdu, Vec3f dpdv) {
    float uu = dot(dpdu, dpdu), uv = dot(dpdu, dpdv), vv = dot(dpdv, dpdv);
    float determinant = uu * vv - uv * uv;
    if (!(std::abs(determinant) > 0)) return {0, 0};
    float au = dot(a, dpdu), av = dot(a, dpdv), inv = 1 / determinant;
    Vec2f d{(vv * au - uv * av) * inv, (uu * av - uv * au) * inv};
    return std::isfinite(d.x) && std::isfinite(d.y) ? d : Vec2f{0, 0};
}

TextureContext texture_context(const PathScene& ps, const SurfacePoint& s) {
    TextureContext c{.p = s.p, .n = s.ns, .uv = s.uv, .dpdx = {}, .dpdy = {}, .duvdx = {}, .duvdy = {}};
    Camera::Footprint footprint = ps.camera.footprint(s.p, s.ng, ps.footprint_scale);
    c.dpdx = footprint.dpdx;
    c.dpdy = footprint.dpdy;
    c.duvdx = in_tangents(c.dpdx, s.dpdu, s.dpdv);
    c.duvdy = in_tangents(c.dpdy, s.dpdu, s.dpdv);
    return c;
}

// Directions that know nothing of the BSDF: uniform over the hemisphere of wo, or over the sphere where it
// transmits. A delta lobe beside others gets half of the samples, since no such direction can find it.
template <BsdfModel B>
std::optional<BsdfSample> sample_uniform(const B& bsdf, Vec3f wo, SampleStream& stream) {
    float share = 1;
    if (bsdf.has_specular()) {
        share = 0.5f;
        float u_choice = stream.next_1d();
        if (u_choice < share) {
            auto s = bsdf.sample(wo, TransportMode::radiance, stream);
            if (!s || !s->specular) return std::nullopt;
            s->weight /= share;
            return s;
        }
    }
    Vec2f u = stream.next_2d();
    BsdfSample s;
    if constexpr (B::traits.transmits) {
        s.wi = sample_uniform_sphere(u);
        s.pdf = share * inv_four_pi_f;
        s.transmission = !same_hemisphere(wo, s.wi);
        if (s.transmission) s.eta = bsdf.transmitted_eta(wo);
    } else {
        s.wi = sample_uniform_hemisphere(u);
        if (wo.z < 0) s.wi.z = -s.wi.z;
        s.pdf = share * inv_two_pi_f;
    }
    BsdfEvaluation e = bsdf.evaluate(wo, s.wi, TransportMode::radiance, stream);
    s.weight = e.f / s.pdf;
    if (is_black(s.weight)) return std::nullopt;
    return s;
}

// The state of one path between its vertices.
struct Path {
    const PathScene& ps;
    RayTracer& tracer;
    SampledWavelengths& lambda;
    SampleStream& stream;
    PathRecorder recorder;

    SampledSpectrum radiance{}, throughput{1};
    ReferencePoint previous{}; // the last vertex that scattered; at first where the camera's ray begins
    float bsdf_pdf = 0;        // with which the current direction was sampled there
    bool sees_lights = true;   // no other strategy can have found the light that the ray hits
    float eta_scale = 1;       // squared index of refraction along the path, undone for Russian roulette

    bool samples_lights() const { return ps.settings.strategy >= Strategy::light; }

    // How much of the light that was found by following the path counts.
    float hit_weight(float light_pdf) const {
        if (!samples_lights()) return 1;
        if (ps.settings.strategy == Strategy::light) return light_pdf > 0 ? 0.0f : 1.0f;
        return mis_weight(ps.settings.heuristic, bsdf_pdf, light_pdf);
    }

    // The light that the current ray met.
    void add_met_light(Index light, const LightHit& hit) {
        const LightContext context{ps.scene, light};
        const SampledSpectrum le = incident_radiance(context, previous, hit, lambda);
        if (is_black(le)) return;
        // Where light sampling could have found it as well.
        const float pdf = sees_lights ? 0
                                      : ps.scene.light_sampler->probability(previous, light, hit.part) *
                                            pdf_li(context, previous, hit);
        const float weight = sees_lights ? 1 : hit_weight(pdf);
        const bool counted = ps.settings.strategy != Strategy::mis_light;
        if (recorder)
            recorder.found_light({.light = light,
                                  .part = hit.part,
                                  .radiance = le,
                                  .shared = !sees_lights,
                                  .bsdf_pdf = sees_lights ? 0 : bsdf_pdf,
                                  .light_pdf = pdf,
                                  .weight = weight,
                                  .counted = counted});
        if (counted) radiance += throughput * le * weight;
    }

    void add_infinite_lights(Vec3f w) {
        for (Index light : ps.scene.light_tables.infinite_lights) add_met_light(light, {.wi = w});
    }

    void add_emission(const SurfacePoint& s, Vec3f w) {
        if (s.shape->light == no_index) return;
        add_met_light(s.shape->light, {.wi = w, .part = s.primitive, .p = s.p, .n = s.ng});
    }

    // Next-event estimation: one light, one point on it. Lights that scattering cannot find are sampled
    // whatever the strategy says.
    template <typename B>
    void add_direct_light(const B& bsdf, const Frame& frame, Vec3f wo, const ReferencePoint& here) {
        using Outcome = DirectLight::Outcome;
        const LightSampler& lights = *ps.scene.light_sampler;
        if (lights.empty()) return;
        // Among few lights the choice takes the first number's leading digits and leaves the others for the
        // point: one dimension less keeps point sets better stratified.
        const bool few = lights.size() <= 64;
        Vec2f u = stream.next_2d();
        const LightChoice chosen = lights.sample(here, stream.refined(few ? u.x : stream.next_1d()));
        const float choice = chosen.probability;
        if (few) u.x = std::min(static_cast<float>(chosen.remapped), largest_below_one<float>);
        auto light = sample_li({ps.scene, chosen.light}, chosen.part, here, u, lambda);
        if (!light || (!light->invisible && !samples_lights())) {
            if (recorder)
                recorder.sampled_light({.outcome = light ? Outcome::left_to_scattering : Outcome::dark,
                                        .light = chosen.light,
                                        .part = chosen.part,
                                        .choice = choice});
            return;
        }
        BsdfEvaluation e = bsdf.evaluate(wo, frame.to_local(light->wi), TransportMode::radiance, stream);
        float light_pdf = choice * light->pdf;
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
                                        .bsdf_pdf = e.pdf,
                                        .weight = weight});
        };
        if (is_black(e.f) || is_black(light->radiance)) {
            record(Outcome::no_transport, 0);
            return;
        }
        float weight = light->invisible || ps.settings.strategy == Strategy::light
                           ? 1
                           : mis_weight(ps.settings.heuristic, light_pdf, e.pdf);
        if (ps.settings.strategy == Strategy::mis_bsdf) {
            record(Outcome::other_term, weight);
            return;
        }
        const bool occluded = tracer.occluded(light->shadow);
        record(occluded ? Outcome::occluded : Outcome::counted, weight);
        if (occluded) return;
        radiance += throughput * e.f * light->radiance * (weight / light_pdf);
    }

    // Russian roulette on what the path can still carry to the film. Returns false at its end.
    bool survives(int depth) {
        float strength = max_value(throughput) * eta_scale;
        if (!(strength > 0)) {
            // What is not a number must not end unseen: the sample becomes bad with it.
            radiance += throughput;
            if (recorder)
                recorder.ended(is_black(throughput) ? PathEnd::nothing_carried : PathEnd::bad_throughput);
            return false;
        }
        if (!(strength < 1) || depth <= 1) return true;
        float u = stream.next_1d();
        if (recorder) recorder.played_roulette({.survival = strength, .u = u});
        if (!(u < strength)) {
            if (recorder) recorder.ended(PathEnd::roulette);
            return false;
        }
        throughput /= strength;
        return true;
    }
};

} // namespace

MONTELUX_ONE_COPY
SampledSpectrum path_radiance(const PathScene& ps, RayTracer& tracer, Ray ray, SampledWavelengths& lambda,
                              SampleStream& stream, FirstHit* first, PathRecord* record) {
    Path path{ps, tracer, lambda, stream, PathRecorder(record)};
    path.previous.p = ray.o;
    for (int depth = 0;;) {
        Hit hit;
        if (!tracer.intersect(ray, hit)) {
            if (path.recorder) path.recorder.left_scene(ray, path.throughput);
            path.add_infinite_lights(ray.d);
            if (path.recorder) path.recorder.ended(PathEnd::left_scene);
            break;
        }
        const Shape& shape = ps.scene.shapes[hit.shape];
        const bool textured = ps.scene.is_textured(shape.material);
        const bool tangents = textured || ps.scene.frame_follows_tangents(shape.material);
        SurfacePoint s = surface_point(ps.scene, ray, hit, tangents);
        if (path.recorder) path.recorder.hit_surface(ray, hit, s, path.throughput);
        if (hit.instance == no_index) path.add_emission(s, ray.d);
        if (depth++ == ps.settings.max_depth) {
            if (path.recorder) path.recorder.ended(PathEnd::max_depth);
            break;
        }

        TextureContext context;
        if (textured) context = texture_context(ps, s);
        const SurfaceBsdf made = make_bsdf(ps.scene, s, -ray.d, context, lambda);
        const Bsdf& bsdf = made.bsdf;
        const Frame frame = made.frame; // a copy, which stays in registers
        Vec3f wo = frame.to_local(-ray.d);
        if (path.recorder) path.recorder.made_bsdf(made, wo);
        if (depth == 1 && first != nullptr)
            *first = {.albedo = std::visit([&](const auto& b) { return b.albedo(wo); }, bsdf),
                      .normal = frame.n,
                      .depth = hit.t,
                      .found = true};
        if (wo.z == 0) {
            if (path.recorder) path.recorder.ended(PathEnd::grazing);
            break;
        }
        ReferencePoint here{s.p, s.ng, s.error};

        const bool uniform = ps.settings.strategy == Strategy::uniform;
        auto scattered = std::visit(
            [&](const auto& b) -> std::optional<BsdfSample> {
                if (!b.is_specular()) {
                    path.add_direct_light(b, frame, wo, here);
                    if (uniform) return sample_uniform(b, wo, stream);
                }
                return b.sample(wo, TransportMode::radiance, stream);
            },
            bsdf);
        if (!scattered) {
            if (path.recorder) path.recorder.ended(PathEnd::no_direction);
            break;
        }

        path.throughput *= scattered->weight;
        path.bsdf_pdf = scattered->pdf;
        path.sees_lights = scattered->specular;
        path.previous = here;
        if (scattered->transmission) path.eta_scale *= scattered->eta * scattered->eta;
        Vec3f wi = frame.to_world(scattered->wi);
        if (path.recorder) path.recorder.scattered({*scattered, wi});
        ray = {offset_origin(s.p, s.ng, s.error, wi), wi};
        if (!path.survives(depth)) break;
    }
    if (path.recorder) path.recorder.traced(path.radiance);
    return path.radiance;
}

} // namespace montelux
