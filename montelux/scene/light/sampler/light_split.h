// split_lights: how a group of lights is divided in two.
#pragma once

#include <limits>
#include <span>

#include "montelux/scene/index.h"
#include "montelux/scene/light/sampler/light_cone.h"

namespace montelux {

// A light while the tree is built, in units of the tree.
struct SplitLight {
    Vec3f lower, upper;
    LightCone cone;
    float intensity;
    Index light;

    Vec3f center() const { return 0.5f * (lower + upper); }
};

struct SplitBox {
    Vec3f lower = Vec3f(1, 1, 1) * std::numeric_limits<float>::infinity(), upper = -lower;

    void add(Vec3f l, Vec3f u) {
        lower = min(lower, l);
        upper = max(upper, u);
    }
    Vec3f center() const { return 0.5f * (lower + upper); }
};

// The first lights of the span, and the others. The costs compare groups.
struct LightSplit {
    Index first_count;
    double first_cost, second_cost;
};

// Reorders at least two lights so that the sum of the costs is small: intensity times squared diagonal times the
// measure of directions (after Conty Estevez and Kulla 2018, equation 2), over 12 bins per axis. `halve`: both
// parts get half of the lights.
LightSplit split_lights(std::span<SplitLight> lights, bool halve);

} // namespace montelux
