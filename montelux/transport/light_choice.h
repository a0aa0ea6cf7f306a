// One light chosen at random, and one point on it, for next-event estimation.
#pragma once

#include <algorithm>
#include <optional>

#include "montelux/mc/random/stream.h"
#include "montelux/scene/light/light_sampling.h"
#include "montelux/scene/material/make_bsdf.h"
#include "montelux/scene/shape/surface_point.h"

namespace montelux {

struct ChosenLight {
    Index light = no_index, part = 0;
    float choice = 0;                  // probability of choosing this part
    std::optional<LightSample> sample; // empty if it cannot illuminate the point
};

// The scene has lights. With few lights the choice uses the first number's leading digits and leaves the others
// for the point: one dimension less keeps point sets better stratified.
template <RandomStream Stream>
[[gnu::always_inline]] inline ChosenLight choose_light(const SceneView& scene, const ReferencePoint& here,
                                                       float time, const SampledWavelengths& lambda,
                                                       Stream& stream) {
    const LightSampler& lights = *scene.light_sampler;
    const bool few = lights.size() <= 64;
    Vec2f u = stream.next_2d();
    const LightChoice chosen = lights.sample(here, stream.refined(few ? u.x : stream.next_1d()));
    if (few) u.x = std::min(static_cast<float>(chosen.remapped), largest_below_one<float>);
    return {chosen.light, chosen.part, chosen.probability,
            sample_li({scene, chosen.light, time}, chosen.part, here, u, lambda)};
}

// A surface to be lit, seen from wo in the frame of its BSDF.
inline ReferencePoint reference_point(const SurfacePoint& s, const SurfaceBsdf& surface, Vec3f wo) {
    ReferencePoint here{s.p, s.ng, s.error, Vec3f{}};
    if (is_opaque(surface.bsdf)) here.facing = wo.z > 0 ? surface.frame.n : -surface.frame.n;
    return here;
}

} // namespace montelux
