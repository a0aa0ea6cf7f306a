#include "montelux/mc/integrate/techniques/domain_restriction.h"

#include <vector>

namespace montelux {

Integrand restricted(const Integrand& f, const Domain& domain) {
    std::vector<Range> ranges(domain.ranges().begin(), domain.ranges().end());
    if (ranges.empty()) return f;
    return Integrand::batch(
        [f, ranges](const PointBatch& x, ValueBatch y) {
            std::vector<std::size_t> inside;
            inside.reserve(x.count());
            for (std::size_t i = 0; i < x.count(); ++i) {
                bool in = true;
                for (std::size_t d = 0; d < ranges.size(); ++d) {
                    const double v = x(i, static_cast<int>(d));
                    in = in && v >= ranges[d].lower && v <= ranges[d].upper;
                }
                if (in) inside.push_back(i);
            }
            if (inside.size() == x.count()) return f(x, y);
            PointBuffer points(inside.size(), x.dimensions());
            for (int d = 0; d < x.dimensions(); ++d)
                for (std::size_t k = 0; k < inside.size(); ++k) points(k, d) = x(inside[k], d);
            ValueBuffer values(inside.size(), y.components());
            if (!inside.empty()) f(points, values);
            for (int c = 0; c < y.components(); ++c) {
                for (double& v : y.component(c)) v = 0;
                for (std::size_t k = 0; k < inside.size(); ++k) y(inside[k], c) = values(k, c);
            }
        },
        f.components());
}

} // namespace montelux
