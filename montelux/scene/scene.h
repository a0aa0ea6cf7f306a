// Scene: plain values in flat arrays, immutable once built.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "montelux/image/image.h"
#include "montelux/scene/bsdf/measured_brdf.h"
#include "montelux/scene/camera/camera_settings.h"
#include "montelux/scene/light/light.h"
#include "montelux/scene/light/sky/sky_model.h"
#include "montelux/scene/material/material.h"
#include "montelux/scene/medium/medium.h"
#include "montelux/scene/scene_spectrum.h"
#include "montelux/scene/shape/motion.h"
#include "montelux/scene/shape/shape.h"
#include "montelux/scene/texture/texture.h"

namespace montelux {

// A group of shapes in its own space, placed by instances.
struct ObjectDefinition {
    std::vector<Index> shapes;
    std::string name{}; // may be empty
    // The object that these shapes belong to, which move in its space: each use of it has an instance of both.
    Index part_of = no_index;
    // Its shapes emit light where it has exactly one instance: it was made for a shape that moves. Others are dark.
    bool shines = false;
};
struct Instance {
    Index object = no_index;
    Transform world_from_object; // of a moving instance: at time 0
    Index motion = no_index;     // into Scene::motions; no_index: it does not move
};

struct Scene {
    std::vector<TriangleMesh> meshes;
    std::vector<Quadric> quadrics;
    std::vector<Curves> curves;
    std::vector<BilinearMesh> bilinear_meshes;
    std::vector<Shape> shapes;
    std::vector<Index> world_shapes; // shapes directly in the world
    std::vector<ObjectDefinition> objects;
    std::vector<Instance> instances;
    std::vector<Motion> motions; // of instances and lights

    std::vector<Spectrum> spectra; // of materials, textures, lights, media; their order has no meaning
    std::vector<Material> materials;
    std::vector<FloatTexture> float_textures;
    std::vector<SpectrumTexture> spectrum_textures;
    std::vector<ImageTexture> normal_maps; // R, G, B = (n / factor + 1) / 2, without scale or invert
    std::vector<Image> images;             // of image textures and normal maps
    std::vector<Image> environments;       // maps and pictures of lights, R, G, B linear
    std::vector<SkyModel> skies;
    std::vector<MeasuredBrdf> measured_brdfs;

    std::vector<Light> lights;
    CameraSettings camera;

    // Names for the layers of a picture (scene_names.h, light_groups.h): one per shape, material and light, empty
    // where there is none. They may end early.
    std::vector<std::string> shape_names, material_names, light_groups;

    std::vector<Medium> media;
    std::vector<ScalarGrid> scalar_grids; // of media
    std::vector<ColorGrid> color_grids;   // of media
    std::vector<SparseGrid> sparse_grids; // of media

    // Where SceneBuilder puts large images of textures; null: they stay in memory.
    std::shared_ptr<TexelFile> texel_file;
};

// Whether anything depends on time.
inline bool moves(const Scene& scene) {
    return !scene.motions.empty() || scene.camera.motion.has_value() ||
           std::ranges::any_of(scene.meshes, &TriangleMesh::deforms);
}

inline SceneSpectrum add_spectrum(Scene& scene, Spectrum spectrum) {
    return add_spectrum(scene.spectra, std::move(spectrum));
}

} // namespace montelux
