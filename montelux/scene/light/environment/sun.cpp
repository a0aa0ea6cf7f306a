#include "montelux/scene/light/environment/sun.h"

#include <unordered_set>

#include "montelux/mc/math/compensated.h"

namespace montelux {

namespace {

constexpr double largest_sun = 0.01; // steradians
constexpr double least_share = 0.1;

// The texels connected with the brightest one that reach a share of its radiance; empty if their solid angle
// is too large.
std::vector<std::size_t> bright_part(const std::vector<float>& light, const EnvironmentGrid& grid,
                                     std::size_t brightest, double radiance) {
    const auto width = static_cast<std::size_t>(grid.width());
    std::unordered_set<std::size_t> seen{brightest};
    std::vector<std::size_t> part{brightest};
    double solid_angle = 0;
    for (std::size_t next = 0; next < part.size(); ++next) {
        const int x = static_cast<int>(part[next] % width), y = static_cast<int>(part[next] / width);
        solid_angle += grid.solid_angle(y);
        if (solid_angle > largest_sun) return {};
        for (int j = std::max(0, y - 1); j <= std::min(grid.height() - 1, y + 1); ++j)
            for (int i = std::max(0, x - 1); i <= std::min(grid.width() - 1, x + 1); ++i) {
                const std::size_t texel = static_cast<std::size_t>(j) * width + static_cast<std::size_t>(i);
                if (static_cast<double>(light[texel]) >= radiance * grid.solid_angle(j) &&
                    seen.insert(texel).second)
                    part.push_back(texel);
            }
    }
    return part;
}

} // namespace

std::optional<Sun> Sun::take_from(std::vector<float>& light, const EnvironmentGrid& grid) {
    const auto width = static_cast<std::size_t>(grid.width());
    const double total = sum_of(light);
    double highest = 0;
    std::size_t brightest = 0;
    for (std::size_t i = 0; i < light.size(); ++i) {
        double radiance = static_cast<double>(light[i]) / grid.solid_angle(static_cast<int>(i / width));
        if (radiance > highest) {
            highest = radiance;
            brightest = i;
        }
    }
    if (!(highest > 0)) return std::nullopt;
    std::vector<std::size_t> part;
    // As much of its rim as fits.
    for (double level : {0.01, 0.1, 0.5}) {
        part = bright_part(light, grid, brightest, level * highest);
        if (!part.empty()) break;
    }
    CompensatedSum sum;
    for (std::size_t texel : part) sum.add(static_cast<double>(light[texel]));
    if (!(sum.value() >= least_share * total) || part.empty()) return std::nullopt;

    std::size_t x0 = width, x1 = 0, y0 = light.size(), y1 = 0;
    for (std::size_t texel : part) {
        x0 = std::min(x0, texel % width);
        x1 = std::max(x1, texel % width + 1);
        y0 = std::min(y0, texel / width);
        y1 = std::max(y1, texel / width + 1);
    }
    std::vector<float> values((x1 - x0) * (y1 - y0));
    for (std::size_t texel : part)
        values[(texel / width - y0) * (x1 - x0) + texel % width - x0] = std::exchange(light[texel], 0.0f);
    const double rest = sum_of(light);
    return Sun(grid, rest > 0 ? sum.value() / total : 1, part.size(),
               PiecewiseConstant2D(values, static_cast<std::uint32_t>(x1 - x0),
                                   static_cast<std::uint32_t>(y1 - y0),
                                   {static_cast<double>(x0), static_cast<double>(y0)},
                                   {static_cast<double>(x1), static_cast<double>(y1)}));
}

} // namespace montelux
