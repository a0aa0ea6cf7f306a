// PathRecorder: writes the path tracer's steps to a PathRecord, or nowhere.
#pragma once

#include "montelux/transport/path_record.h"

namespace montelux {

// Without a record it converts to false, and no member may be called. One copy of the path tracer serves both
// cases, so a recorded path equals the rendered one to the last bit; recording must never influence the path.
class PathRecorder {
  public:
    explicit PathRecorder(PathRecord* record) : record_(record) {
        if (record_ != nullptr) [[unlikely]]
            begin();
    }
    explicit operator bool() const { return record_ != nullptr; }

    // In order of events. The ray hit a surface, left the scene, or collided with a medium.
    [[gnu::cold]] void hit_surface(const Ray& ray, const Hit& hit, const SurfacePoint& surface,
                                   SampledSpectrum throughput) const;
    [[gnu::cold]] void left_scene(const Ray& ray, SampledSpectrum throughput) const;
    // The recorder multiplies the contributions.
    [[gnu::cold]] void collided(const Ray& ray, const MediumEvent& event, SampledSpectrum throughput) const;
    // Radiance of media along the ray.
    [[gnu::cold]] void emitted(SampledSpectrum radiance) const;
    [[gnu::cold]] void found_light(FoundLight light) const;
    [[gnu::cold]] void made_bsdf(const SurfaceBsdf& bsdf, Vec3f wo) const;
    [[gnu::cold]] void sampled_light(DirectLight light) const;
    // From a point of the ray to the next vertex.
    [[gnu::cold]] void sampled_light_on_ray(float distance, DirectLight light,
                                            SampledSpectrum throughput) const;
    // The shadow ray of the light that was sampled.
    [[gnu::cold]] void occluded() const;
    [[gnu::cold]] void scattered(const Scattering& scattering) const;
    [[gnu::cold]] void scattered_in_medium(Vec3f wi, float pdf, SampledSpectrum continued) const;
    [[gnu::cold]] void played_roulette(Roulette roulette) const;
    [[gnu::cold]] void ended(PathEnd end) const;
    [[gnu::cold]] void traced(SampledSpectrum radiance) const;

  private:
    [[gnu::cold]] void begin() const;
    PathVertex& add_vertex(const Ray& ray, SampledSpectrum throughput) const;
    PathVertex& last() const { return record_->vertices.back(); }

    PathRecord* record_;
};

} // namespace montelux
