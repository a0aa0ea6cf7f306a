// Lights that are shapes, and the point and the wavelengths for which lights are sampled.
#pragma once

#include "montelux/scene/light/light_sampling.h"
#include "montelux/scene/scene.h"
#include "montelux/scene/shape/quadric.h"

namespace montelux::testing {

inline const SampledWavelengths wavelengths = SampledWavelengths::sample_visible(0.37f);

inline const ReferencePoint origin{{0, 0, 0}, {0, 0, 1}, 1e-6f};

inline Index add_light(Scene& scene, Shape shape, bool two_sided, float radiance = 2) {
    shape.light = static_cast<Index>(scene.lights.size());
    auto index = static_cast<Index>(scene.shapes.size());
    scene.lights.push_back(AreaLight{1.0f, radiance, two_sided, index});
    scene.shapes.push_back(shape);
    scene.world_shapes.push_back(index);
    return shape.light;
}
inline Index add_light(Scene& scene, const Quadric& quadric, bool flip = false, bool two_sided = false) {
    Shape shape;
    shape.geometry = QuadricIndex{static_cast<Index>(scene.quadrics.size())};
    shape.flip_normal = flip;
    scene.quadrics.push_back(quadric);
    return add_light(scene, shape, two_sided);
}
inline Index add_light(Scene& scene, Vec3f a, Vec3f b, Vec3f c, bool two_sided = false) {
    Shape shape;
    shape.geometry = MeshIndex{static_cast<Index>(scene.meshes.size())};
    TriangleMesh mesh;
    mesh.positions = {a, b, c};
    mesh.indices = {0, 1, 2};
    scene.meshes.push_back(mesh);
    return add_light(scene, shape, two_sided);
}

inline Index add_light(Scene& scene, const BilinearMesh& mesh, bool flip = false, bool two_sided = false) {
    Shape shape;
    shape.geometry = BilinearMeshIndex{static_cast<Index>(scene.bilinear_meshes.size())};
    shape.flip_normal = flip;
    scene.bilinear_meshes.push_back(mesh);
    return add_light(scene, shape, two_sided);
}

} // namespace montelux::testing
