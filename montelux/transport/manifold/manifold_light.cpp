#include "montelux/transport/manifold/manifold_light.h"

#include <cmath>
#include <optional>

#include "montelux/scene/light/emissive_shape.h"
#include "montelux/scene/light/light_sampling.h"
#include "montelux/scene/light/shadow_ray.h"
#include "montelux/scene/material/make_bsdf.h"
#include "montelux/transport/light_choice.h"
#include "montelux/transport/manifold/manifold_walk.h"
#include "montelux/transport/texture_footprint.h"

namespace montelux {

namespace {

// Between a vertex of the walk and the surface that a ray finds there: of distance, and of coordinates in single
// precision.
constexpr double hit_tolerance = 1e-4, coordinate_tolerance = 16 * 0x1p-24;

// Narrower lobes find lamps better than points of the lamps find the lobes: they cover less than a thousandth of a
// steradian.
constexpr float narrow_alpha = 0.02f;

// A point of a light, chosen for a vertex that it does not depend on.
struct LightPoint {
    LightContext context;
    Index part = 0;
    std::optional<EmissivePoint> surface{}; // of lights that are surfaces
    Vec3d place{};                          // ManifoldEnds::light
    bool distant = false;
    bool delta = false; // no ray hits the light
    float pdf = 0;      // per area, or per solid angle at infinity; 1 of others
    Vec2f u{};          // of sample_li at infinity
};

std::optional<LightPoint> choose_light_point(const Casters& casters, const SceneView& scene,
                                             const ReferencePoint& from, const PathState& state,
                                             PhiloxStream& stream) {
    const LightChoice chosen = casters.choose_light(stream.next_double());
    LightPoint light{.context = {scene, chosen.light, state.ray.time}, .part = chosen.part, .pdf = 1};
    light.u = stream.next_2d();
    switch (kind_of(scene.lights[chosen.light])) {
    case LightKind::surface: {
        const AreaLight& area = *std::get_if<AreaLight>(&scene.lights[chosen.light]);
        light.surface = sample_area(light.context, area.shape, chosen.part, light.u);
        if (!light.surface) return std::nullopt;
        light.place = Vec3d(light.surface->p);
        light.pdf = light.surface->area_density;
        break;
    }
    case LightKind::position:
        light.place = light_bounds(light.context, chosen.part)->box.center();
        light.delta = true;
        break;
    default: {
        const auto sample = sample_li(light.context, chosen.part, from, light.u, state.lambda);
        if (!sample) return std::nullopt;
        light.place = normalize(Vec3d(sample->wi));
        light.distant = true;
        light.delta = sample->delta;
        light.pdf = sample->pdf;
    }
    }
    light.pdf *= chosen.probability;
    return light;
}

// Radiance times the factors that turn manifold_geometry into a density over the light, and the ray to it.
struct IncidentLight {
    SampledSpectrum value;
    Vec3f wi;
    Ray shadow;
};
std::optional<IncidentLight> incident_light(const LightPoint& light, const ReferencePoint& at,
                                            const SampledWavelengths& lambda) {
    if (light.surface) {
        const EmissivePoint& s = *light.surface;
        const Vec3f wi = normalize(s.p - at.p);
        const LightHit hit{wi, light.part, s.p, s.n, {s.hit.b1, s.hit.b2}};
        return IncidentLight{incident_radiance(light.context, at, hit, lambda) * std::abs(dot(s.n, wi)), wi,
                             shadow_ray(at, wi, s.p, s.n, s.error)};
    }
    const auto sample = sample_li(light.context, light.part, at, light.u, lambda);
    if (!sample) return std::nullopt;
    // Irradiance of a light with a position becomes intensity.
    const float scale = light.distant ? 1 : length_squared(Vec3f(light.place) - at.p);
    return IncidentLight{sample->radiance * scale, sample->wi, sample->shadow};
}

// Chooses the delta lobe of a BSDF: the first number decides between reflection and refraction.
struct LobeStream {
    float u;
    float next_1d() { return u; }
    Vec2f next_2d() { return {u, u}; }
    double refined(float x) { return double(x); }
};

// What the specular vertex makes of radiance, as scattering has it; black without such a lobe.
SampledSpectrum specular_factor(const SurfaceBsdf& surface, Vec3f wo, bool reflects) {
    LobeStream lobe{reflects ? 0 : largest_below_one<float>};
    const auto s = std::visit(
        [&](const auto& bsdf) { return bsdf.sample(wo, TransportMode::radiance, lobe); }, surface.bsdf);
    if (!s || !s->specular || s->transmission == reflects) return {};
    return s->weight * s->pdf;
}

struct Estimate {
    const Casters& casters;
    const SceneView& scene;
    RayTracer& tracer;
    const Camera& camera;
    float footprint_scale;
    SampledWavelengths& lambda;

    TextureContext context_of(const SurfacePoint& s) const {
        return scene.is_textured(s.shape->material) ? texture_context(camera, footprint_scale, s)
                                                    : TextureContext();
    }
    SurfacePoint surface_at(const Ray& ray, const Hit& hit) const {
        const Index material = scene.shapes[hit.shape].material;
        return surface_point(scene, ray, hit,
                             scene.is_textured(material) || scene.frame_follows_tangents(material));
    }

    // Whether the ray found the solution, and not the other side of a thin plate.
    static bool is_at(const SurfacePoint& s, const Hit& hit, const Ray& ray, const Caster& caster,
                      const CasterPoint& point) {
        if (std::holds_alternative<CasterMesh>(caster.geometry) && hit.primitive == point.primitive)
            return true;
        const Vec3d d(ray.d), n(s.ns);
        if (!(dot(n, point.n) > 0 && (dot(n, d) > 0) == (dot(point.n, d) > 0))) return false;
        const double distance = length(point.p - Vec3d(ray.o)), size = max_component(abs(point.p));
        return std::abs(double(hit.t) - distance) <= hit_tolerance * distance + coordinate_tolerance * size;
    }

    // Light through the solution per density over the light, and the direction that it arrives from; black if
    // something occludes it.
    SampledSpectrum radiance(const Caster& caster, const ManifoldEnds& ends, const LightPoint& light,
                             const ManifoldSolution& solution, Vec3f& wi) const {
        wi = normalize(Vec3f(solution.point.p - ends.vertex()));
        const Point3f origin = offset_origin(ends.from.p, ends.from.n, ends.from.error, wi);
        // Aimed from where it begins, which may be far from the vertex beside the distance.
        const Ray ray{
            .o = origin, .d = normalize(Vec3f(solution.point.p - Vec3d(origin))), .time = ends.time};
        Hit hit;
        if (!tracer.intersect(ray, hit) || hit.shape != caster.shape || hit.instance != no_index) return {};
        const SurfacePoint s = surface_at(ray, hit);
        if (!is_at(s, hit, ray, caster, solution.point)) return {};
        const ReferencePoint at{s.p, s.ng, s.error, Vec3f{}};
        const std::optional<IncidentLight> incident = incident_light(light, at, lambda);
        if (!incident || is_black(incident->value)) return {};
        const SurfaceBsdf surface = make_bsdf(scene, s, -wi, context_of(s), lambda);
        const SampledSpectrum factor =
            specular_factor(surface, surface.frame.to_local(-wi), solution.reflects);
        if (is_black(factor)) return {};
        Ray shadow = incident->shadow;
        shadow.time = ends.time;
        if (tracer.occluded(shadow)) return {};
        return factor * incident->value *
               static_cast<float>(manifold_geometry(solution, ends, caster) / double(light.pdf));
    }
};

} // namespace

void add_manifold_light(const Casters& casters, const SceneView& scene, RayTracer& tracer, PathState& state,
                        const Hit& hit, const Camera& camera, float footprint_scale, PhiloxStream stream) {
    SampledWavelengths lambda = state.lambda;
    const Estimate estimate{casters, scene, tracer, camera, footprint_scale, lambda};
    const SurfacePoint s = estimate.surface_at(state.ray, hit);
    const Vec3f w = -state.ray.d;
    const SurfaceBsdf surface = make_bsdf(scene, s, w, estimate.context_of(s), lambda);
    if (is_specular(surface.bsdf)) return;
    state.scatters_narrowly = least_alpha(surface.bsdf) < narrow_alpha;
    const Vec3f wo = surface.frame.to_local(w);
    if (wo.z == 0) return;

    const ReferencePoint from{s.p, s.ng, s.error, Vec3f{}};
    const std::optional<LightPoint> light = choose_light_point(casters, scene, from, state, stream);
    if (!light || (state.scatters_narrowly && !light->delta)) return;
    const auto [caster, probability] = casters.choose_caster(stream.next_double());
    const ManifoldEnds ends{from, light->place, light->distant, state.ray.time};
    const auto solution = walk_manifold(scene, tracer, *caster, ends, sample_point(scene, *caster, stream));
    if (!solution) return;
    Vec3f wi;
    SampledSpectrum value = estimate.radiance(*caster, ends, *light, *solution, wi);
    if (is_black(value)) return;
    value *= std::visit(
        [&](const auto& bsdf) {
            return bsdf.evaluate(wo, surface.frame.to_local(wi), TransportMode::radiance, stream).f;
        },
        surface.bsdf);
    if (is_black(value)) return;
    value *= inverse_probability(scene, tracer, *caster, ends, *solution, stream) /
             static_cast<float>(probability);
    state.add(state.throughput * value, light->context.light, 2);
}

} // namespace montelux
