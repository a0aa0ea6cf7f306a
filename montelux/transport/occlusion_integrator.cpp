#include "montelux/transport/occlusion_integrator.h"

#include <limits>
#include <optional>

#include "montelux/mc/random/sample_stream.h"
#include "montelux/mc/warp/hemisphere.h"
#include "montelux/scene/material/make_bsdf.h"
#include "montelux/spectrum/rgb_colorspace.h"
#include "montelux/transport/shadow_transmittance.h"
#include "montelux/transport/texture_footprint.h"

namespace montelux {
namespace {

// A surface that is no interface, the ray that met it, and its distance along all of the rays.
struct MetSurface {
    SurfacePoint point;
    Hit hit;
    Ray ray;
    float distance = 0;
};

// Follows a ray through interfaces up to its t_max. Empty if it meets nothing else.
std::optional<MetSurface> first_surface(const SceneView& scene, RayTracer& tracer, Ray ray) {
    float travelled = 0;
    for (int i = 0; i < most_interfaces; ++i) {
        Hit hit;
        if (!tracer.intersect(ray, hit)) return std::nullopt;
        const Index material = scene.shapes[hit.shape].material;
        const bool coordinates = scene.is_textured(material) || scene.frame_follows_tangents(material);
        const SurfacePoint s = surface_point(scene, ray, hit, coordinates);
        travelled += hit.t;
        if (!scene.is_interface(hit.shape)) return MetSurface{s, hit, ray, travelled};
        ray.o = offset_origin(s.p, s.ng, s.error, ray.d);
        ray.t_max -= hit.t;
        if (!(ray.t_max > 0)) return std::nullopt;
    }
    return std::nullopt;
}

} // namespace

OcclusionIntegrator::OcclusionIntegrator(const IntegratorSettings& settings, const Camera& camera,
                                         float footprint_scale)
    : settings_(*settings.occlusion), camera_(&camera), footprint_scale_(footprint_scale),
      white_(&RgbColorSpace::srgb().illuminant()),
      white_scale_(static_cast<float>(1 / integrate_luminance(*white_))) {}

template <RandomStream Stream>
FilmContribution OcclusionIntegrator::estimate(const SceneView& scene, RayTracer& tracer,
                                               const CameraSample& camera, Stream& stream,
                                               PathRecord* record) const {
    const PathRecorder recorder(record);
    FilmContribution result{SampledSpectrum(), camera.lambda, {}, 0};
    const auto finish = [&](PathEnd end) {
        if (recorder) {
            recorder.ended(end);
            recorder.traced(result.radiance);
        }
        return result;
    };
    const SampledSpectrum white = white_->sample(camera.lambda) * white_scale_;
    const std::optional<MetSurface> met = first_surface(scene, tracer, camera.ray);
    if (!met) {
        result.transparency = 1;
        if (camera.extras != nullptr) camera.extras->transparency = 1;
        if (recorder) recorder.left_scene(camera.ray, white);
        return finish(PathEnd::left_scene);
    }
    const SurfacePoint& s = met->point;
    const Vec3f wo = -met->ray.d;
    if (camera.extras != nullptr) camera.extras->meet(met->ray, met->hit);
    if (recorder) recorder.hit_surface(met->ray, met->hit, s, white);
    const TextureContext context = scene.is_textured(s.shape->material)
                                       ? texture_context(*camera_, footprint_scale_, s)
                                       : TextureContext();
    SampledWavelengths lambda = camera.lambda; // dispersion has no effect
    const SurfaceBsdf surface = make_bsdf(scene, s, wo, context, lambda);
    const Vec3f local = surface.frame.to_local(wo);
    if (recorder) recorder.made_bsdf(surface, local);
    result.first = {.albedo = albedo(surface.bsdf, local),
                    .normal = surface.frame.n,
                    .depth = met->distance,
                    .found = true};

    const Frame frame = Frame::from_normal(dot(s.ng, wo) < 0 ? -s.ng : s.ng);
    const Vec2f u = stream.next_2d();
    const Vec3f w = settings_.cosine ? sample_cosine_hemisphere(u) : sample_uniform_hemisphere(u);
    const Vec3f wi = frame.to_world(w);
    Ray ray{offset_origin(s.p, s.ng, s.error, wi), wi, settings_.max_distance};
    ray.time = camera.ray.time;
    if (first_surface(scene, tracer, ray)) return finish(PathEnd::max_depth);
    // cosine / (pi pdf)
    result.radiance = white * (settings_.cosine ? 1 : 2 * w.z);
    if (camera.extras != nullptr) camera.extras->add(result.radiance, 1, no_index);
    if (recorder) recorder.left_scene(ray, result.radiance);
    return finish(PathEnd::left_scene);
}

template FilmContribution OcclusionIntegrator::estimate(const SceneView&, RayTracer&, const CameraSample&,
                                                        SampleStream&, PathRecord*) const;

} // namespace montelux
