#include "montelux/mc/integrate/quasi/randomised_points.h"

#include <algorithm>

#include "montelux/mc/random/hash.h"

namespace montelux {

RandomisedPoints::RandomisedPoints(PointSetKind kind, Randomisation randomisation, int dimensions,
                                   std::uint32_t count, std::uint64_t seed, std::uint32_t replicate) {
    if (kind == PointSetKind::sobol && randomisation == Randomisation::scramble)
        sobol_.emplace(dimensions, seed, replicate);
    else
        set_.emplace(PointSet::Settings{kind, dimensions,
                                        kind == PointSetKind::hammersley ? count : ~std::uint32_t{0},
                                        randomisation, hash_key(seed, replicate)});
}

void RandomisedPoints::fill(PointBuffer& u, std::uint64_t first) const {
    if (sobol_) return sobol_->fill(u, first);
    for (int d = 0; d < u.dimensions(); ++d) {
        std::span<double> out = u.coordinate(d);
        for (std::size_t i = 0; i < out.size(); ++i)
            out[i] = std::clamp((*set_)(static_cast<std::uint32_t>(first + i), d), 0x1p-54, 1 - 0x1p-53);
    }
}

} // namespace montelux
