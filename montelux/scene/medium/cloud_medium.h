// CloudMedium: a procedural cumulus of gradient noise.
#pragma once

#include "montelux/scene/medium/medium_model.h"

namespace montelux {

// pbrt-v4's cloud (Pharr, Jakob, Humphreys 2023, "Physically Based Rendering", 4th edition, section 11.4): y is
// the altitude. The density is 1 at the bottom of the box, falls off above half the height, and is at most 1.
struct CloudMedium {
    static constexpr const char* name = "Cloud";
    static constexpr bool homogeneous = false;

    MediumBox box;
    SceneSpectrum sigma_a{1}, sigma_s{1}; // times the density of the cloud
    float density = 1;                    // amplitude of the noise; not negative
    float wispiness = 1;                  // distortion of the noise
    float frequency = 5;                  // of the noise, in the space of the medium
    PhaseFunction phase{};

    // At a point in the space of the medium, in [0, 1].
    float density_at(Point3f p) const;

    struct Sampled {
        const CloudMedium* medium;
        const MediumTable* table;
        SampledSpectrum sigma_a, sigma_s;

        MediumPoint coefficients(Point3f p) const {
            const float d = medium->density_at(table->medium_from_world.point(p));
            return {sigma_a * d, sigma_s * d, {}};
        }
        MajorantWalk majorants(const Ray& ray) const {
            const CubeInterval inside = intersect_unit_cube(table->unit_from_world.ray(ray));
            return {inside.t0, inside.t1, sigma_a + sigma_s};
        }
    };
    Sampled at(const SceneView& scene, Index medium, const SampledWavelengths& lambda) const;
    MediumTable table(const Scene& scene) const;
};

} // namespace montelux
