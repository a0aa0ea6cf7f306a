// AreaLight: a shape that emits: all primitives of a mesh, or a quadric.
#pragma once

#include "montelux/scene/light/light_model.h"
#include "montelux/scene/light/picture_lookup.h"
#include "montelux/scene/scene_spectrum.h"

namespace montelux {

// Radiance scale * spectrum, W/(m^2 sr nm), from the front (or both sides) of a shape; the front is where
// SurfacePoint::ng points. The parts are the triangles or patches of a mesh. A shape with holes emits only from the
// points that are present (Shape::alpha); one with alpha 0 everywhere emits fully and is invisible, as in
// pbrt-v4. Shapes inside objects emit where ObjectDefinition::shines.
struct AreaLight {
    static constexpr LightKind kind = LightKind::surface;
    static constexpr std::string_view name = "area light";

    SceneSpectrum spectrum;
    float scale = 1;
    bool two_sided = false;
    Index shape = no_index;
    // If positive, each primitive of a mesh emits this flux times scale * spectrum, whatever its area at the time.
    float primitive_flux = 0;
    // If given, into Scene::environments: the colours of this picture instead of the spectrum, by the surface's
    // texture coordinates (the top row at v = 1). A given flux is then that of a white picture.
    Index picture = no_index;
    PictureLookup picture_lookup = PictureLookup::bilinear;
    // White of the picture is the constant spectrum 1 instead of the white illuminant.
    bool equal_energy = false;

    // The shape deforms, or is in an instance, which may move.
    bool moves(const LightContext& context) const;

    MONTELUX_LIGHT_MODEL;
};
static_assert(LightModel<AreaLight>);

} // namespace montelux
