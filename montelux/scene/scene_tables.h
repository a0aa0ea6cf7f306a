// What is computed once from an immutable scene: image pyramids, coating tables, light sampling.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "montelux/scene/bsdf/coating.h"
#include "montelux/scene/light/light_tables.h"
#include "montelux/scene/light/sampler/light_sampler.h"
#include "montelux/scene/scene.h"
#include "montelux/scene/texture/mipmap.h"

namespace montelux {

// How lights are chosen (scene/light/sampler).
enum class LightSampling : std::uint8_t { uniform, power };

class SceneTables {
  public:
    // Pyramids of images that no texture filters are built all the same; independent parts are built in
    // parallel.
    explicit SceneTables(const Scene& scene, const EnvironmentSettings& environments = {},
                         LightSampling light_sampling = LightSampling::power);

    // Of the alpha of images that a float texture takes it from.
    const MipMap& mipmap(Index image, ImageChannels channels = ImageChannels::color) const {
        return channels == ImageChannels::color ? mipmaps_[image] : *alpha_mipmaps_[image];
    }
    // Null where the closed form of CoatingTable does not hold and the random walk is used.
    const CoatingTable* coating(Index material) const { return coating_of_material_[material]; }
    // The parameters of a material that look up textures want coordinates and footprints.
    bool is_textured(Index material) const { return textured_[material] != 0; }
    // The BSDF's lobes depend on the direction of the tangents.
    bool is_anisotropic(Index material) const { return anisotropic_[material] != 0; }
    const LightTables& lights() const { return lights_; }
    const LightSampler& light_sampler() const { return light_sampler_; }

  private:
    std::vector<MipMap> mipmaps_;
    std::vector<std::optional<MipMap>> alpha_mipmaps_;
    std::vector<std::unique_ptr<CoatingTable>> coatings_;
    std::vector<const CoatingTable*> coating_of_material_;
    std::vector<char> textured_, anisotropic_;
    LightTables lights_;
    LightSampler light_sampler_;
};

} // namespace montelux
