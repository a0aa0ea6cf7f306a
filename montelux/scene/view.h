// SceneView: everything that a path reads of a scene and its tables, in spans and indices.
#pragma once

#include <algorithm>
#include <span>
#include <type_traits>

#include "montelux/scene/bsdf/coating.h"
#include "montelux/scene/bsdf/plastic.h"
#include "montelux/scene/light/light_tables_view.h"
#include "montelux/scene/light/sampler/light_sampler.h"
#include "montelux/scene/scene.h"
#include "montelux/scene/texture/mipmap.h"

namespace montelux {

// The scene argument of all path tracing code. Trivially copyable; scene and tables must outlive it
// unchanged. SceneTables::view() returns a complete one.
struct SceneView {
    std::span<const TriangleMesh> meshes;
    std::span<const Quadric> quadrics;
    std::span<const Curves> curves;
    std::span<const BilinearMesh> bilinear_meshes;
    std::span<const Shape> shapes;
    std::span<const Index> world_shapes;
    std::span<const ObjectDefinition> objects;
    std::span<const Instance> instances;
    std::span<const Motion> motions;

    std::span<const Spectrum> spectra;
    std::span<const Material> materials;
    std::span<const char> textured, follows_tangents; // one per material: 0 or 1
    std::span<const Index> coating_of_material;       // into one of the following; no_index: none
    std::span<const CoatingTable> coating_tables;     // of coated ones, where the closed form holds
    std::span<const PlasticTable> plastic_tables;     // of PlasticMaterial
    std::span<const FloatTexture> float_textures;
    std::span<const SpectrumTexture> spectrum_textures;
    std::span<const ImageTexture> normal_maps;
    std::span<const MeasuredBrdf> measured_brdfs;
    std::span<const MipMap> mipmaps;              // one per image, of its colours
    std::span<const Index> alpha_mipmap_of_image; // into alpha_mipmaps, or no_index
    std::span<const MipMap> alpha_mipmaps;

    std::span<const Light> lights;
    std::span<const SkyModel> skies;
    LightTablesView light_tables;

    std::span<const Medium> media;
    std::span<const MediumTable> medium_tables; // one per medium
    std::span<const ScalarGrid> scalar_grids;
    std::span<const ColorGrid> color_grids;
    std::span<const SparseGrid> sparse_grids;
    Index camera_medium = no_index;

    const LightSampler* light_sampler = nullptr;
    // Parts of lights that have a position, for rays through media; null without media or without such lights.
    const PowerLightSampler* segment_lights = nullptr;
    // Parts of all lights, for paths that start there; null unless the integrator traces such (traces_light).
    const PowerLightSampler* emitting_lights = nullptr;

    // MicrofacetScattering::multiple and ShadingTerminator::soft.
    bool multiple_scattering = false, soft_terminator = false;

    SceneView() = default;
    // Without tables: enough for geometry and constant parameters.
    explicit SceneView(const Scene& scene)
        : meshes(scene.meshes), quadrics(scene.quadrics), curves(scene.curves),
          bilinear_meshes(scene.bilinear_meshes), shapes(scene.shapes), world_shapes(scene.world_shapes),
          objects(scene.objects), instances(scene.instances), motions(scene.motions), spectra(scene.spectra),
          materials(scene.materials), float_textures(scene.float_textures),
          spectrum_textures(scene.spectrum_textures), normal_maps(scene.normal_maps),
          measured_brdfs(scene.measured_brdfs), lights(scene.lights), skies(scene.skies), media(scene.media),
          scalar_grids(scene.scalar_grids), color_grids(scene.color_grids), sparse_grids(scene.sparse_grids),
          camera_medium(scene.camera.medium) {}

    SampledSpectrum sample(SceneSpectrum s, const SampledWavelengths& lambda) const {
        return s.is_constant() ? SampledSpectrum(s.constant) : spectra[s.index].sample(lambda);
    }
    // Whether paths need an integrator of volumes.
    bool has_media() const {
        return !media.empty() || std::any_of(materials.begin(), materials.end(), [](const Material& m) {
            return std::holds_alternative<InterfaceMaterial>(m);
        });
    }
    // A shape that rays pass without scattering.
    bool is_interface(Index shape) const {
        return std::holds_alternative<InterfaceMaterial>(materials[shapes[shape].material]);
    }
    // The light that a ray meets where it hits a surface, or no_index.
    Index light_at(const Hit& hit) const {
        const Index light = shapes[hit.shape].light;
        return light != no_index && light_tables.instance_of_light[light] == hit.instance ? light : no_index;
    }
    // A copy, for tables.
    Spectrum spectrum(SceneSpectrum s) const { return spectrum_of(s, spectra); }
    bool is_constant(SceneSpectrum s) const { return s.is_constant() || spectra[s.index].is_constant(); }
    // The material's parameters use textures, or its BSDF the coordinates: these and footprints are needed.
    bool is_textured(Index material) const { return textured[material] != 0; }
    // The BSDF's frame is aligned with the tangents: its lobes depend on them, or its textures need them
    // anyway.
    bool frame_follows_tangents(Index material) const { return follows_tangents[material] != 0; }
    // Null if CoatingTable's closed form does not apply.
    const CoatingTable* coating(Index material) const {
        const Index table = coating_of_material[material];
        return table == no_index ? nullptr : &coating_tables[table];
    }
    // Of a PlasticMaterial.
    const PlasticTable& plastic(Index material) const {
        return plastic_tables[coating_of_material[material]];
    }
    const MipMap& mipmap(Index image, ImageChannels channels) const {
        return channels == ImageChannels::alpha ? alpha_mipmaps[alpha_mipmap_of_image[image]]
                                                : mipmaps[image];
    }
};
static_assert(std::is_trivially_copyable_v<SceneView>);

} // namespace montelux
