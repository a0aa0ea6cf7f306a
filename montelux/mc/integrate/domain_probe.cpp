#include "montelux/mc/integrate/domain_probe.h"

namespace montelux {

DomainProbe::DomainProbe(const Domain& domain) : x(4, domain.dimensions()), volume(4, 1.0) {
    PointBuffer u(x.count(), domain.uniforms());
    for (std::size_t i = 0; i < u.count(); ++i)
        for (int d = 0; d < u.dimensions(); ++d)
            u(i, d) = 0.1 + 0.2 * static_cast<double>(i) + 0.05 * (d % 3);
    domain.map(u, x, volume);
}

std::vector<double> DomainProbe::numbers() const {
    std::vector<double> all = volume;
    for (int d = 0; d < x.dimensions(); ++d) {
        const auto coordinate = x.view().coordinate(d);
        all.insert(all.end(), coordinate.begin(), coordinate.end());
    }
    return all;
}

} // namespace montelux
