// LayerSampler: the numbers that a sample gives to the optional layers of the film.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "montelux/film/film_layers.h"
#include "montelux/scene/camera/camera.h"
#include "montelux/scene/light/light_groups.h"
#include "montelux/scene/render_settings.h"
#include "montelux/scene/shape/surface_point.h"
#include "montelux/scene/view.h"
#include "montelux/transport/sample_extras.h"

namespace montelux {

class LayerSampler {
  public:
    // All arguments must outlive it. Throws Error as light_groups() does.
    LayerSampler(const SceneDescription& description, const SceneView& scene, const Camera& camera);
    LayerSampler(const LayerSampler&) = delete;
    LayerSampler& operator=(const LayerSampler&) = delete;

    const FilmLayers& layers() const { return layers_; }
    // Whether samples need SampleExtras.
    bool wants_extras() const { return layers_.values() > 0; }
    // For a path that begins; `parts` has FilmLayers::parts() elements.
    SampleExtras extras(std::span<SampledSpectrum> parts) const { return {.split = &split_, .parts = parts}; }
    // All of a sample's numbers but the parts of the radiance. `film` and `lens` belong to its camera ray.
    void sample(const SampleExtras& extras, Point2f film, Vec2f lens, float filter_weight,
                std::span<float> values) const;

  private:
    Vec2d depth_slopes(const SurfacePoint& s, Point2f film, Vec2f lens, float time) const;
    Vec2d motion(const SampleExtras& extras, Vec3d p) const;

    const SceneView& scene_;
    const Camera& camera_;
    FilmLayers layers_;
    bool in_camera_space_;
    LightGroups groups_;
    RadianceSplit split_;
    std::vector<std::uint32_t> shape_ids_, instance_ids_, material_ids_; // where they are wanted
};

// The ids of Layer::shape and Layer::material with their names.
std::map<std::uint32_t, std::string> shape_id_names(const Scene& scene);
std::map<std::uint32_t, std::string> material_id_names(const Scene& scene);

} // namespace montelux
