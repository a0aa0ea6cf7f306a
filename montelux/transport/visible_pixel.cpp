#include "montelux/transport/visible_pixel.h"

#include <cmath>
#include <vector>

#include "montelux/mc/random/sample_stream.h"
#include "montelux/transport/subpath_walk.h"

namespace montelux {

namespace {

// Nothing that happens between vertices matters.
struct NoEvents {
    void passed(const SubpathEnd&, const SurfacePoint&, const Hit&) {}
    void met(const SubpathEnd&, const Hit&) {}
    void left(const SubpathEnd&) {}
    void emitted(const SubpathEnd&, SampledSpectrum) {}
    void looped() {}
};

} // namespace

template <RandomStream Stream>
std::optional<double> visible_pixel(const SceneView& scene, const Camera& camera, RayTracer& tracer,
                                    const CameraSample& sample, Stream& stream) {
    SubpathEnd end;
    end.ray = sample.ray;
    end.lambda = sample.lambda;
    end.medium = scene.camera_medium;
    std::vector<SubpathVertex> path;
    NoEvents events;
    float distance = 0;
    constexpr int most = 16;
    for (int k = 0; k < most; ++k) {
        SubpathVertex* v = walk_to_vertex(path, scene, tracer, end, stream, events);
        if (v == nullptr) return std::nullopt;
        distance += std::sqrt(v->distance2);
        if (v->phase != nullptr || !make_scattering(scene, camera, 1, *v, end)) return std::nullopt;
        if (v->connectible) {
            const double density = double(camera.density(sample.ray.d, distance, sample.ray.time));
            return density > 0 ? std::optional(1 / std::sqrt(density)) : std::nullopt;
        }
        const auto scattered =
            std::visit([&](const auto& bsdf) { return bsdf.sample(v->wo, TransportMode::radiance, stream); },
                       v->surface.bsdf);
        if (!scattered) return std::nullopt;
        const Vec3f wi = v->surface.frame.to_world(scattered->wi);
        end.medium = v->medium_towards(wi);
        end.ray.o = offset_origin(v->s.p, v->s.ng, v->s.error, wi);
        end.ray.d = normalize(wi);
    }
    return std::nullopt;
}

template std::optional<double> visible_pixel(const SceneView&, const Camera&, RayTracer&, const CameraSample&,
                                             SampleStream&);

} // namespace montelux
