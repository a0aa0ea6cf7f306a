// LightTables: the tables for sampling the lights of a scene, computed once.
#pragma once

#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "montelux/scene/light/light_tables_view.h"
#include "montelux/scene/scene.h"

namespace montelux {

class LightTables {
  public:
    explicit LightTables(const Scene& scene, const EnvironmentSettings& settings = {});

    // The scene and this object outlive it.
    LightTablesView view(const Scene& scene) const;
    // Memory of the tables.
    std::size_t bytes() const;

  private:
    void find_emitters(const Scene& scene);
    void add_shape(const Scene& scene, Index light, const AreaLight& area);
    void add_triangles(const Scene& scene);
    void add_spectra(const Scene& scene, Index map);
    void add_map(const Scene& scene, Index light, const ImageInfiniteLight& infinite,
                 const EnvironmentSettings& settings);
    void add_environment(const Scene& scene, Index light, Index map, EnvironmentLayout layout,
                         const EnvironmentSettings& settings);

    // Described in LightTablesView.
    EnvironmentLookup lookup_;
    std::vector<LightTriangle> triangles_;
    std::vector<std::size_t> first_triangle_;
    std::vector<float> patch_areas_;
    std::vector<std::size_t> first_patch_;
    std::vector<std::optional<WorldSphere>> spheres_;
    std::vector<std::optional<WorldDisk>> disks_;
    std::vector<EnvironmentSampler> environments_;
    std::vector<PortalSampler> portals_;
    std::vector<ProjectionTable> projections_;
    std::vector<Index> environment_of_light_;
    std::map<std::pair<Index, EnvironmentLayout>, Index> known_environments_;
    std::vector<std::vector<ScaledPolynomial>> map_spectra_;
    std::vector<Index> infinite_lights_;
    std::vector<Index> instance_of_light_;
    std::vector<char> emits_;
    std::vector<char> plain_triangles_;
    Bounds3 bounds_;
};

// Bounds of all shapes in the world, instances included.
Bounds3 bounds_of(const Scene& scene);

} // namespace montelux
