// The rules that adaptive integration uses on a region, by number of dimensions and degree.
#pragma once

#include "montelux/mc/integrate/cubature/symmetric_rule.h"

namespace montelux {

// One dimension: 7 points of degree 11 with the outermost at 0.995, so that jumps near the ends are seen, and
// Kronrod's extension of these: 13 points of degree 19 that begin with the 7.
SymmetricRule coarse_rule_of_one_dimension();
SymmetricRule fine_rule_of_one_dimension();

// Degree 13 with 65 points in two dimensions: the generators of Eriksen (1984, thesis, Bergen) as in DCUHRE
// (Berntsen, Espelid & Genz 1991, ACM algorithm 698).
SymmetricRule two_dimensional_rule();
// Degree 11 with 127 points in three dimensions: the generators of Berntsen & Espelid as in DCUHRE.
SymmetricRule three_dimensional_rule();

// Degree 7 on 2^n + 2 n^2 + 2 n + 1 points (Genz & Malik 1980, "An adaptive algorithm for numerical
// integration over an n-dimensional rectangular region") and 2 n probes; n >= 2.
SymmetricRule genz_malik_7(int dimensions);
// Degree 9 (Genz & Malik 1983, "An imbedded family of fully symmetric numerical integration rules"), with
// one more orbit for a further null rule as in DCUHRE and 2 n probes; n >= 3.
SymmetricRule genz_malik_9(int dimensions);

} // namespace montelux
