// SidedMaterial: one material on each side of a surface.
#pragma once

#include "montelux/scene/bsdf/bsdf_list.h"
#include "montelux/scene/material/surface_detail.h"

namespace montelux {

// The front is the side of the geometric normal. What a path meets is the material of the side that it comes from
// alone: one that transmits light lets it through in either direction by its own rules. make_bsdf makes the BSDF of
// that side.
struct SidedMaterial {
    static constexpr const char* name = "Sided";
    static constexpr const char* doc = "A material for each side of a surface, or none: black.";

    MaterialOfSide front{}, back{};
    SurfaceDetail detail{}; // without effect: the materials of the sides have their own

    template <typename Self, typename Visit>
    static void visit_parameters(Self& m, Visit&& visit) {
        visit({.name = "front", .doc = "The material on the side of the geometric normal; None is black."},
              m.front);
        visit({.name = "back", .doc = "The material on the other side; None is black."}, m.back);
    }

    Index side(bool is_front) const { return (is_front ? front : back).index; }

    // For the concept: no path asks for it.
    DiffuseBsdf bsdf(const ParameterEvaluator&) const;
};

} // namespace montelux
