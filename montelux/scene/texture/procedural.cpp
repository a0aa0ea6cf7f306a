#include "montelux/scene/texture/procedural.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "montelux/mc/math/gradient_noise.h"

namespace montelux {

namespace {

// Noise of the plane, at a height where it is not 0 over integers.
float plane_noise(float s, float t) { return gradient_noise({s, t, 0.5f}); }

// A texture's point and footprint in its own space.
struct SolidCoordinates {
    Point3f p;
    Vec3f dpdx, dpdy;
};
SolidCoordinates solid_coordinates(const Transform& texture_from_world, const TextureContext& c,
                                   float scale = 1) {
    return {texture_from_world.point(c.p) * scale, texture_from_world.vector(c.dpdx) * scale,
            texture_from_world.vector(c.dpdy) * scale};
}

float fractal_noise(const SolidCoordinates& c, NoiseOctaves n) {
    return montelux::fractal_noise(c.p, n, c.dpdx, c.dpdy);
}

// Control points of 6 cubic Bezier segments in a row, each begun one point after the one before.
constexpr std::array<Vec3f, 9> marble_colors = {{{0.58f, 0.58f, 0.6f},
                                                 {0.58f, 0.58f, 0.6f},
                                                 {0.58f, 0.58f, 0.6f},
                                                 {0.5f, 0.5f, 0.5f},
                                                 {0.6f, 0.59f, 0.58f},
                                                 {0.58f, 0.58f, 0.6f},
                                                 {0.58f, 0.58f, 0.6f},
                                                 {0.2f, 0.2f, 0.33f},
                                                 {0.58f, 0.58f, 0.6f}}};

} // namespace

bool inside_dot(Point2f st) {
    constexpr float radius = 0.35f;
    const float s = std::floor(st.x + 0.5f), t = std::floor(st.y + 0.5f);
    if (!(plane_noise(s + 0.5f, t + 0.5f) > 0)) return false;
    const Point2f centre{s + (0.5f - radius) * plane_noise(s + 1.5f, t + 2.8f),
                         t + (0.5f - radius) * plane_noise(s + 4.5f, t + 9.8f)};
    const Vec2f d = st - centre;
    return d.x * d.x + d.y * d.y < radius * radius;
}

float noise_value(const NoiseTexture& t, const TextureContext& context) {
    const SolidCoordinates c = solid_coordinates(t.texture_from_world, context);
    switch (t.kind) {
    case NoiseTexture::Kind::fbm:
        return fractal_noise(c, t.octaves);
    case NoiseTexture::Kind::wrinkled:
        return turbulence(c.p, t.octaves, c.dpdx, c.dpdy);
    case NoiseTexture::Kind::windy:
        break;
    }
    const float wind = fractal_noise(solid_coordinates(t.texture_from_world, context, 0.1f),
                                     {.octaves = 3, .roughness = 0.5f});
    return std::abs(wind) * fractal_noise(c, {.octaves = 6, .roughness = 0.5f});
}

Vec3f marble_color(const MarbleTexture& t, const TextureContext& context) {
    const SolidCoordinates c = solid_coordinates(t.texture_from_world, context, t.scale);
    const float layers = c.p.y + t.variation * fractal_noise(c, t.octaves);
    constexpr std::size_t segments = marble_colors.size() - 3;
    const float along = (0.5f + 0.5f * std::sin(layers)) * static_cast<float>(segments);
    if (!std::isfinite(along)) return 1.5f * marble_colors[0];
    const std::size_t first = std::min(static_cast<std::size_t>(along), segments - 1);
    const float u = along - static_cast<float>(first), v = 1 - u;
    return 1.5f * (v * v * v * marble_colors[first] + 3 * v * v * u * marble_colors[first + 1] +
                   3 * v * u * u * marble_colors[first + 2] + u * u * u * marble_colors[first + 3]);
}

} // namespace montelux
