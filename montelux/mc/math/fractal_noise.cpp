#include "montelux/mc/math/fractal_noise.h"

#include <algorithm>
#include <cmath>

#include "montelux/mc/math/gradient_noise.h"

namespace montelux {

namespace {

// Share of the last octave whose `part` in [0, 1] is unaliased: a cubic step from 0.3 to 0.7.
float fade_in(float part) {
    const float t = std::clamp((part - 0.3f) / 0.4f, 0.0f, 1.0f);
    return t * t * (3 - 2 * t);
}

// Sum of `value` of each octave's noise, and of `mean` for the aliased ones.
template <typename Value>
float sum_of_octaves(Point3f p, NoiseOctaves n, Vec3f dpdx, Vec3f dpdy, float mean, const Value& value) {
    const float unaliased = unaliased_octaves(dpdx, dpdy, n.octaves);
    float sum = 0, frequency = 1, weight = 1;
    for (int i = 0; i < n.octaves; ++i) {
        const float share = fade_in(unaliased - static_cast<float>(i));
        if (share > 0) {
            const float v = value(gradient_noise(p * frequency));
            sum += weight * ((1 - share) * mean + share * v);
        } else {
            sum += weight * mean;
        }
        frequency *= lacunarity;
        weight *= n.roughness;
    }
    return sum;
}

} // namespace

float unaliased_octaves(Vec3f dpdx, Vec3f dpdy, int octaves) {
    const float longest2 = std::max(length_squared(dpdx), length_squared(dpdy));
    if (!(longest2 > 0)) return static_cast<float>(octaves);
    return std::clamp(-1 - 0.5f * std::log2(longest2), 0.0f, static_cast<float>(octaves));
}

float fractal_noise(Point3f p, NoiseOctaves n, Vec3f dpdx, Vec3f dpdy) {
    return sum_of_octaves(p, n, dpdx, dpdy, 0, [](float noise) { return noise; });
}

float turbulence(Point3f p, NoiseOctaves n, Vec3f dpdx, Vec3f dpdy) {
    return sum_of_octaves(p, n, dpdx, dpdy, mean_absolute_noise, [](float noise) { return std::abs(noise); });
}

} // namespace montelux
