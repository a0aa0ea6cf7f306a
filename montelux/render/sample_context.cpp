#include "montelux/render/sample_context.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "montelux/film/splat_film.h"

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

// Scenes without media pay nothing for them.
Integrator make_integrator(const SceneDescription& description, const SceneView& scene,
                           const Camera& camera) {
    const IntegratorSettings& settings = description.integrator;
    if (traces_light(settings.method))
        return BidirectionalIntegrator(settings, camera, footprint_scale, description.film.crop,
                                       filter_radius(description.film.filter));
    if (settings.occlusion) return OcclusionIntegrator(settings, camera, footprint_scale);
    if (scene.has_media()) return VolumePathIntegrator(settings, camera, footprint_scale);
    return PathIntegrator(settings, camera, footprint_scale);
}

} // namespace

SampleContext::SampleContext(const SceneDescription& description, const SamplerSettings& sampler,
                             const SceneView& scene, const Camera& camera)
    : sampler_(sampler), max_component_value_(description.film.max_component_value), scene_(scene),
      camera_(camera), moves_(moves(description.scene)),
      normals_in_camera_space_(description.film.layers.in_camera_space), layers_(description, scene, camera),
      integrator_(make_integrator(description, scene, camera)), filter_(description.film.filter),
      sensor_(RgbColorSpace::srgb(), {description.film.exposure_time, description.film.iso,
                                      description.film.white_balance, description.film.sensor}),
      white_(RgbColorSpace::srgb().illuminant()),
      white_scale_(static_cast<float>(1 / integrate_luminance(white_))),
      background_(description.integrator.background),
      signed_filter_(std::holds_alternative<MitchellFilter>(description.film.filter) ||
                     std::holds_alternative<LanczosFilter>(description.film.filter)) {
    if (description.film.spectral) buckets_.emplace(*description.film.spectral);
}

PathStart<SampleStream> SampleContext::begin(const Key& key, FilmPoint& point) const {
    SampleStream stream(sampler_, static_cast<std::uint32_t>(key.x), static_cast<std::uint32_t>(key.y),
                        key.index);
    const Vec2f u_film = stream.next_2d();
    const float u_lambda = stream.next_1d();
    point.lens = camera_.has_lens() ? stream.next_2d() : Vec2f{0.5f, 0.5f};
    point.time = moves_ ? camera_.time_at(stream.next_1d()) : 0;
    point.filter = filter_.sample(u_film);
    point.film = {static_cast<float>(key.x) + 0.5f + point.filter.offset.x,
                  static_cast<float>(key.y) + 0.5f + point.filter.offset.y};
    const CameraRay ray = camera_.generate_ray(point.film, point.lens, point.time);
    point.weight = ray.weight;
    CameraSample camera{ray, SampledWavelengths::sample_visible(u_lambda)};
    if (guide_) camera.expected = guide_->expected(key.x, key.y);
    return {camera, stream};
}

SampleContext::Result SampleContext::finish(const FilmContribution& path, const SampledWavelengths& lambda,
                                            const FilmPoint& point, SpectralSample* spectral,
                                            SampleRecord* record) const {
    Result result;
    const FilterSample& filter = point.filter;
    const Vec3f sensor_rgb = sensor_.to_rgb(path.radiance * point.weight, path.lambda);
    const float largest = max_component(sensor_rgb);
    const float clamp = largest > max_component_value_ ? max_component_value_ / largest : 1;
    Vec3f rgb = sensor_rgb * clamp * filter.weight;
    Vec3f background;
    if (background_) [[unlikely]] {
        // Weights differ from 1 by the filter's table: a constant need not get its noise.
        background = *background_ * (path.transparency * (signed_filter_ ? filter.weight : 1.0f));
        rgb += background;
    }
    result.clamp = clamp;
    result.bad = badness(rgb, path.radiance);
    if (record != nullptr) [[unlikely]] {
        record->filter = filter;
        record->lambda = lambda;
        record->lambda_end = path.lambda;
        record->sensor_rgb = sensor_rgb;
        record->clamp = clamp;
        record->background = background;
        record->rgb = rgb;
        record->bad = result.bad;
    }
    if (result.bad) return result;
    result.film.radiance = rgb;
    if (spectral != nullptr) [[unlikely]]
        *spectral =
            spectral_sample(*buckets_, path.radiance, path.lambda, point.weight * clamp * filter.weight);
    if (clamp < 1) [[unlikely]]
        result.clamped =
            static_cast<float>(dot(Vec3d(sensor_rgb), luminance_weight)) * (1 - clamp) * filter.weight;
    if (const FirstHit& first = path.first; first.found) {
        result.film.albedo =
            albedo_sensor_.to_rgb(first.albedo * white_.sample(lambda) * white_scale_, lambda);
        result.film.normal = first.normal;
        if (normals_in_camera_space_) [[unlikely]]
            result.film.normal = normalize(camera_.camera_from_world(point.time).normal(first.normal));
        result.film.depth = first.depth;
    }
    return result;
}

void SampleContext::finish_splats(const SplatList& splats, const SampledWavelengths& lambda, Result& result,
                                  std::vector<FilmSplat>& out) const {
    for (const Splat& splat : splats) {
        Vec3f rgb = sensor_.to_rgb(splat.radiance, lambda);
        if (result.bad) return;
        result.bad = badness(rgb, splat.radiance);
        const float largest = max_component(rgb);
        // The filter's weight in a pixel may exceed 1.
        if (!result.bad && largest > static_cast<float>(SplatFilm::most * 0x1p-10))
            result.bad = BadSample::Kind::infinite;
        if (largest > max_component_value_) [[unlikely]] {
            const float clamp = max_component_value_ / largest;
            result.clamped += static_cast<float>(dot(Vec3d(rgb), luminance_weight)) * (1 - clamp);
            rgb *= clamp;
        }
        out.push_back({splat.film, rgb});
    }
}

void SampleContext::sample_layers(const SampleExtras& extras, const FilmContribution& path,
                                  const FilmPoint& point, float clamp, std::span<float> values) const {
    layers_.sample(extras, point.film, point.lens, point.filter.weight, values);
    float* to = values.data() + layers().first_part();
    for (const SampledSpectrum& part : extras.parts) {
        const Vec3f rgb = sensor_.to_rgb(part * point.weight, path.lambda) * clamp * point.filter.weight;
        for (int c = 0; c < 3; ++c) *to++ = rgb[c];
    }
}

void SampleContext::set_guide(std::shared_ptr<const GuidingField> guide) {
    guide_ = std::move(guide);
    if (auto* path = std::get_if<PathIntegrator>(&integrator_)) path->set_guide(guide_.get());
}

void SampleContext::trace_for_guide(RayTracer& tracer, std::span<const Key> keys, Batch& batch) const {
    batch.points.resize(keys.size());
    batch.paths.resize(keys.size());
    batch.traces.resize(keys.size());
    batch.starts.clear();
    for (std::size_t i = 0; i < keys.size(); ++i) {
        batch.starts.push_back(begin(keys[i], batch.points[i]));
        batch.traces[i].clear();
        batch.starts[i].camera.trace = &batch.traces[i];
    }
    std::visit(
        [&](const auto& integrator) {
            using I = std::decay_t<decltype(integrator)>;
            integrator.estimate(scene_, tracer, std::span(batch.starts), batch.integrator.of<I>(),
                                std::span(batch.paths));
        },
        integrator_);
}

void SampleContext::take(RayTracer& tracer, std::span<const Key> keys, Batch& batch,
                         std::span<Result> results) const {
    batch.points.resize(keys.size());
    batch.paths.resize(keys.size());
    batch.starts.clear();
    batch.starts.reserve(keys.size());
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const auto beginning = [&] { return begin(keys[i], batch.points[i]); };
        batch.starts.emplace_back(InPlace(beginning));
    }
    if (layers_.wants_extras()) [[unlikely]] {
        const std::size_t parts = layers().parts();
        batch.parts.assign(keys.size() * parts, SampledSpectrum());
        batch.extras.clear();
        for (std::size_t i = 0; i < keys.size(); ++i)
            batch.extras.push_back(layers_.extras(std::span(batch.parts).subspan(i * parts, parts)));
        for (std::size_t i = 0; i < keys.size(); ++i) batch.starts[i].camera.extras = &batch.extras[i];
        batch.layer_values.resize(keys.size() * layers().values());
    }
    if (makes_splats()) {
        if (batch.splats.size() < keys.size()) batch.splats.resize(keys.size());
        for (std::size_t i = 0; i < keys.size(); ++i) {
            batch.splats[i].clear();
            batch.starts[i].camera.splats = &batch.splats[i];
        }
    }
    std::visit(
        [&](const auto& integrator) {
            using I = std::decay_t<decltype(integrator)>;
            integrator.estimate(scene_, tracer, std::span(batch.starts), batch.integrator.of<I>(),
                                std::span(batch.paths));
        },
        integrator_);
    if (buckets_) batch.spectral.assign(keys.size(), {});
    for (std::size_t i = 0; i < keys.size(); ++i)
        results[i] = finish(batch.paths[i], batch.starts[i].camera.lambda, batch.points[i],
                            buckets_ ? &batch.spectral[i] : nullptr);
    if (makes_splats()) {
        batch.film_splats.clear();
        batch.first_splat.assign(1, 0);
        for (std::size_t i = 0; i < keys.size(); ++i) {
            finish_splats(batch.splats[i], batch.paths[i].lambda, results[i], batch.film_splats);
            batch.first_splat.push_back(batch.film_splats.size());
        }
    }
    if (!layers_.wants_extras()) return;
    const std::size_t values = layers().values();
    for (std::size_t i = 0; i < keys.size(); ++i)
        if (!results[i].bad)
            sample_layers(batch.extras[i], batch.paths[i], batch.points[i], results[i].clamp,
                          std::span(batch.layer_values).subspan(i * values, values));
}

SampleRecord SampleContext::record(RayTracer& tracer, const Key& key) const {
    SampleRecord record;
    FilmPoint point;
    PathStart<SampleStream> start = begin(key, point);
    std::vector<SampledSpectrum> parts(layers().parts());
    SampleExtras extras = layers_.extras(parts);
    if (layers_.wants_extras()) start.camera.extras = &extras;
    const FilmContribution path = std::visit(
        [&](const auto& integrator) {
            return integrator.estimate(scene_, tracer, start.camera, start.stream, &record.path);
        },
        integrator_);
    record.x = key.x;
    record.y = key.y;
    record.index = key.index;
    record.film = point.film;
    record.lens = point.lens;
    record.time = point.time;
    const Result result = finish(path, start.camera.lambda, point, nullptr, &record);
    record.contribution = result.film;
    if (layers_.wants_extras() && !result.bad) {
        record.layer_values.resize(layers().values());
        sample_layers(extras, path, point, result.clamp, record.layer_values);
    }
    return record;
}

} // namespace montelux
