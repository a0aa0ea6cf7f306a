// Tables that choose lights and sample them: powers, triangles, environment maps.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "montelux/mc/dist/alias_table.h"
#include "montelux/scene/light/environment/environment_sampler.h"
#include "montelux/scene/light/environment/portal_sampler.h"
#include "montelux/scene/scene.h"
#include "montelux/scene/shape/quadric.h"

namespace montelux {

// A triangle that emits, in world space. The normal is on the side that shines when the light is one-sided.
struct LightTriangle {
    Point3f p0;
    Vec3f e1, e2;
    Normal3f n;
    float area = 0;
    float error = 0; // as SurfacePoint::error
};

class LightTables {
  public:
    explicit LightTables(const Scene& scene, const EnvironmentSettings& settings = {});

    bool empty() const { return !by_power_.has_value(); }
    // Lights are chosen in proportion to the power that they send into the scene, estimated in the mean over
    // the visible wavelengths.
    const AliasTable& by_power() const { return *by_power_; }
    float probability(Index light) const { return by_power_->probability(light); }
    // Of a light on a mesh.
    const LightTriangle& triangle(Index light) const { return triangles_[triangle_of_light_[light]]; }
    // Radiance of an environment map at a place of its grid, before Light::scale.
    SampledSpectrum map_radiance(const Scene& scene, const ImageInfiniteLight& light,
                                 const EnvironmentGrid& grid, Vec2f place,
                                 const SampledWavelengths& lambda) const;
    // Of an infinite light with a map, and no portal.
    const EnvironmentSampler& environment(Index light) const {
        return environments_[environment_of_light_[light]];
    }
    // Of an infinite light with both.
    const PortalSampler& portal(Index light) const { return portals_[environment_of_light_[light]]; }
    // Of all maps without portals and of skies, each layout of a map once.
    const std::vector<EnvironmentSampler>& environments() const { return environments_; }
    const std::vector<PortalSampler>& portals() const { return portals_; }
    const std::vector<Index>& infinite_lights() const { return infinite_lights_; }
    // Of lights that are whole ones without holes.
    const std::optional<WorldSphere>& sphere(Index light) const { return spheres_[light]; }
    const std::optional<WorldDisk>& disk(Index light) const { return disks_[light]; }
    const Bounds3& scene_bounds() const { return bounds_; }

  private:
    // Without the white illuminant, at index y * width + x.
    SampledSpectrum texel_factor(const Scene& scene, const ImageInfiniteLight& light, std::size_t texel,
                                 const SampledWavelengths& lambda) const;

    EnvironmentLookup lookup_;
    std::optional<AliasTable> by_power_;
    std::vector<LightTriangle> triangles_;
    std::vector<Index> triangle_of_light_;
    std::vector<std::optional<WorldSphere>> spheres_;
    std::vector<std::optional<WorldDisk>> disks_;
    std::vector<EnvironmentSampler> environments_;
    std::vector<PortalSampler> portals_;
    std::vector<Index> environment_of_light_; // into one of the two
    // Spectra of the texels of each environment, ready to be evaluated; empty for maps that are too large.
    std::vector<std::vector<RgbUnboundedSpectrum>> map_spectra_;
    std::vector<Index> infinite_lights_;
    Bounds3 bounds_;
};

// Of everything in the world, instances included.
Bounds3 bounds_of(const Scene& scene);

} // namespace montelux
