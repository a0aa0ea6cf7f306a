// HomogeneousMedium: the same coefficients everywhere.
#pragma once

#include "montelux/scene/medium/body_surface.h"
#include "montelux/scene/medium/medium_model.h"

namespace montelux {

struct HomogeneousMedium {
    static constexpr const char* name = "Homogeneous";
    static constexpr bool homogeneous = true;

    SceneSpectrum sigma_a{1}, sigma_s{1}; // times `scale`, per unit of length
    float scale = 1;
    SceneSpectrum le{}; // emitted radiance, times `le_scale`
    float le_scale = 1;
    PhaseFunction phase{};
    // The interior of a translucent body: what happens in it counts as one scattering event of a path with that of
    // entering, and lights are looked for only where the path leaves it.
    bool is_body = false;
    BodySurface surface{}; // of a body; its coefficients are used instead, if given

    struct Sampled {
        MediumPoint point;

        MediumPoint coefficients(Point3f) const { return point; }
        MajorantWalk majorants(const Ray& ray) const { return {0, ray.t_max, point.sigma_a + point.sigma_s}; }
    };
    Sampled at(const SceneView& scene, Index medium, const SampledWavelengths& lambda) const;
    MediumTable table(const Scene&) const { return {}; }
};

} // namespace montelux
