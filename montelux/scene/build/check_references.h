// Checks that the indices in lights, materials and textures are those of values of the scene.
#pragma once

#include <cstddef>

#include "montelux/scene/scene.h"

namespace montelux {

// Each throws Error: "material 3 (Diffuse), reflectance: there is no spectrum texture 7; the scene has 2".

// `light` is about to be added, after `new_shapes` shapes.
void check_light(const Scene& scene, const Light& light, std::size_t new_shapes = 0);
void check_materials(const Scene& scene);
// Their grids and spectra, and that shapes and the camera lie in media of the scene.
void check_media(const Scene& scene);
// Normal maps as well. No texture may depend on itself or on more than 63 levels of others: look-ups are
// recursive.
void check_textures(const Scene& scene);

} // namespace montelux
