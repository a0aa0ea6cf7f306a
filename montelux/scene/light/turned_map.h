// TurnedMap: an environment map's density under a transformation, in world space.
#pragma once

#include <optional>

#include "montelux/mc/math/transform.h"
#include "montelux/scene/light/environment/environment_sampler.h"

namespace montelux {

// Solid angle in the light's space over that in the world around wi: 1 unless the transformation scales
// unevenly.
inline float solid_angle_change(const Transform& world_from_light, Vec3f wi) {
    const double l = length(world_from_light.inverse_vector(Vec3d(wi)));
    return static_cast<float>(std::abs(world_from_light.inverse_matrix().linear_determinant()) / (l * l * l));
}

// The members outlive it.
struct TurnedMap {
    const EnvironmentSampler& map;
    const Transform& world_from_light;

    struct Sample {
        Vec3f wi;      // unit, in world space
        Vec2f grid;    // the place on the map
        float pdf = 0; // per solid angle in world space
    };

    static Vec3f in_light_space(const Transform& world_from_light, Vec3f wi) {
        return normalize(Vec3f(world_from_light.inverse_vector(Vec3d(wi))));
    }
    Vec2f place(Vec3f wi) const { return map.grid().locate(in_light_space(world_from_light, wi)); }

    // Empty where the density is zero.
    std::optional<Sample> sample(Vec2f u) const {
        const EnvironmentPoint s = map.sample(u);
        if (!(s.pdf > 0)) return std::nullopt;
        const Vec3f wi = normalize(world_from_light.vector(map.grid().direction(s.grid)));
        return Sample{wi, s.grid, s.pdf * solid_angle_change(wi)};
    }
    float pdf(Vec3f wi) const { return map.pdf(place(wi)) * solid_angle_change(wi); }

    // For emission, which no other strategy finds: a compensated density is zero in places with light, so
    // half of the directions are uniform.
    std::optional<Sample> sample_everywhere(Vec2f u) const;
    float pdf_everywhere(Vec3f wi) const;

  private:
    float solid_angle_change(Vec3f wi) const { return montelux::solid_angle_change(world_from_light, wi); }
};

} // namespace montelux
