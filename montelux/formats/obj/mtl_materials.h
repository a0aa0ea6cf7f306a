// MtlMaterials: materials of MTL files as materials of a scene, with the pictures they refer to.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "montelux/formats/file_source.h"
#include "montelux/formats/obj/mtl.h"
#include "montelux/scene/build/scene_builder.h"
#include "montelux/scene/material/principled_material.h"

namespace montelux {

// What the shapes of a material have beside it.
struct MtlSurface {
    Index material = no_index;
    FloatParameter alpha{1};
    std::optional<Emission> emission{};
    bool is_clay = false; // of no MTL file
};

// Physically based materials (Pr, Pm, Pc, Ps, aniso and their maps) are Principled ones. Models of Phong's time are
// mapped by what they meant to show:
//   glass (illum 4, 6, 7 or 9 with d < 1, or with black Kd; physically based or not): Dielectric;
//   a mirror (black Kd, Ks, illum 3 or 5): Conductor;
//   gloss (Ks with Ns from 5 on, unless illum is 0 or 1): CoatedDiffuse;
//   all others: Diffuse.
// The GGX roughness alpha is Pr^2, or sqrt(2 / (Ns + 2)) (Walter et al. 2007, "Microfacet Models for Refraction through
// Rough Surfaces", for equal lobes).
class MtlMaterials {
  public:
    // Names of pictures are relative to `folder`. All must outlive it.
    MtlMaterials(std::filesystem::path folder, FileSource& files, SceneBuilder& builder,
                 BuildMessages& messages, std::vector<std::filesystem::path>* files_read)
        : folder_(std::move(folder)), files_(files), builder_(builder), messages_(messages),
          files_read_(files_read) {}

    // `file`: of the MTL file, for messages. `size`: of the model; bumps of height 1 are a hundredth of it.
    MtlSurface add(const MtlMaterial& material, std::uint32_t file, double size);
    // The file of that name, in the folder or below. A path that leads elsewhere is looked for by its last part: many
    // exporters write those of their own machine. Empty: there is none.
    std::optional<std::filesystem::path> find(std::string name) const;

  private:
    // The picture as an index into Scene::images; empty, with a warning, where it cannot be read.
    std::optional<Index> image(const MtlMap& map, bool is_color, std::uint32_t file);
    ImageTexture texture(const MtlMap& map, Index image) const;
    SpectrumParameter color(Vec3f rgb);
    SpectrumParameter diffuse_color(const MtlMaterial& m, std::uint32_t file);
    FloatParameter alpha(const MtlMaterial& m, std::uint32_t file);
    // A picture alone, or the number.
    FloatParameter number(const MtlMap& map, float otherwise, std::uint32_t file);
    PrincipledMaterial principled(const MtlMaterial& m, float ior, std::uint32_t file);
    SurfaceDetail detail(const MtlMaterial& m, std::uint32_t file, double size);

    std::filesystem::path folder_;
    FileSource& files_;
    SceneBuilder& builder_;
    BuildMessages& messages_;
    std::vector<std::filesystem::path>* files_read_;
    std::map<std::pair<std::string, bool>, std::optional<Index>> images_;
};

} // namespace montelux
