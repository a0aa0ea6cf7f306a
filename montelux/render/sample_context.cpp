#include "montelux/render/sample_context.h"

#include <algorithm>
#include <cmath>

#include "montelux/transport/one_copy.h"

namespace montelux {

namespace {

// The reason to leave a sample out, if any.
std::optional<BadSample::Kind> badness(Vec3f rgb, SampledSpectrum radiance) {
    // The radiance first: with infinite light RGB contains differences of infinities.
    if (has_nan(radiance)) return BadSample::Kind::nan;
    if (!all_finite(radiance)) return BadSample::Kind::infinite;
    if (std::isnan(rgb.x + rgb.y + rgb.z)) return BadSample::Kind::nan;
    if (!is_finite(rgb)) return BadSample::Kind::infinite;
    // RGB may be negative for colours outside the gamut; the spectrum may not.
    if (has_negative(radiance)) return BadSample::Kind::negative;
    return std::nullopt;
}

// Scale of a pixel's footprint on textures: pbrt-v4's value from 64 samples per pixel on. The pixel filter
// does the rest, and a sample must not depend on the number of others.
constexpr float footprint_scale = 0.125f;

} // namespace

SampleContext::SampleContext(const SceneDescription& description, const SamplerSettings& sampler,
                             const SceneView& scene, const Camera& camera)
    : sampler_(sampler), max_component_value_(description.film.max_component_value), scene_(scene),
      camera_(camera), integrator_(PathIntegrator(description.integrator, camera, footprint_scale)),
      filter_(description.film.filter),
      sensor_(RgbColorSpace::srgb(),
              {description.film.exposure_time, description.film.iso, description.film.white_balance}),
      white_(RgbColorSpace::srgb().illuminant()),
      white_scale_(static_cast<float>(1 / integrate_luminance(white_))) {}

MONTELUX_ONE_COPY
SampleContext::Result SampleContext::trace(RayTracer& tracer, int x, int y, std::uint64_t index,
                                           SampleRecord* record) const {
    SampleStream stream(sampler_, static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), index);
    Vec2f u_film = stream.next_2d();
    float u_lambda = stream.next_1d();
    Vec2f u_lens = camera_.has_lens() ? stream.next_2d() : Vec2f{0.5f, 0.5f};
    FilterSample point = filter_.sample(u_film);
    Point2f film{static_cast<float>(x) + 0.5f + point.offset.x,
                 static_cast<float>(y) + 0.5f + point.offset.y};
    const CameraSample camera{camera_.generate_ray(film, u_lens),
                              SampledWavelengths::sample_visible(u_lambda)};
    PathRecord* path_record = record != nullptr ? &record->path : nullptr;
    const FilmContribution path = std::visit(
        [&](const auto& integrator) {
            return integrator.estimate(scene_, tracer, camera, stream, path_record);
        },
        integrator_);

    Result result;
    const Vec3f sensor_rgb = sensor_.to_rgb(path.radiance, path.lambda);
    const float largest = max_component(sensor_rgb);
    const float clamp = largest > max_component_value_ ? max_component_value_ / largest : 1;
    const Vec3f rgb = sensor_rgb * clamp * point.weight;
    result.bad = badness(rgb, path.radiance);
    if (record != nullptr) [[unlikely]] {
        record->filter = point;
        record->film = film;
        record->lens = u_lens;
        record->lambda = camera.lambda;
        record->lambda_end = path.lambda;
        record->sensor_rgb = sensor_rgb;
        record->clamp = clamp;
        record->rgb = rgb;
        record->bad = result.bad;
    }
    if (result.bad) return result;
    result.film.radiance = rgb;
    if (clamp < 1) [[unlikely]]
        result.clamped =
            static_cast<float>(dot(Vec3d(sensor_rgb), luminance_weight)) * (1 - clamp) * point.weight;
    if (const FirstHit& first = path.first; first.found) {
        result.film.albedo =
            albedo_sensor_.to_rgb(first.albedo * white_.sample(camera.lambda) * white_scale_, camera.lambda);
        result.film.normal = first.normal;
        result.film.depth = first.depth;
    }
    return result;
}

SampleRecord SampleContext::record(RayTracer& tracer, int x, int y, std::uint64_t index) const {
    SampleRecord record;
    record.x = x;
    record.y = y;
    record.index = index;
    record.contribution = trace(tracer, x, y, index, &record).film;
    return record;
}

} // namespace montelux
