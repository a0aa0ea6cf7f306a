// Small environment maps for the tests of baking, and the plain sums over their texels that baking is held
// against.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <gtest/gtest.h>
#include <vector>

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

// The points of the midpoint rule with parts x parts points a texel.
class TexelPoints {
  public:
    TexelPoints(const Image& image, int parts)
        : image_(image), count_(static_cast<std::size_t>(parts) * static_cast<std::size_t>(parts)) {
        const double area =
            2 * pi * pi / (static_cast<double>(image.width()) * image.height() * parts * parts);
        for (int y = 0; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x)
                for (int j = 0; j < parts; ++j)
                    for (int i = 0; i < parts; ++i) {
                        const double u = (x + (i + 0.5) / parts) / image.width();
                        const double v = (y + (j + 0.5) / parts) / image.height();
                        points_.push_back({equirectangular_direction(u, v), std::sin(pi * v) * area});
                    }
    }

    // integral of radiance times weight(direction). `total_weight`, if given,
    // becomes the integral of the weight alone.
    Vec3d sum(const auto& weight, double* total_weight = nullptr) const {
        Vec3d sum;
        if (total_weight) *total_weight = 0;
        auto point = points_.begin();
        for (int y = 0; y < image_.height(); ++y)
            for (int x = 0; x < image_.width(); ++x) {
                double total = 0;
                for (std::size_t k = 0; k < count_; ++k, ++point)
                    total += weight(point->direction) * point->solid_angle;
                if (total_weight) *total_weight += total;
                sum += Vec3d{image_.value(x, y, 0), image_.value(x, y, 1), image_.value(x, y, 2)} * total;
            }
        return sum;
    }

  private:
    struct Point {
        Vec3d direction;
        double solid_angle;
    };
    const Image& image_;
    std::size_t count_; // in a texel
    std::vector<Point> points_;
};

} // namespace montelux
