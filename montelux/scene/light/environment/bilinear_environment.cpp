#include "montelux/scene/light/environment/bilinear_environment.h"

#include "montelux/mc/parallel/parallel_for.h"

namespace montelux {

namespace {

// Centres of texels, and the two ends.
std::vector<float> centres(int n) {
    std::vector<float> at{0};
    for (int i = 0; i < n; ++i) at.push_back(static_cast<float>(i) + 0.5f);
    at.push_back(static_cast<float>(n));
    return at;
}

} // namespace

PiecewiseBilinear2D BilinearEnvironment::table_of(const EnvironmentGrid& grid,
                                                  const std::vector<float>& light) {
    std::vector<float> x = centres(grid.width()), y;
    std::vector<double> solid_angles;
    if (grid.layout() == EnvironmentLayout::equal_area) {
        y = centres(grid.height());
    } else {
        // Centres and edges: rows have their own solid angles.
        for (int i = 0; i <= 2 * grid.height(); ++i) y.push_back(0.5f * static_cast<float>(i));
        for (int i = 0; i < 2 * grid.height(); ++i) solid_angles.push_back(grid.solid_angle(i / 2));
    }
    const auto width = static_cast<std::size_t>(grid.width());
    std::vector<float> values(x.size() * y.size());
    parallel_for(static_cast<std::int64_t>(y.size()), [&](std::int64_t row) {
        const auto j = static_cast<std::size_t>(row);
        for (std::size_t i = 0; i < x.size(); ++i) {
            const EnvironmentGrid::Blend blend = grid.blend({x[i], y[j]});
            double sum = 0;
            for (std::size_t k = 0; k < 4; ++k)
                sum += static_cast<double>(blend.share[k]) * static_cast<double>(light[blend.texel[k]]) /
                       grid.solid_angle(static_cast<int>(blend.texel[k] / width));
            values[j * x.size() + i] = static_cast<float>(sum);
        }
    });
    return {std::move(x), std::move(y), std::move(values), solid_angles};
}

} // namespace montelux
