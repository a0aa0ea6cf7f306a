#include "montelux/scene/light/sky/sky_map.h"

#include <algorithm>
#include <cmath>

#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/scene/light/environment/environment_grid.h"
#include "montelux/spectrum/rgb_colorspace.h"

namespace montelux {

namespace {

// Rows in parallel.
template <typename F>
void for_each_texel(const EnvironmentGrid& grid, const F& f) {
    parallel_for(grid.height(), [&](std::int64_t y) {
        for (int x = 0; x < grid.width(); ++x) f(x, static_cast<int>(y));
    });
}

Vec3f direction(const EnvironmentGrid& grid, int x, int y, float u, float v) {
    return grid.direction({static_cast<float>(x) + u, static_cast<float>(y) + v});
}

// Evenly spread points of the disc add their share to the texels that contain them.
void add_sun(Image& picture, const EnvironmentGrid& grid, const SkyModel& sky) {
    const SunDisc disc = SunDisc::of_radius(sky.sun_direction(), sun_angular_radius);
    constexpr int per_side = 512;
    std::vector<std::size_t> hits;
    for (int i = 0; i < per_side; ++i)
        for (int j = 0; j < per_side; ++j) {
            const Vec3f w = disc.sample(
                {(static_cast<float>(i) + 0.5f) / per_side, (static_cast<float>(j) + 0.5f) / per_side});
            if (w.z >= 0) hits.push_back(grid.texel(grid.locate(w)));
        }
    const Vec3d xyz = luminous_efficacy * cie_y_integral *
                      integrate_xyz([&](float lambda) { return sky.sun_radiance()(lambda); });
    const Vec3d rgb = RgbColorSpace::srgb().rgb_from_xyz() * xyz;
    const double each = disc.solid_angle() / (per_side * per_side);
    for (const std::size_t texel : hits) {
        const auto columns = static_cast<std::size_t>(grid.width());
        const double share = each / grid.solid_angle(static_cast<int>(texel / columns));
        for (int c = 0; c < 3; ++c)
            picture.f32()[texel * 3 + static_cast<std::size_t>(c)] +=
                static_cast<float>(share * std::max(0.0, rgb[c]));
    }
}

} // namespace

Image sky_density_map(const SkyModel& sky, int height) {
    const EnvironmentGrid grid(EnvironmentLayout::equirectangular, 2 * height, height);
    Image map(2 * height, height, {"R", "G", "B"});
    for_each_texel(grid, [&](int x, int y) {
        const auto mean = static_cast<float>(sky.mean_radiance(direction(grid, x, y, 0.5f, 0.5f)));
        for (int c = 0; c < 3; ++c) map.set(x, y, c, mean);
    });
    return map;
}

Image sky_picture(const SkyModel& sky, int height, bool with_sun) {
    const EnvironmentGrid grid(EnvironmentLayout::equirectangular, 2 * height, height);
    Image picture(2 * height, height, {"R", "G", "B"});
    for_each_texel(grid, [&](int x, int y) {
        // Gauss's rule of four points.
        Vec3d xyz;
        for (const float u : {0.2113249f, 0.7886751f})
            for (const float v : {0.2113249f, 0.7886751f})
                xyz += sky.tristimulus(direction(grid, x, y, u, v));
        const Vec3d rgb = RgbColorSpace::srgb().rgb_from_xyz() * (luminous_efficacy / 4 * xyz);
        for (int c = 0; c < 3; ++c) picture.set(x, y, c, static_cast<float>(std::max(0.0, rgb[c])));
    });
    if (with_sun) add_sun(picture, grid, sky);
    return picture;
}

} // namespace montelux
