#include "montelux/render/metropolis/primary_sampler.h"

#include <algorithm>
#include <cmath>

#include "montelux/render/sample_context.h"
#include "montelux/transport/path_shading.h"
#include "montelux/transport/volume_path.h"

namespace montelux {
namespace {

std::variant<PathIntegrator, VolumePathIntegrator>
path_integrator_of(const IntegratorSettings& settings, const SceneView& scene, const Camera& camera) {
    if (scene.has_media()) return VolumePathIntegrator(settings, camera, footprint_scale);
    return PathIntegrator(settings, camera, footprint_scale);
}

double mean_magnitude(Vec3f rgb) {
    return (std::abs(double(rgb.x)) + std::abs(double(rgb.y)) + std::abs(double(rgb.z))) / 3;
}

constexpr RadianceSplit indirect_split{.indirect = 0};

} // namespace

PrimarySampler::PrimarySampler(const SceneDescription& description, const SceneView& scene,
                               const Camera& camera, bool indirect_only)
    : scene_(scene), camera_(camera), moves_(moves(description.scene)), indirect_only_(indirect_only),
      integrator_(path_integrator_of(description.integrator, scene, camera)), exposure_(description),
      filter_(description.film.filter), crop_(description.film.crop) {
    const Vec2f r = filter_.radius();
    begin_ = {static_cast<float>(crop_.x0) + 0.5f - r.x, static_cast<float>(crop_.y0) + 0.5f - r.y};
    size_ = {static_cast<float>(crop_.width() - 1) + 2 * r.x,
             static_cast<float>(crop_.height() - 1) + 2 * r.y};
    area_ = size_.x * size_.y;
}

void PrimarySampler::evaluate(RayTracer& tracer, std::span<PrimarySamples* const> states,
                              const FilmImportance& importance, Memory& memory,
                              std::span<PrimarySample> results) const {
    memory.starts.clear();
    memory.weights.clear();
    memory.paths.resize(states.size());
    if (indirect_only_) {
        memory.indirect.assign(states.size(), SampledSpectrum());
        memory.extras.clear();
        for (std::size_t i = 0; i < states.size(); ++i)
            memory.extras.push_back({.split = &indirect_split, .parts = {&memory.indirect[i], 1}});
    }
    for (std::size_t i = 0; i < states.size(); ++i) {
        PrimarySampleStream stream(*states[i]);
        const Vec2f u_film = stream.next_2d();
        const float u_lambda = stream.next_1d();
        const Vec2f lens = camera_.has_lens() ? stream.next_2d() : Vec2f{0.5f, 0.5f};
        const float time = moves_ ? camera_.time_at(stream.next_1d()) : 0;
        results[i].film = {begin_.x + u_film.x * size_.x, begin_.y + u_film.y * size_.y};
        const CameraRay ray = camera_.generate_ray(results[i].film, lens, time);
        memory.weights.push_back(ray.weight);
        memory.starts.push_back({{ray, SampledWavelengths::sample_visible(u_lambda)}, stream});
        if (indirect_only_) memory.starts.back().camera.extras = &memory.extras[i];
    }
    std::visit(
        [&](const auto& integrator) {
            integrator.estimate(scene_, tracer, std::span(memory.starts), memory.batch,
                                std::span(memory.paths));
        },
        integrator_);
    for (std::size_t i = 0; i < states.size(); ++i) {
        FilmContribution& path = memory.paths[i];
        const FilmExposure::Exposed all = exposure_(path, memory.weights[i]);
        results[i].brightness = all.bad ? 0 : static_cast<float>(mean_magnitude(all.rgb));
        FilmExposure::Exposed exposed = all;
        // What makes a sample bad is left where it is.
        if (indirect_only_ && all_finite(path.radiance)) {
            path.radiance = memory.indirect[i];
            path.transparency = 0;
            exposed = exposure_(path, memory.weights[i]);
        }
        PrimarySample& r = results[i];
        r.bad = exposed.bad;
        r.rgb = r.bad ? Vec3f{} : exposed.rgb * area_;
        const double size = mean_magnitude(r.rgb);
        r.size = size > 0 ? size * importance.at(r.film) : 0;
        r.clamped = !r.bad && exposed.clamp < 1 ? exposed.clamped() * area_ : 0;
    }
}

void PrimarySampler::splat(SplatFilm& film, const PrimarySample& sample, double weight) const {
    film.add_filtered(filter_, sample.film, Vec3d(sample.rgb) * weight);
}

Vec2<int> PrimarySampler::pixel_of(Point2f film) const {
    return {std::clamp(static_cast<int>(std::floor(film.x)), crop_.x0, crop_.x1 - 1),
            std::clamp(static_cast<int>(std::floor(film.y)), crop_.y0, crop_.y1 - 1)};
}

} // namespace montelux
