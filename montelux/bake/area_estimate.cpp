#include "montelux/bake/area_estimate.h"

#include <array>
#include <cmath>

#include "montelux/mc/random/philox.h"
#include "montelux/mc/random/uniform_bits.h"

namespace montelux {

TexelEstimate estimate_texel_mean(const EnvironmentMap& map, const CubeFrame& frame, const CubeTexel& texel,
                                  int size, const TexelGoal& goal, std::uint64_t key) {
    const std::array<std::uint32_t, 2> key_words{static_cast<std::uint32_t>(key),
                                                 static_cast<std::uint32_t>(key >> 32)};
    const Vec3d centre(map.radiance(Vec3f(frame.to_map(cube_texel_direction(texel, size)))));
    const double texel_width = 2.0 / size;
    const double solid_angle = cube_texel_solid_angle(texel.x, texel.y, size);
    const auto most = static_cast<std::uint32_t>(
        std::max(1.0, std::sqrt(0.5 * static_cast<double>(std::min<std::uint64_t>(goal.samples, 1 << 20)))));
    std::uint32_t n = goal.target_error > 0 ? std::min(4u, most) : most;
    std::uint64_t samples = 0;
    for (std::uint32_t round = 0;; ++round) {
        const double part = texel_width / n;
        Vec3d sum, variance;
        for (std::uint32_t i = 0; i < n * n; ++i) {
            const auto bits = philox4x32<>({i, round, 0, 0}, key_words);
            auto beyond = [&](std::uint32_t bits_x, std::uint32_t bits_y) {
                const double u = (texel.x + (i % n + unit_double(bits_x)) / n) / size;
                const double v = (texel.y + (i / n + unit_double(bits_y)) / n) / size;
                const double a = 2 * u - 1, b = 2 * v - 1, r2 = 1 + a * a + b * b;
                const Vec3d d = frame.to_map(cube_direction({texel.face, u, v}));
                return (Vec3d(map.radiance(Vec3f(d))) - centre) *
                       (part * part / (r2 * std::sqrt(r2) * solid_angle));
            };
            const Vec3d first = beyond(bits[0], bits[1]), second = beyond(bits[2], bits[3]);
            const Vec3d half_difference = (first - second) * 0.5;
            sum += (first + second) * 0.5;
            variance += multiply(half_difference, half_difference);
        }
        samples += std::uint64_t{2} * n * n;
        TexelEstimate estimate;
        estimate.value = centre + sum;
        estimate.standard_error = {std::sqrt(variance.x), std::sqrt(variance.y), std::sqrt(variance.z)};
        estimate.samples = samples;
        if (goal.target_error <= 0) return estimate;
        const double missed = missed_by(estimate, goal, goal.target_error);
        estimate.met = missed <= 1;
        if (estimate.met || n >= most) return estimate;
        // Parts that an edge of the map crosses number n, so that the error goes with n^(-3/2).
        const double wanted = n * std::pow(1.25 * missed, 2.0 / 3);
        n = static_cast<std::uint32_t>(std::min<double>(most, std::max<double>(n + 1, std::ceil(wanted))));
    }
}

} // namespace montelux
