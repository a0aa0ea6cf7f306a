#include "montelux/mc/integrate/replicates.h"

namespace montelux {

CovarianceMoments ReplicateSums::moments(std::uint64_t points, bool full) const {
    CovarianceMoments moments(components_, full);
    std::vector<double> mean(static_cast<std::size_t>(components_));
    for (int r = 0; r < replicates(); ++r) {
        for (int c = 0; c < components_; ++c)
            mean[static_cast<std::size_t>(c)] = sum(r, c) / static_cast<double>(points);
        moments.add(mean);
    }
    return moments;
}

} // namespace montelux
