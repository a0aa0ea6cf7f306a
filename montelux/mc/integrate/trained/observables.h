// Observables beside a target: bins of histograms, several functions as one, and the target times each.
#pragma once

#include <vector>

#include "montelux/mc/integrate/integrand.h"

namespace montelux {

// The bins [edge k, edge k + 1) of an observable of one component: component k is 1 where the observable lies
// in bin k, else 0; the last bin contains its upper edge. All are NaN where the observable is. Throws Error unless the edges increase.
Integrand histogram_bins(const Integrand& observable, std::vector<double> edges);

// The components of all functions one after the other.
Integrand together(const std::vector<Integrand>& functions);

// (f, f h_1, ..., f h_m) of an f with one component: what integrate() needs for the means of h over f / Z in
// one run, with the covariances of all.
Integrand with_observables(const Integrand& f, const Integrand& h);

} // namespace montelux
