#include "montelux/scene/scene_digest.h"

#include "montelux/scene/digest/hash_cameras.h"
#include "montelux/scene/digest/hash_geometry.h"
#include "montelux/scene/digest/hash_lights.h"
#include "montelux/scene/digest/hash_materials.h"
#include "montelux/scene/digest/hash_media.h"
#include "montelux/scene/digest/hash_textures.h"
#include "montelux/scene/digest/scene_hasher.h"
#include "montelux/scene/value_hash.h"

namespace montelux {
namespace {

template <typename... T>
ContentDigest digest_of_all(const Scene& scene, const T&... values) {
    SceneHasher hasher(scene.spectra);
    hasher.all(values...);
    return hasher.value();
}

// Media, and where they are; nothing is hashed for a scene without media.
void add_media(SceneHasher& hasher, const Scene& scene) {
    if (scene.media.empty()) return;
    hasher.all(scene.media, scene.scalar_grids, scene.color_grids, scene.camera.medium);
    if (!scene.sparse_grids.empty()) hasher.all(scene.sparse_grids); // else the digest is that without them
    for (std::size_t i = 0; i < scene.shapes.size(); ++i)
        if (const MediumInterface& media = scene.shapes[i].media; media.is_transition())
            hasher.all(static_cast<std::uint64_t>(i), media);
}

// Shapes in objects that shine; nothing is hashed for a scene without them.
void add_emitters(SceneHasher& hasher, const Scene& scene) {
    for (const ObjectDefinition& object : scene.objects)
        for (const Index shape : object.shapes)
            if (object.shines && scene.shapes[shape].light != no_index) hasher.all(shape);
}

} // namespace

ContentDigest SceneDigest::whole() const {
    ValueHash hash;
    for (const ContentDigest& part : {geometry, materials, textures, lights, camera}) {
        hash.add(part.high);
        hash.add(part.low);
    }
    return hash.value();
}

SceneDigest digest_of(const Scene& scene) {
    const auto& [meshes, quadrics, curves, bilinear_meshes, shapes, world_shapes, objects, instances, motions,
                 spectra, materials, float_textures, spectrum_textures, normal_maps, images, environments,
                 skies, measured_brdfs, lights, camera, shape_names, material_names, light_groups, media,
                 scalar_grids, color_grids, sparse_grids, texel_file] = scene;
    // Of layers alone; checkpoints compare them where they matter.
    static_cast<void>(shape_names);
    static_cast<void>(material_names);
    static_cast<void>(light_groups);
    static_cast<void>(texel_file); // where samples are is no part of them
    SceneHasher of_materials(spectra);
    of_materials.all(materials);
    if (!measured_brdfs.empty()) of_materials.all(measured_brdfs);
    add_media(of_materials, scene);
    SceneHasher of_geometry(spectra);
    of_geometry.all(meshes, quadrics, shapes, world_shapes, objects, instances, motions);
    if (!curves.empty()) of_geometry.all(curves);
    if (!bilinear_meshes.empty()) of_geometry.all(bilinear_meshes);
    add_emitters(of_geometry, scene);
    return {of_geometry.value(), of_materials.value(),
            digest_of_all(scene, float_textures, spectrum_textures, normal_maps, images),
            digest_of_all(scene, lights, environments, skies), digest_of_all(scene, camera)};
}

ContentDigest digest_of(const Spectrum& spectrum) {
    SceneHasher hasher;
    hasher.all(spectrum);
    return hasher.value();
}

} // namespace montelux
