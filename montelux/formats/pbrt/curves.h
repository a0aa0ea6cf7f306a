// The shape 'curve' of a pbrt scene file.
#pragma once

#include "montelux/formats/pbrt/parameter_reader.h"
#include "montelux/mc/math/transform.h"
#include "montelux/scene/shape/curves.h"

namespace montelux::pbrt {

// In world space.
Curves read_curves(ParameterReader& r, const Transform& world_from_object);

// Both are of one kind.
void append(Curves& curves, const Curves& more);

} // namespace montelux::pbrt
