#include "montelux/scene/light/environment/environment_density.h"

#include <algorithm>
#include <limits>

#include "montelux/mc/math/compensated.h"
#include "montelux/mc/parallel/parallel_for.h"

namespace montelux {

namespace {

template <typename F>
void for_each_row(const EnvironmentGrid& grid, const F& f) {
    const auto width = static_cast<std::size_t>(grid.width());
    parallel_for(grid.height(), [&](std::int64_t y) {
        f(static_cast<int>(y), static_cast<std::size_t>(y) * width, static_cast<std::size_t>(y + 1) * width);
    });
}

} // namespace

double texel_radiance(const Image& map, std::size_t texel) {
    const std::size_t first = texel * static_cast<std::size_t>(map.channels());
    double sum = 0;
    for (std::size_t c = 0; c < 3; ++c) sum += std::max(0.0, static_cast<double>(map.value_at(first + c)));
    return sum / 3;
}

std::vector<float> texel_light(const Image& map, const EnvironmentGrid& grid) {
    std::vector<float> light(grid.texel_count());
    for_each_row(grid, [&](int y, std::size_t begin, std::size_t end) {
        const double solid_angle = grid.solid_angle(y);
        for (std::size_t i = begin; i < end; ++i) {
            const double radiance = texel_radiance(map, i);
            // Neither underflow of faint light nor overflow of bright light.
            if (radiance > 0)
                light[i] = static_cast<float>(
                    std::clamp(radiance * solid_angle, static_cast<double>(std::numeric_limits<float>::min()),
                               static_cast<double>(std::numeric_limits<float>::max())));
        }
    });
    return light;
}

double sum_of(const std::vector<float>& light) {
    CompensatedSum sum;
    for (float v : light) sum.add(static_cast<double>(v));
    return sum.value();
}

std::vector<float> blended_light(const std::vector<float>& light, const EnvironmentGrid& grid) {
    // The integral of the blend over a texel, in which equal areas are equal solid angles.
    constexpr double shares[3] = {0.125, 0.75, 0.125};
    const auto width = static_cast<std::size_t>(grid.width());
    std::vector<float> blended(light.size());
    for_each_row(grid, [&](int y, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            double sum = 0;
            for (int dy = -1; dy <= 1; ++dy)
                for (int dx = -1; dx <= 1; ++dx) {
                    const std::size_t texel = grid.texel_around(static_cast<int>(i - begin) + dx, y + dy);
                    sum += shares[dx + 1] * shares[dy + 1] * static_cast<double>(light[texel]) /
                           grid.solid_angle(static_cast<int>(texel / width));
                }
            if (sum > 0)
                blended[i] = static_cast<float>(std::clamp(
                    sum * grid.solid_angle(y), static_cast<double>(std::numeric_limits<float>::min()),
                    static_cast<double>(std::numeric_limits<float>::max())));
        }
    });
    return blended;
}

bool compensate(std::vector<float>& light, const EnvironmentGrid& grid) {
    constexpr double least = 0.01;
    const double total = sum_of(light), mean = total / (4 * pi);
    const auto width = static_cast<std::size_t>(grid.width());
    CompensatedSum left;
    for (std::size_t i = 0; i < light.size(); ++i)
        left.add(std::max(0.0, static_cast<double>(light[i]) -
                                   mean * grid.solid_angle(static_cast<int>(i / width))));
    if (!(left.value() > least * total)) return false;
    for_each_row(grid, [&](int y, std::size_t begin, std::size_t end) {
        const double sky = mean * grid.solid_angle(y);
        for (std::size_t i = begin; i < end; ++i)
            light[i] = static_cast<float>(std::max(0.0, static_cast<double>(light[i]) - sky));
    });
    return true;
}

} // namespace montelux
