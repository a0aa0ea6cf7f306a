// The values of shapes, objects and instances.
#pragma once

#include "montelux/scene/digest/hash_textures.h"
#include "montelux/scene/digest/scene_hasher.h"
#include "montelux/scene/scene.h"

namespace montelux {

inline void hash_values(SceneHasher& h, const TriangleMesh& m) {
    const auto& [positions, normals, uvs, indices, tangents, end_positions, end_normals, colors, opacities,
                 second_uvs] = m;
    h.all(positions, normals, uvs, indices);
    if (!tangents.empty()) h.all(tangents);
    if (m.deforms()) h.all(end_positions, end_normals);
    if (!colors.empty())
        h.all(std::uint8_t{1},
              colors); // the first number keeps them distinct from other values in this place
    if (!opacities.empty()) h.all(std::uint8_t{2}, opacities);
    if (!second_uvs.empty()) h.all(std::uint8_t{3}, second_uvs);
}
inline void hash_values(SceneHasher& h, const Sphere& s) {
    const auto& [radius, z_min, z_max, phi_max, world_from_object] = s;
    h.all(radius, z_min, z_max, phi_max, world_from_object);
}
inline void hash_values(SceneHasher& h, const Disk& d) {
    const auto& [height, radius, inner_radius, phi_max, polar, world_from_object] = d;
    h.all(height, radius, inner_radius, phi_max, world_from_object);
    if (polar) h.all(polar);
}
inline void hash_values(SceneHasher& h, const Cylinder& c) {
    const auto& [radius, z_min, z_max, phi_max, world_from_object] = c;
    h.all(radius, z_min, z_max, phi_max, world_from_object);
}
inline void hash_values(SceneHasher& h, const MeshIndex& i) {
    const auto& [index] = i;
    h.all(index);
}
inline void hash_values(SceneHasher& h, const Curves& c) {
    const auto& [kind, control_points, widths, normals] = c;
    h.all(kind, control_points, widths, normals);
}
inline void hash_values(SceneHasher& h, const BilinearMesh& m) {
    const auto& [positions, normals, uvs, indices] = m;
    h.all(positions, normals, uvs, indices);
}
inline void hash_values(SceneHasher& h, const BilinearMeshIndex& i) {
    const auto& [index] = i;
    h.all(index);
}
inline void hash_values(SceneHasher& h, const CurvesIndex& i) {
    const auto& [index] = i;
    h.all(index);
}
inline void hash_values(SceneHasher& h, const QuadricIndex& i) {
    const auto& [index] = i;
    h.all(index);
}
inline void hash_values(SceneHasher& h, const Shape& s) {
    const auto& [geometry, material, light, alpha, flip_normal, media] = s;
    static_cast<void>(media); // add_media
    h.all(geometry, material, light, alpha, flip_normal);
}
inline void hash_values(SceneHasher& h, const ObjectDefinition& o) {
    const auto& [shapes, name, part_of, shines] = o;
    static_cast<void>(name); // the mean does not depend on names
    static_cast<void>(part_of);
    static_cast<void>(shines); // add_emitters
    h.all(shapes);
}
inline void hash_values(SceneHasher& h, const Instance& i) {
    const auto& [object, world_from_object, motion] = i;
    h.all(object, world_from_object, motion);
}
inline void hash_values(SceneHasher& h, const Motion& m) {
    h.all(m.start(), m.end());
    // Two keys are the ends. Others depend on how finely paths are followed.
    if (m.is_product() || m.keys().size() > 2) h.all(m.keys());
}

} // namespace montelux
