// SceneTables: tables computed once from an immutable scene: image pyramids, coatings, media, light sampling.
#pragma once

#include <vector>

#include "montelux/scene/light/light_tables.h"
#include "montelux/scene/memory_use.h"
#include "montelux/scene/render_settings.h"
#include "montelux/scene/view.h"

namespace montelux {

class SceneTables {
  public:
    // Builds the pyramids of all images, even of those that no texture filters. Independent parts are built
    // in parallel.
    explicit SceneTables(const Scene& scene, const EnvironmentSettings& environments = {},
                         LightSampling light_sampling = LightSampling::tree,
                         const SurfaceSettings& surfaces = {}, bool traces_light = false);

    SceneTables(const SceneTables&) = delete;
    SceneTables& operator=(const SceneTables&) = delete;

    // The scene with its tables; both must outlive the view.
    const SceneView& view() const { return view_; }
    // Kinds of tables that the scene does not need are left out.
    std::vector<MemoryUse> memory_use() const;

  private:
    void add_mipmaps(const Scene& scene);
    void add_materials(const Scene& scene);
    void add_coatings(const Scene& scene, MicrofacetScattering microfacets);
    void add_media(const Scene& scene);

    std::vector<MipMap> mipmaps_, alpha_mipmaps_;
    std::vector<Index> alpha_mipmap_of_image_;
    std::vector<CoatingTable> coatings_;
    std::vector<PlasticTable> plastics_;
    std::vector<Index> coating_of_material_;
    std::vector<char> textured_, follows_tangents_;
    std::vector<MediumTable> media_;
    LightTables lights_;
    LightSampler light_sampler_;
    std::optional<PowerLightSampler> segment_lights_, emitting_lights_;
    SceneView view_;
};

} // namespace montelux
