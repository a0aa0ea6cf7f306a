// LightTablesView: the tables for sampling lights, as spans over the arrays of LightTables.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "montelux/scene/light/environment/environment_sampler.h"
#include "montelux/scene/light/environment/portal_sampler.h"
#include "montelux/scene/light/image_infinite_light.h"
#include "montelux/scene/light/picture_lookup.h"
#include "montelux/scene/light/projection_table.h"
#include "montelux/scene/shape/quadric.h"

namespace montelux {

// A triangle that emits, in the space of its shape: the world, or that of its instance.
struct LightTriangle {
    Point3f p0;
    Vec3f e1, e2;
    Normal3f n; // as SurfacePoint::ng, but where vertex normals turn it
    float area = 0;
    float error = 0; // as SurfacePoint::error
};

struct LightTablesView {
    EnvironmentLookup lookup{};
    std::span<const LightTriangle> triangles;    // none of meshes that deform
    std::span<const std::size_t> first_triangle; // of each light; at the end the total
    std::span<const float> patch_areas;          // of each light on bilinear patches, one after the other
    std::span<const std::size_t> first_patch;    // of each light; at the end the total
    std::span<const std::optional<WorldSphere>> spheres;
    std::span<const std::optional<WorldDisk>> disks;
    std::span<const Image> maps; // Scene::environments
    // Samplers of all skies and maps without portals, one per map and layout; then those of maps with portals.
    std::span<const EnvironmentSampler> environments;
    std::span<const PortalSampler> portals;
    std::span<const ProjectionTable> projections;
    std::span<const Index> environment_of_light; // into `environments`, `portals` or `projections`
    // Spectra of the texels of each map; empty for maps that are too large.
    std::span<const std::vector<ScaledPolynomial>> map_spectra;
    std::span<const Index> infinite_lights;
    // Of each light of a shape in an object that shines: its one instance; no_index for others.
    std::span<const Index> instance_of_light;
    std::span<const char> emits; // one per shape: 0 or 1
    // One per light: 1 for still triangles of one radiance and without holes, whose normals no vertex normal turns.
    std::span<const char> plain_triangles;
    Bounds3 scene_bounds;

    // The colour space of all environment maps.
    static const RgbColorSpace& map_color_space() { return RgbColorSpace::srgb(); }
    static ScaledPolynomial texel_spectrum(const Image& map, std::size_t texel);
    // For a light on a mesh that emits.
    const LightTriangle& triangle(Index light, Index primitive) const {
        return triangles[first_triangle[light] + primitive];
    }
    // Whether the mesh of a light deforms, for a light on a mesh that emits.
    bool deforms(Index light) const { return first_triangle[light] == first_triangle[light + 1]; }
    bool has_plain_triangles(Index light) const { return plain_triangles[light] != 0; }
    // Area of a triangle or a patch in the space of its shape, for a light on such a mesh that emits.
    float area(Index light, Index primitive) const {
        const std::size_t patch = first_patch[light] + primitive;
        return patch < first_patch[light + 1] ? patch_areas[patch] : triangle(light, primitive).area;
    }
    // Radiance of an environment map at a position on its grid, before Light::scale.
    SampledSpectrum map_radiance(const ImageInfiniteLight& light, const EnvironmentGrid& grid, Vec2f place,
                                 const SampledWavelengths& lambda) const;
    // The first channel of a map at a position on its grid.
    float map_value(Index map, const EnvironmentGrid& grid, Vec2f place) const;
    // The colour of a picture at texture coordinates, which are clamped to [0, 1], with the top row at v = 1.
    SampledSpectrum picture_color(Index map, Point2f uv, PictureLookup by,
                                  const SampledWavelengths& lambda) const;
    // The white of a picture: the constant spectrum 1, or the illuminant.
    static SampledSpectrum white_of_picture(bool equal_energy, const SampledWavelengths& lambda) {
        return equal_energy ? SampledSpectrum(1) : map_color_space().illuminant().sample(lambda);
    }
    // The colour of a texel under the white illuminant.
    SampledSpectrum texel_radiance(Index map, std::size_t texel, const SampledWavelengths& lambda) const {
        return texel_factor(map, texel, lambda) * map_color_space().illuminant().sample(lambda);
    }
    // For an infinite light with a map and no portal, and goniometric lights.
    const EnvironmentSampler& environment(Index light) const {
        return environments[environment_of_light[light]];
    }
    // For an infinite light with a map and a portal.
    const PortalSampler& portal(Index light) const { return portals[environment_of_light[light]]; }
    const ProjectionTable& projection(Index light) const { return projections[environment_of_light[light]]; }
    // For lights that are whole spheres or discs without holes, in the space of the shape.
    const std::optional<WorldSphere>& sphere(Index light) const { return spheres[light]; }
    const std::optional<WorldDisk>& disk(Index light) const { return disks[light]; }
    // Whether a shape with a light emits: it is directly in the world, or in an object that shines
    // (ObjectDefinition::shines).
    bool may_emit(Index shape) const { return emits[shape] != 0; }
    Index instance(Index light) const { return instance_of_light[light]; }

  private:
    // Without the white illuminant, at index y * width + x.
    SampledSpectrum texel_factor(Index map, std::size_t texel, const SampledWavelengths& lambda) const;
};

} // namespace montelux
