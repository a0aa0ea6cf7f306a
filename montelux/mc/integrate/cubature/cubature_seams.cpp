#include "montelux/mc/integrate/cubature/cubature_seams.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

namespace montelux {

bool raise_seam_errors(CubatureRegions& regions) {
    std::vector<std::size_t> order(regions.count());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [&](std::size_t r) { return regions.centre(r)[0]; });
    bool grown = false;
    for (std::size_t i = 1; i < order.size(); ++i) {
        const std::size_t a = order[i - 1], b = order[i];
        for (std::size_t c = 0; c < regions.value(a).size(); ++c) {
            const CubatureRegions::Face &left = regions.face(a, c, true), &right = regions.face(b, c, false);
            const double jump = std::abs(left.value - right.value) - 2 * (left.slack + right.slack);
            for (std::size_t r : {a, b}) {
                const double hidden = regions.volume(r) * (r == a ? left : right).unseen * jump;
                if (!(hidden > regions.error(r)[c]) || regions.marks(r).indivisible) continue;
                regions.error(r)[c] = hidden;
                regions.marks(r).exhausted = false;
                grown = true;
            }
        }
    }
    return grown;
}

double surprise_near_face(const CubatureRegions& regions, std::size_t region, std::size_t component, double x,
                          double value) {
    const double h = regions.half_width(region)[0];
    for (const bool upper : {false, true}) {
        const CubatureRegions::Face& face = regions.face(region, component, upper);
        const double from_face =
            upper ? regions.centre(region)[0] + h - x : x - (regions.centre(region)[0] - h);
        if (from_face <= 2 * h * face.unseen)
            return std::max(0.0, std::abs(value - face.value) - 2 * face.slack);
    }
    return 0;
}

} // namespace montelux
