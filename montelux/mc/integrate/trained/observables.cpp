#include "montelux/mc/integrate/trained/observables.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include "montelux/mc/math/error.h"

namespace montelux {

Integrand histogram_bins(const Integrand& observable, std::vector<double> edges) {
    if (observable.components() != 1)
        throw Error("histogram", "expected an observable with one component, got " +
                                     std::to_string(observable.components()));
    bool increasing = edges.size() >= 2;
    for (std::size_t k = 0; k < edges.size(); ++k)
        increasing = increasing && !std::isnan(edges[k]) && (k == 0 || edges[k - 1] < edges[k]);
    if (!increasing) throw Error("histogram", "expected at least two edges, each above the one before");
    const int bins = static_cast<int>(edges.size()) - 1;
    return Integrand::batch(
        [observable, edges = std::move(edges)](const PointBatch& x, ValueBatch y) {
            ValueBuffer values(x.count(), 1);
            observable(x, values);
            for (int c = 0; c < y.components(); ++c) std::ranges::fill(y.component(c), 0.0);
            for (std::size_t i = 0; i < x.count(); ++i) {
                const double v = values(i);
                if (std::isnan(v))
                    for (int c = 0; c < y.components(); ++c) y(i, c) = v;
                if (!(v >= edges.front() && v <= edges.back())) continue;
                const auto above = std::ranges::upper_bound(edges, v) - edges.begin() - 1;
                y(i, std::min(static_cast<int>(above), y.components() - 1)) = 1;
            }
        },
        bins);
}

Integrand together(const std::vector<Integrand>& functions) {
    int components = 0;
    for (const Integrand& f : functions) components += f.components();
    if (components == 0) throw Error("observables", "expected at least one function");
    return Integrand::batch(
        [functions](const PointBatch& x, ValueBatch y) {
            int first = 0;
            const std::size_t stride =
                y.components() > 1 ? static_cast<std::size_t>(y.component(1).data() - y.component(0).data())
                                   : y.count();
            for (const Integrand& f : functions) {
                f(x, ValueBatch(y.component(first).data(), y.count(), f.components(), stride));
                first += f.components();
            }
        },
        components);
}

Integrand with_observables(const Integrand& f, const Integrand& h) {
    if (f.components() != 1)
        throw Error("observables",
                    "expected a target with one component, got " + std::to_string(f.components()));
    Integrand both = together({f, h});
    const int components = both.components();
    return Integrand::batch(
        [both = std::move(both)](const PointBatch& x, ValueBatch y) {
            both(x, y);
            for (int c = 1; c < y.components(); ++c)
                for (std::size_t i = 0; i < y.count(); ++i) y(i, c) = y(i) == 0 ? 0 : y(i, c) * y(i);
        },
        components);
}

} // namespace montelux
