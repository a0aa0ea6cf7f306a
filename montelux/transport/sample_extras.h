// SampleExtras: what the optional layers of a picture need of a path: its first surface, and its radiance in parts.
#pragma once

#include <span>

#include "montelux/scene/shape/ray.h"
#include "montelux/spectrum/sampled_spectrum.h"

namespace montelux {

// How radiance is split into parts; the same for all paths.
struct RadianceSplit {
    static constexpr std::size_t none = ~std::size_t{0};
    std::size_t direct = none,
                indirect = none;    // parts; light after at most one scattering event, and all other
    std::size_t first_group = none; // part of the first group of lights
    std::span<const Index> group_of_light{};
    Index group_of_media = no_index; // of light that media emit
};

// Written while a path is traced; nothing in it influences the path. Without one a path spends a comparison per
// contribution.
struct SampleExtras {
    const RadianceSplit* split = nullptr;
    std::span<SampledSpectrum> parts; // zero at first
    // The first surface that is not an interface, if nothing scattered the path before; hit.shape is no_index
    // without one.
    Ray ray{};
    Hit hit{};
    float transparency = 0; // share of the light behind the scene that the path lets through

    // A contribution of a light (no_index: of a medium) after `depth` scattering events.
    [[gnu::cold]] void add(SampledSpectrum contribution, int depth, Index light) {
        const std::size_t part = depth <= 1 ? split->direct : split->indirect;
        if (part != RadianceSplit::none) parts[part] += contribution;
        if (split->first_group == RadianceSplit::none) return;
        const Index group = light == no_index ? split->group_of_media : split->group_of_light[light];
        parts[split->first_group + group] += contribution;
    }
    [[gnu::cold]] void meet(const Ray& r, const Hit& h) {
        ray = r;
        hit = h;
    }
};

} // namespace montelux
