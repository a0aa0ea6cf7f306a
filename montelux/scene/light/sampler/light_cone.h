// LightCone: the directions in which a group of lights shines.
#pragma once

#include "montelux/scene/light/light_model.h"

namespace montelux {

// All light leaves within the angle theta_e of a normal that lies within the angle theta_o of the axis (Conty
// Estevez and Kulla 2018, section 4.1).
struct LightCone {
    Vec3f axis{0, 0, 1}; // unit
    float cos_theta_o = 1, cos_theta_e = 1;
    bool two_sided = false; // the same about -axis

    explicit LightCone(const LightBounds& bounds)
        : axis(bounds.axis), cos_theta_o(bounds.cos_theta_o), cos_theta_e(bounds.cos_theta_e),
          two_sided(bounds.two_sided) {}

    // Grows to contain the other: not the smallest cone of many, as each step rounds up.
    void add(const LightCone& other);
    // Integral over all directions of the bound on what a group of intensity 1 radiates, sr: 1 within theta_o,
    // then falling as the cosine until theta_e beyond it (equation 1 there).
    double measure() const;
};

} // namespace montelux
