// Small environment maps for the tests of baking, and the plain sums over their texels that baking is held
// against.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <gtest/gtest.h>

#include "montelux/bake/environment_map.h"
#include "montelux/mc/math/constants.h"
#include "montelux/mc/random/hash.h"

namespace montelux {

// Random texels over four decades, and a sun at one of them where `sun` is not 0.
inline Image random_map(int width, int height, float sun = 0) {
    Image image(width, height, {"R", "G", "B"});
    auto uniform = [](std::uint64_t i) { return static_cast<double>(hash_key(i, 77) >> 11) * 0x1p-53; };
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const auto i = static_cast<std::uint64_t>(y) * width + x;
            for (int c = 0; c < 3; ++c)
                image.set(x, y, c, static_cast<float>(std::pow(10, 4 * uniform(3 * i + c) - 2)));
        }
    if (sun > 0)
        for (int c = 0; c < 3; ++c) image.set(width / 3, height / 4, c, sun * static_cast<float>(3 - c));
    return image;
}

// Direction of a place of an equirectangular map in the cube's default frame: left-handed, y up, the middle
// at +z, what lies right of it at +x. Written down a second time, on purpose.
inline Vec3d equirectangular_direction(double u, double v) {
    const double angle = 2 * pi * (u - 0.5), theta = pi * v;
    return {std::sin(theta) * std::sin(angle), std::cos(theta), std::sin(theta) * std::cos(angle)};
}

// integral of radiance times weight(direction) by the midpoint rule with parts x parts points a texel.
// `total_weight`, if given, becomes the integral of the weight alone.
inline Vec3d sum_over_texels(const Image& image, int parts, const std::function<double(Vec3d)>& weight,
                             double* total_weight = nullptr) {
    Vec3d sum;
    if (total_weight) *total_weight = 0;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            double total = 0;
            for (int j = 0; j < parts; ++j)
                for (int i = 0; i < parts; ++i) {
                    const double u = (x + (i + 0.5) / parts) / image.width();
                    const double v = (y + (j + 0.5) / parts) / image.height();
                    total += weight(equirectangular_direction(u, v)) * std::sin(pi * v);
                }
            const double area =
                2 * pi * pi / (static_cast<double>(image.width()) * image.height() * parts * parts);
            if (total_weight) *total_weight += total * area;
            sum += Vec3d{image.value(x, y, 0), image.value(x, y, 1), image.value(x, y, 2)} * (total * area);
        }
    return sum;
}

} // namespace montelux
