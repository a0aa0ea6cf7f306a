// What the path tracer tells the one who writes its path down.
#pragma once

#include "montelux/transport/path_record.h"

namespace montelux {

// Writes to a record, or stands for none: then it is false, and nothing may be told. The path tracer has one
// copy for both cases, so that a path that is written down is to the last bit the path of the render; it must
// not be given the chance to depend on who looks.
class PathRecorder {
  public:
    explicit PathRecorder(PathRecord* record) : record_(record) {
        if (record_ != nullptr) [[unlikely]]
            begin();
    }
    explicit operator bool() const { return record_ != nullptr; }

    // In the order in which it happens. The ray hit a surface, or left the scene.
    [[gnu::cold]] void hit_surface(const Ray& ray, const Hit& hit, const SurfacePoint& surface,
                                   SampledSpectrum throughput) const;
    [[gnu::cold]] void left_scene(const Ray& ray, SampledSpectrum throughput) const;
    // Contributions are for the recorder to multiply.
    [[gnu::cold]] void found_light(FoundLight light) const;
    [[gnu::cold]] void made_bsdf(const SurfaceBsdf& bsdf, Vec3f wo) const;
    [[gnu::cold]] void sampled_light(DirectLight light) const;
    // The shadow ray of the light that was sampled.
    [[gnu::cold]] void occluded() const;
    [[gnu::cold]] void scattered(const Scattering& scattering) const;
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
