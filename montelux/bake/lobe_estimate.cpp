#include "montelux/bake/lobe_estimate.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/frame.h"
#include "montelux/mc/random/hash.h"
#include "montelux/mc/random/owen.h"
#include "montelux/mc/random/sobol.h"
#include "montelux/mc/random/uniform_bits.h"
#include "montelux/mc/stats/moments.h"

namespace montelux {

LobeEstimator::LobeEstimator(const EnvironmentMap& map, double alpha, bool source_mips)
    : map_(map), alpha_(alpha), half_vectors_(alpha), source_mips_(source_mips) {
    // Directions have the density D / 4, and the kernel is D n.l over its integral.
    const RadialKernel kernel = RadialKernel::ggx(alpha);
    mean_cosine_ = alpha * alpha * inv_four_pi / static_cast<double>(kernel.norm);
}

Vec3d LobeEstimator::sum_of_points(const Vec3f (&axes)[3], std::uint64_t key, std::uint32_t begin,
                                   std::uint32_t end, double solid_angle_scale) const {
    const double alpha2 = alpha_ * alpha_;
    Vec3d sum;
    for (std::uint32_t i = begin; i < end; ++i) {
        const double u = unit_double(reverse_bits(
            owen_scramble_reversed(sobol_coordinate_reversed(i, 0), static_cast<std::uint32_t>(key))));
        const double v = unit_double(reverse_bits(
            owen_scramble_reversed(sobol_coordinate_reversed(i, 1), static_cast<std::uint32_t>(key >> 32))));
        // n is the view: the direction leaves it by twice the angle of the half vector.
        const double tan2 = half_vectors_.squared_tangent_quantile(u), n_dot_l = (1 - tan2) / (1 + tan2);
        if (!(n_dot_l > 0)) continue;
        const auto radius = static_cast<float>(2 * std::sqrt(tan2) / (1 + tan2));
        const auto phi = static_cast<float>(2 * pi * v);
        const Vec3f l = axes[0] * (radius * std::cos(phi)) + axes[1] * (radius * std::sin(phi)) +
                        axes[2] * static_cast<float>(n_dot_l);
        Vec3f radiance;
        if (source_mips_) {
            const double t = (1 - n_dot_l) / 2 + alpha2 * (1 + n_dot_l) / 2; // D = alpha^2 / (pi t^2)
            const double texels = solid_angle_scale * t * t / alpha2;
            const double level =
                std::clamp(0.5 * std::log2(texels), 0.0, static_cast<double>(map_.top_level()));
            const int fine = static_cast<int>(level), coarse = std::min(fine + 1, map_.top_level());
            const auto share = static_cast<float>(level - fine);
            radiance = map_.radiance(l, fine) * (1 - share) + map_.radiance(l, coarse) * share;
        } else {
            radiance = map_.radiance(l);
        }
        sum += Vec3d(radiance) * n_dot_l;
    }
    return sum;
}

TexelEstimate LobeEstimator::estimate(Vec3f direction, const TexelTarget& target, std::uint64_t key) const {
    const Frame frame = Frame::from_normal(direction);
    const Vec3f axes[3] = {frame.s, frame.t, frame.n};
    const auto most = static_cast<std::uint32_t>(
        std::clamp<std::uint64_t>(target.samples / replicates, 1, std::uint64_t{1} << 31));
    std::uint32_t points = target.target_error > 0 ? std::min<std::uint32_t>(least_points, most) : most;
    // Solid angle of a sample of the first round over that of a texel, but for 1 / D: the density is D / 4.
    // The factor 4 is one level more, as Krivanek and Colbert advise.
    const double texel = 4 * pi / (static_cast<double>(map_.grid().width()) * map_.grid().height());
    const double solid_angle_scale = 4 * 4 * pi / (static_cast<double>(points) * replicates * texel);
    std::array<Vec3d, replicates> sums{};
    std::uint32_t done = 0;
    while (true) {
        Moments3 moments;
        for (std::size_t r = 0; r < replicates; ++r) {
            sums[r] += sum_of_points(axes, hash_key(key, r), done, points, solid_angle_scale);
            moments.add(sums[r] / (points * mean_cosine_));
        }
        done = points;
        TexelEstimate estimate;
        estimate.value = {moments.mean(0), moments.mean(1), moments.mean(2)};
        estimate.standard_error = {moments.standard_error(0), moments.standard_error(1),
                                   moments.standard_error(2)};
        estimate.samples = std::uint64_t{points} * replicates;
        if (target.target_error > 0) estimate.met = meets(estimate, target);
        if (target.target_error <= 0 || estimate.met || points >= most) return estimate;
        points = std::min(2 * points, most);
    }
}

} // namespace montelux
