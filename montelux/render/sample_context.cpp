#include "montelux/render/sample_context.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "montelux/film/splat_film.h"
#include "montelux/mc/random/golden_ratio.h"
#include "montelux/mc/random/hash.h"
#include "montelux/mc/random/uniform_bits.h"
#include "montelux/mc/random/weyl.h"
#include "montelux/transport/found_path.h"
#include "montelux/transport/visible_pixel.h"

namespace montelux {

namespace {

// Of the sequences from which passes that merge take their wavelengths and times.
const std::uint64_t wavelength_step = golden_ratio_step(0, generalised_golden_ratio(1)),
                    time_step = weyl_step(0);

// Scenes without media pay nothing for them.
Integrator make_integrator(const SceneDescription& description, const IntegratorSettings& settings,
                           const SceneView& scene, const Camera& camera) {
    if (traces_light(settings.method))
        return BidirectionalIntegrator(settings, camera, footprint_scale, description.film.crop,
                                       filter_radius(description.film.filter), scene.has_media());
    if (settings.occlusion) return OcclusionIntegrator(settings, camera, footprint_scale);
    if (scene.has_media()) return VolumePathIntegrator(settings, camera, footprint_scale);
    return PathIntegrator(settings, camera, footprint_scale);
}

} // namespace

SampleContext::SampleContext(const SceneDescription& description, const SamplerSettings& sampler,
                             const SceneView& scene, const Camera& camera,
                             const IntegratorSettings& integrator)
    : sampler_(sampler), scene_(scene), camera_(camera), moves_(moves(description.scene)),
      normals_in_camera_space_(description.film.layers.in_camera_space), layers_(description, scene, camera),
      integrator_(make_integrator(description, integrator, scene, camera)),
      merges_(montelux::merges(integrator)), filter_(description.film.filter),
      most_splat_(static_cast<float>(SplatFilm::most) / std::max(1.0f, filter_.normalized({}))),
      exposure_(description), white_(RgbColorSpace::srgb().illuminant()),
      white_scale_(static_cast<float>(1 / integrate_luminance(white_))),
      can_be_guided_((std::holds_alternative<PathIntegrator>(integrator_) ||
                      std::holds_alternative<VolumePathIntegrator>(integrator_)) &&
                     description.integrator.method == IntegratorKind::path &&
                     integrator.strategy != Strategy::uniform) {
    if (description.film.spectral) buckets_.emplace(*description.film.spectral);
    if (auto* path = std::get_if<PathIntegrator>(&integrator_); path && integrator.manifold_sampling) {
        casters_ = std::make_shared<Casters>(scene);
        if (!casters_->empty()) path->set_casters(casters_.get());
    }
}

PathStart<SampleStream> SampleContext::begin(const Key& key, FilmPoint& point) const {
    SampleStream stream(sampler_, static_cast<std::uint32_t>(key.x), static_cast<std::uint32_t>(key.y),
                        key.index);
    const Vec2f u_film = stream.next_2d();
    float u_lambda = stream.next_1d();
    point.lens = camera_.has_lens() ? stream.next_2d() : Vec2f{0.5f, 0.5f};
    float u_time = moves_ ? stream.next_1d() : 0;
    if (merges_) [[unlikely]] {
        // Of the whole picture: sequences that cover wavelengths and times evenly after any number of passes.
        const auto shared = [&](std::uint64_t dimension, std::uint64_t step) {
            const std::uint64_t place = hash_key(sampler_.seed, dimension) + key.index * step;
            return unit_float(static_cast<std::uint32_t>(place >> 32));
        };
        u_lambda = shared(0x77617665, wavelength_step);
        if (moves_) u_time = shared(0x74696d65, time_step);
    }
    point.time = moves_ ? camera_.time_at(u_time) : 0;
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
    const FilmExposure::Exposed exposed = exposure_(path, point.weight, filter.weight);
    const float clamp = exposed.clamp;
    result.clamp = clamp;
    result.bad = exposed.bad;
    if (record != nullptr) [[unlikely]] {
        record->filter = filter;
        record->lambda = lambda;
        record->lambda_end = path.lambda;
        record->sensor_rgb = exposed.sensor_rgb;
        record->clamp = clamp;
        record->background = exposed.background;
        record->rgb = exposed.rgb;
        record->bad = result.bad;
    }
    if (result.bad) return result;
    result.film.radiance = exposed.rgb;
    if (spectral != nullptr) [[unlikely]]
        *spectral =
            spectral_sample(*buckets_, path.radiance, path.lambda, point.weight * clamp * filter.weight);
    if (clamp < 1) [[unlikely]]
        result.clamped = exposed.clamped() * filter.weight;
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
        if (result.bad) return;
        const FilmExposure::Exposed exposed = exposure_({splat.radiance, lambda, {}, 0}, 1);
        result.bad = exposed.bad;
        if (!result.bad && max_component(exposed.rgb) > most_splat_) result.bad = BadSample::Kind::infinite;
        if (exposed.clamp < 1) [[unlikely]]
            result.clamped += exposed.clamped();
        out.push_back({splat.film, exposed.rgb});
    }
}

void SampleContext::sample_layers(const SampleExtras& extras, const FilmContribution& path,
                                  const FilmPoint& point, float clamp, std::span<float> values) const {
    layers_.sample(extras, point.film, point.lens, point.filter.weight, values);
    float* to = values.data() + layers().first_part();
    for (const SampledSpectrum& part : extras.parts) {
        const Vec3f rgb =
            exposure_.sensor().to_rgb(part * point.weight, path.lambda) * clamp * point.filter.weight;
        for (int c = 0; c < 3; ++c) *to++ = rgb[c];
    }
}

void SampleContext::set_guide(std::shared_ptr<const GuidingField> guide) {
    guide_ = std::move(guide);
    if (auto* path = std::get_if<PathIntegrator>(&integrator_)) path->set_guide(guide_.get());
    if (auto* path = std::get_if<VolumePathIntegrator>(&integrator_)) path->set_guide(guide_.get());
}

void SampleContext::set_light_map(std::shared_ptr<const LightMap> map) {
    light_map_ = std::move(map);
    if (auto* paths = std::get_if<BidirectionalIntegrator>(&integrator_))
        paths->set_light_map(light_map_.get());
}

SampleStream SampleContext::light_stream(const Key& key) const {
    SamplerSettings settings = sampler_;
    settings.seed = hash_key(settings.seed, 0x6c69676874); // "light"
    return SampleStream(settings, static_cast<std::uint32_t>(key.x), static_cast<std::uint32_t>(key.y),
                        key.index);
}

void SampleContext::trace_light(RayTracer& tracer, std::span<const Key> keys, LightPaths& paths) const {
    const auto& integrator = std::get<BidirectionalIntegrator>(integrator_);
    BidirectionalMemory memory;
    for (const Key& key : keys) {
        FilmPoint point;
        const PathStart<SampleStream> start = begin(key, point);
        SampleStream numbers = light_stream(key);
        integrator.trace_light(scene_, tracer, start.camera, numbers, memory, paths);
    }
}

std::optional<double> SampleContext::visible_pixel(RayTracer& tracer, const Key& key) const {
    FilmPoint point;
    PathStart<SampleStream> start = begin(key, point);
    return montelux::visible_pixel(scene_, camera_, tracer, start.camera, start.stream);
}

void SampleContext::begin(std::span<const Key> keys, Batch& batch) const {
    batch.points.resize(keys.size());
    batch.paths.resize(keys.size());
    batch.starts.clear();
    batch.starts.reserve(keys.size());
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const auto beginning = [&] { return begin(keys[i], batch.points[i]); };
        batch.starts.emplace_back(InPlace(beginning));
    }
}

void SampleContext::trace(RayTracer& tracer, Batch& batch) const {
    std::visit(
        [&](const auto& integrator) {
            using I = std::decay_t<decltype(integrator)>;
            integrator.estimate(scene_, tracer, std::span(batch.starts), batch.integrator.of<I>(),
                                std::span(batch.paths));
        },
        integrator_);
}

void SampleContext::trace_for_guide(RayTracer& tracer, std::span<const Key> keys, Batch& batch) const {
    begin(keys, batch);
    batch.traces.resize(keys.size());
    for (std::size_t i = 0; i < keys.size(); ++i) {
        batch.traces[i].clear();
        batch.starts[i].camera.trace = &batch.traces[i];
    }
    trace(tracer, batch);
}

void SampleContext::take(RayTracer& tracer, std::span<const Key> keys, Batch& batch,
                         std::span<Result> results) const {
    begin(keys, batch);
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
    if (merges_) {
        batch.merging.clear();
        for (const Key& key : keys) batch.merging.push_back({light_stream(key)});
        for (std::size_t i = 0; i < keys.size(); ++i) batch.starts[i].camera.merging = &batch.merging[i];
    }
    trace(tracer, batch);
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
    if (merges_)
        for (std::size_t i = 0; i < keys.size(); ++i)
            if (!results[i].bad)
                results[i].narrower = exposure_.sensor().to_rgb(
                    batch.merging[i].narrower * batch.points[i].weight, batch.paths[i].lambda);
    if (!layers_.wants_extras()) return;
    const std::size_t values = layers().values();
    for (std::size_t i = 0; i < keys.size(); ++i)
        if (!results[i].bad)
            sample_layers(batch.extras[i], batch.paths[i], batch.points[i], results[i].clamp,
                          std::span(batch.layer_values).subspan(i * values, values));
}

void SampleContext::find_paths(RayTracer& tracer, const Key& key, BidirectionalMemory& memory,
                               const std::function<void(const FilmPath&)>& visit) const {
    FilmPoint point;
    PathStart<SampleStream> start = begin(key, point);
    MergingSample merging{light_stream(key)};
    if (merges_) start.camera.merging = &merging;
    std::vector<double> scratch;
    auto found = [&](const FoundPath& path) {
        // Where secondary wavelengths have ended, the value is zero at these.
        Vec3f rgb = exposure_.sensor().to_rgb(path.value, start.camera.lambda);
        if (path.film == nullptr) rgb = rgb * (point.weight * point.filter.weight);
        const std::size_t strategy = path.merged != nullptr ? path.densities.vertices() + path.s : path.s;
        visit({path.s, path.t, path.film, rgb, path.weight,
               path_tracing_density(path.densities, strategy, scratch),
               path.merged != nullptr ? no_index : path.end.light});
    };
    const PathObserver observer{
        [](void* self, const FoundPath& path) { (*static_cast<decltype(found)*>(self))(path); }, &found};
    memory.ignored.clear();
    std::get<BidirectionalIntegrator>(integrator_)
        .estimate(scene_, tracer, start.camera, start.stream, memory, &observer);
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
