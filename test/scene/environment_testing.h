// Small environment maps for the tests of sampling and interpolation.
#pragma once

#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "montelux/image/image.h"
#include "montelux/mc/math/vec.h"
#include "montelux/scene/light/environment/environment_grid.h"
#include "montelux/scene/light/environment/environment_sampler.h"
#include "montelux/scene/light/environment/environment_settings.h"

namespace montelux {

inline constexpr EnvironmentSampling environment_kinds[] = {
    EnvironmentSampling::tabulated, EnvironmentSampling::median_cut, EnvironmentSampling::structured};
inline constexpr EnvironmentLayout environment_layouts[] = {EnvironmentLayout::equal_area,
                                                            EnvironmentLayout::equirectangular};

// value(x, y) times `color`, whose mean of R, G and B is 1.
Image map_of(int width, int height, const auto& value, Vec3f color = {0.5f, 2, 0.5f}) {
    Image map(width, height, {"R", "G", "B"});
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < 3; ++c) map.set(x, y, c, static_cast<float>(value(x, y)) * color[c]);
    return map;
}

struct MapCase {
    std::string name;
    Image map;
};

// f(map, sampler) for every density on each map in both layouts, with and without compensation.
void for_each_sampler(const std::vector<MapCase>& cases, EnvironmentLookup lookup, const auto& f) {
    for (const MapCase& c : cases)
        for (EnvironmentLayout layout : environment_layouts)
            for (EnvironmentSampling kind : environment_kinds)
                for (bool compensated : {false, true}) {
                    EnvironmentSampler sampler(c.map, layout, {kind, compensated, lookup});
                    SCOPED_TRACE(c.name + ", " + sampler.description());
                    f(c.map, sampler);
                }
}

} // namespace montelux
