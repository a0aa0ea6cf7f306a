#include "montelux/image/variance_pool.h"

#include <algorithm>
#include <cstddef>

namespace montelux {

std::vector<double> pool_variances(std::span<const double> variances, int width, int height) {
    auto at = [&](int x, int y) { return static_cast<std::size_t>(y) * width + x; };
    std::vector<double> pooled(variances.begin(), variances.end());
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            if (variances[at(x, y)] < 0) continue;
            double sum = 0;
            int count = 0;
            for (int ny = std::max(y - 1, 0); ny <= std::min(y + 1, height - 1); ++ny)
                for (int nx = std::max(x - 1, 0); nx <= std::min(x + 1, width - 1); ++nx) {
                    double variance = variances[at(nx, ny)];
                    if (variance < 0) continue;
                    sum += variance;
                    ++count;
                }
            pooled[at(x, y)] = sum / count;
        }
    return pooled;
}

} // namespace montelux
