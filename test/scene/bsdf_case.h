// BsdfCase: a BSDF to test, and directions for it.
#pragma once

#include <cmath>
#include <functional>
#include <string>

#include "montelux/mc/math/constants.h"
#include "montelux/scene/bsdf/bsdf.h"

namespace montelux::testing {

inline Vec3f direction(double theta_degrees, double phi_degrees = 0) {
    double t = theta_degrees * pi / 180, p = phi_degrees * pi / 180;
    return {static_cast<float>(std::sin(t) * std::cos(p)), static_cast<float>(std::sin(t) * std::sin(p)),
            static_cast<float>(std::cos(t))};
}

struct BsdfCase {
    std::string name;
    std::function<Bsdf()> make; // called within the test: coating tables take a second under sanitizers
    bool exact_pdf = true;      // the reported pdf is the sampled density
    bool reciprocal = true;
    bool black_below = false;
};

} // namespace montelux::testing
