// A line of the comparison of integrators as an integrand of the library.
#pragma once

#include "bench/integrate/integrands.h"
#include <vector>

#include "montelux/mc/integrate/domain.h"
#include "montelux/mc/integrate/integrand.h"

namespace montelux {

using bench::BenchIntegrand;
using bench::Family;

inline Integrand as_integrand(const BenchIntegrand& f) {
    return Integrand::batch([&f](const PointBatch& x, ValueBatch y) {
        std::vector<const double*> coordinates;
        for (int d = 0; d < x.dimensions(); ++d) coordinates.push_back(x.coordinate(d).data());
        f.evaluate(coordinates.data(), x.count(), y.component(0).data());
    });
}
inline Domain domain_of(const BenchIntegrand& f) {
    return Domain(std::vector<Range>(static_cast<std::size_t>(f.dimensions()), {f.lower(), f.upper()}));
}

} // namespace montelux
