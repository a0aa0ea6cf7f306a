// Shapes of a scene: meshes and quadrics from Python, their materials and lights.
#pragma once

#include "python/src/scene_slots.h"
#include <nanobind/nanobind.h>

namespace montelux::python {

using SceneRef = std::shared_ptr<SceneHolder>;

// What a mesh may have beside its triangles; each may be None.
struct MeshAttributes {
    nb::object normals, uvs, end_positions, end_normals, transform, light;
};

// Each adds a shape to the world and returns it; detached materials are added, too.
nb::object add_mesh(const SceneRef& scene, const nb::object& positions, const nb::object& triangles,
                    const nb::object& material, const MeshAttributes& attributes);
nb::object add_sphere(const SceneRef& scene, double radius, const nb::object& centre,
                      const nb::object& material, const nb::object& transform, const nb::object& emission);
nb::object add_disk(const SceneRef& scene, double radius, double inner_radius, double height,
                    const nb::object& material, const nb::object& transform, const nb::object& emission);
nb::object add_cylinder(const SceneRef& scene, double radius, double z_min, double z_max,
                        const nb::object& material, const nb::object& transform, const nb::object& emission);
nb::object add_curves(const SceneRef& scene, const nb::object& points, const nb::object& width,
                      const nb::object& material, const std::string& kind, const std::string& basis,
                      int degree, const nb::object& normals, const nb::object& transform);

// The index of a material in a scene; a detached one is added to it.
Index material_index(const SceneRef& scene, const nb::object& material, const std::string& what);
// Adding and removing lights updates the indices of the others.
void erase_light(SceneDescription& d, Index light);

} // namespace montelux::python
