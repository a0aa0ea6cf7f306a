// Tables that lights are sampled by: environment maps, spheres and discs, the bounds of the scene.
#pragma once

#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "montelux/scene/light/environment/environment_sampler.h"
#include "montelux/scene/light/environment/portal_sampler.h"
#include "montelux/scene/scene.h"
#include "montelux/scene/shape/quadric.h"

namespace montelux {

// A triangle that emits, in world space.
struct LightTriangle {
    Point3f p0;
    Vec3f e1, e2;
    Normal3f n; // as SurfacePoint::ng, but where vertex normals turn it
    float area = 0;
    float error = 0; // as SurfacePoint::error
};

class LightTables {
  public:
    explicit LightTables(const Scene& scene, const EnvironmentSettings& settings = {});

    // Of every environment map.
    static const RgbColorSpace& map_color_space() { return RgbColorSpace::srgb(); }
    // Of a light on a mesh in the world.
    const LightTriangle& triangle(Index light, Index primitive) const {
        return triangles_[first_triangle_[light] + primitive];
    }
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
    // Whether a shape stands in the world itself, where it may emit.
    bool is_in_world(Index shape) const { return in_world_[shape] != 0; }

  private:
    void add_shape(const Scene& scene, Index light, const AreaLight& area);
    void add_triangles(const Scene& scene);
    void add_map(const Scene& scene, Index light, const ImageInfiniteLight& infinite,
                 const EnvironmentSettings& settings);
    void add_environment(const Scene& scene, Index light, Index map, EnvironmentLayout layout,
                         const EnvironmentSettings& settings);
    // Without the white illuminant, at index y * width + x.
    SampledSpectrum texel_factor(const Scene& scene, const ImageInfiniteLight& light, std::size_t texel,
                                 const SampledWavelengths& lambda) const;

    EnvironmentLookup lookup_;
    std::vector<LightTriangle> triangles_;
    std::vector<std::size_t> first_triangle_; // of each light, and the number of all
    std::vector<std::optional<WorldSphere>> spheres_;
    std::vector<std::optional<WorldDisk>> disks_;
    std::vector<EnvironmentSampler> environments_;
    std::vector<PortalSampler> portals_;
    std::vector<Index> environment_of_light_; // into one of the two
    std::map<std::pair<Index, EnvironmentLayout>, Index> known_environments_;
    // Spectra of the texels of each environment, ready to be evaluated; empty for maps that are too large.
    std::vector<std::vector<RgbUnboundedSpectrum>> map_spectra_;
    std::vector<Index> infinite_lights_;
    std::vector<char> in_world_;
    Bounds3 bounds_;
};

// Of everything in the world, instances included.
Bounds3 bounds_of(const Scene& scene);

} // namespace montelux
