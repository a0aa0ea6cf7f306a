#include "montelux/transport/path_recorder.h"

#include <memory>

#include "montelux/scene/material/make_bsdf.h"

namespace montelux {

void PathRecorder::begin() const { *record_ = {}; }

PathVertex& PathRecorder::add_vertex(const Ray& ray, SampledSpectrum throughput) const {
    PathVertex& v = record_->vertices.emplace_back();
    v.ray = ray;
    v.throughput = throughput;
    return v;
}

void PathRecorder::hit_surface(const Ray& ray, const Hit& hit, const SurfacePoint& surface,
                               SampledSpectrum throughput) const {
    PathVertex& v = add_vertex(ray, throughput);
    v.hit = hit;
    v.surface = surface;
}

void PathRecorder::left_scene(const Ray& ray, SampledSpectrum throughput) const {
    add_vertex(ray, throughput);
}

void PathRecorder::collided(const Ray& ray, const MediumEvent& event, SampledSpectrum throughput) const {
    add_vertex(ray, throughput).medium = event;
}

void PathRecorder::emitted(SampledSpectrum radiance) const { record_->emission += radiance; }

void PathRecorder::found_light(FoundLight light) const {
    PathVertex& v = last();
    if (light.counted) light.contribution = v.throughput * light.radiance * light.weight;
    v.found.push_back(light);
}

void PathRecorder::made_bsdf(const SurfaceBsdf& bsdf, Vec3f wo) const {
    last().bsdf = std::make_shared<const SurfaceBsdf>(bsdf);
    last().wo = wo;
}

void PathRecorder::sampled_light(DirectLight light) const {
    PathVertex& v = last();
    if (light.outcome == DirectLight::Outcome::counted)
        light.contribution = v.throughput * light.f * light.radiance * (light.weight / light.light_pdf);
    v.direct = light;
}

void PathRecorder::sampled_light_on_ray(float distance, DirectLight light, SampledSpectrum throughput) const {
    if (light.outcome == DirectLight::Outcome::counted)
        light.contribution = throughput * light.f * light.radiance * (light.weight / light.light_pdf);
    record_->on_rays.push_back({record_->vertices.size(), distance, throughput, light});
}

void PathRecorder::occluded() const {
    last().direct->outcome = DirectLight::Outcome::occluded;
    last().direct->contribution = {};
}

void PathRecorder::scattered(const Scattering& scattering) const {
    PathVertex& v = last();
    v.continued = v.throughput * scattering.sample.weight;
    v.scattering = scattering;
}

void PathRecorder::scattered_in_medium(Vec3f wi, float pdf, SampledSpectrum continued) const {
    PathVertex& v = last();
    v.medium->scattered = true;
    v.medium->wi = wi;
    v.medium->pdf = pdf;
    v.continued = continued;
}

void PathRecorder::played_roulette(Roulette roulette) const {
    PathVertex& v = last();
    if (roulette.u < roulette.survival)
        v.continued /= roulette.survival;
    else
        v.continued = {};
    v.roulette = roulette;
}

void PathRecorder::ended(PathEnd end) const { record_->end = end; }
void PathRecorder::traced(SampledSpectrum radiance) const { record_->radiance = radiance; }

} // namespace montelux
