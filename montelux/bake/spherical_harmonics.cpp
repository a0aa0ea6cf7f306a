#include "montelux/bake/spherical_harmonics.h"

#include <algorithm>
#include <cmath>

#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/quadrature.h"
#include "montelux/mc/parallel/parallel_for.h"

namespace montelux {
namespace {

using Coefficients = DiffuseHarmonics::Coefficients;

std::array<double, sh_terms> constants() {
    const double first = std::sqrt(3 * inv_four_pi), second = std::sqrt(15 * inv_four_pi);
    return {std::sqrt(inv_four_pi),         first,  first,     first, second, second,
            std::sqrt(5 * inv_four_pi) / 2, second, second / 2};
}

std::array<double, sh_terms> polynomials(Vec3d d) {
    return {1, d.y, d.z, d.x, d.x * d.y, d.y * d.z, 3 * d.z * d.z - 1, d.z * d.x, d.x * d.x - d.y * d.y};
}

} // namespace

std::array<double, sh_terms> spherical_harmonics(Vec3d direction) {
    std::array<double, sh_terms> y = polynomials(direction);
    const std::array<double, sh_terms> k = constants();
    for (std::size_t i = 0; i < y.size(); ++i) y[i] *= k[i];
    return y;
}

Vec3d DiffuseHarmonics::irradiance_at(Vec3d normal) const {
    const std::array<double, sh_terms> y = spherical_harmonics(normal);
    Vec3d sum;
    for (std::size_t i = 0; i < y.size(); ++i) sum += irradiance[i] * y[i];
    return sum;
}

DiffuseHarmonics diffuse_harmonics(const EnvironmentMap& map, const CubeFrame& frame) {
    // Divides texels of small maps so that two nodes per side suffice, one where texels are tiny: the
    // functions' curvature leaves an error of 2e-6.
    const int width = map.grid().width(), height = map.grid().height(), shorter = std::min(width, height);
    const int parts = std::clamp(256 / shorter, 1, 256);
    const auto rule = gauss_legendre_rule(shorter < 512 ? 2 : 1);
    auto row_sum = [&](std::int64_t row) {
        Coefficients sum{};
        const int y = static_cast<int>(row);
        for (int x = 0; x < width; ++x) {
            const Vec3d energy(map.energy({0, x, y}));
            if (energy.x == 0 && energy.y == 0 && energy.z == 0) continue;
            std::array<double, sh_terms> mean{};
            for (int j = 0; j < parts; ++j)
                for (int i = 0; i < parts; ++i)
                    for (const QuadratureNode& t : rule)
                        for (const QuadratureNode& s : rule) {
                            const Vec3d d(map.direction({0, x, y}, static_cast<float>((i + s.x) / parts),
                                                        static_cast<float>((j + t.x) / parts)));
                            const auto basis = spherical_harmonics(frame.from_map(d));
                            for (std::size_t k = 0; k < mean.size(); ++k)
                                mean[k] +=
                                    basis[k] * (s.weight * t.weight / (static_cast<double>(parts) * parts));
                        }
            for (std::size_t k = 0; k < mean.size(); ++k) sum[k] += energy * mean[k];
        }
        return sum;
    };
    const Coefficients sum =
        parallel_reduce_ordered(height, row_sum, [](Coefficients a, const Coefficients& b) {
            for (std::size_t k = 0; k < a.size(); ++k) a[k] += b[k];
            return a;
        });
    DiffuseHarmonics harmonics;
    const std::array<double, sh_terms> k = constants();
    for (std::size_t i = 0; i < sum.size(); ++i) {
        const double lobe = i == 0 ? pi : i < 4 ? 2 * pi / 3 : pi / 4;
        harmonics.radiance[i] = sum[i] * static_cast<double>(map.unit());
        harmonics.irradiance[i] = harmonics.radiance[i] * lobe;
        harmonics.polynomial[i] = harmonics.irradiance[i] * (k[i] * inv_pi);
    }
    return harmonics;
}

} // namespace montelux
