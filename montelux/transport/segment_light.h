// SegmentLight: distances along a ray at which the light of a lamp near the ray is looked for.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "montelux/mc/warp/equiangular.h"
#include "montelux/scene/light/light_sampling.h"
#include "montelux/scene/medium/medium_model.h"
#include "montelux/scene/shape/ray.h"
#include "montelux/scene/view.h"

namespace montelux {

// The part of a ray on which there is a medium, and the mean of its majorant there, over the wavelengths too.
struct MediumExtent {
    float t0 = 0, t1 = 0;
    float extinction = 0;

    bool empty() const { return !(t0 < t1 && extinction > 0); }
};

// Of a ray with a direction of unit length; bounded unless the medium is homogeneous.
template <MediumModel M, SampledMedium S>
MediumExtent medium_extent(const S& sampled, const Ray& ray) {
    if constexpr (M::homogeneous) {
        return {0, ray.t_max, average(sampled.point.sigma_a + sampled.point.sigma_s)};
    } else {
        MediumExtent extent;
        float depth = 0;
        MajorantWalk walk = sampled.majorants(ray);
        for (MajorantSegment piece; walk.next(piece);) {
            const float majorant = average(piece.majorant);
            if (!(majorant > 0)) continue;
            if (!(depth > 0)) extent.t0 = piece.t0;
            extent.t1 = piece.t1;
            depth += majorant * (piece.t1 - piece.t0);
        }
        if (extent.t0 < extent.t1) extent.extinction = depth / (extent.t1 - extent.t0);
        return extent;
    }
}

// A ray through a medium, from where that begins. The strategy chooses a part of a light, and a distance by the
// equiangular density about the centre of that part; light is then sampled on the part from there. Half of the choices
// are made for a point of the ray, the others by power alone: a beam may cross the ray elsewhere.
struct SegmentLight {
    Point3f o{};
    Vec3f d{};            // unit
    float length = 0;     // 0: the strategy is not used. May be infinite.
    float extinction = 0; // MediumExtent::extinction
    float start = 0;      // distance of o from the origin of the path's ray
    float at = 0;         // distance of the path's scattering event from o
    float time = 0;       // of the path

    // Lamps farther away are left to free flights: little of their light arrives, and it is spread evenly.
    static constexpr float most_depth = 4;

    // Half of the length, or a mean free path if that is less.
    ReferencePoint middle() const { return {o + d * std::min(0.5f * length, 1 / extinction)}; }
    // u in [0, 1).
    LightChoice choose(const SceneView& scene, double u) const {
        const ReferencePoint from = middle();
        LightChoice chosen =
            u < 0.5 ? scene.light_sampler->sample(from, 2 * u) : scene.segment_lights->sample({}, 2 * u - 1);
        const float other = u < 0.5 ? scene.segment_lights->probability({}, chosen.light, chosen.part)
                                    : scene.light_sampler->probability(from, chosen.light, chosen.part);
        chosen.probability = 0.5f * (chosen.probability + other);
        return chosen;
    }
    float choice(const SceneView& scene, Index light, Index part) const {
        return 0.5f * (scene.light_sampler->probability(middle(), light, part) +
                       scene.segment_lights->probability({}, light, part));
    }

    // Empty for parts without a position, or too far.
    std::optional<Equiangular<float>> distances(const SceneView& scene, Index light, Index part) const {
        const std::optional<LightBounds> bounds = light_bounds({scene, light, time}, part);
        if (!bounds) return std::nullopt;
        const Vec3f to(bounds->box.center() - Vec3d(o));
        const float foot = dot(to, d), far = montelux::length(to);
        if (!(extinction * far < most_depth)) return std::nullopt;
        // The light of a lamp does not rise further within its size.
        const float least = std::max(0.5f * static_cast<float>(bounds->box.radius()), 1e-4f * far);
        const float beside = std::max(montelux::length(to - foot * d), least);
        if (!(beside > std::numeric_limits<float>::min())) return std::nullopt;
        return Equiangular<float>{foot, beside, length};
    }

    // Density of choosing this part and the distance `at`, per length.
    float pdf(const SceneView& scene, Index light, Index part) const {
        if (!(length > 0)) return 0;
        const std::optional<Equiangular<float>> found = distances(scene, light, part);
        return found ? choice(scene, light, part) * found->pdf(at) : 0;
    }
};

} // namespace montelux
