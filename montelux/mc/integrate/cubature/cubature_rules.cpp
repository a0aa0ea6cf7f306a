#include "montelux/mc/integrate/cubature/cubature_rules.h"

#include <cmath>

namespace montelux {
namespace {

using Generator = SymmetricRule::Generator;

// The outermost points on the axes leave a twentieth of a region unseen, 1/40 at each face, where jumps are
// common after many halvings. Probes leave 1/200 per face.
constexpr double probe_place = 0.995;

Generator diagonal(int places, double x) { return Generator(static_cast<std::size_t>(places), x); }

// Squared distances of the generators. The conditions of degree 7 fix l1 and l2 for given l0, those of
// degree 9 fix l3 (Genz & Malik 1983); this l0 gives the rule of 1980.
struct GenzMalikSquares {
    double l0, l1, l2, l3;
};
GenzMalikSquares genz_malik_squares() {
    const double l0 = 9.0 / 19;
    const double l1 = 4 / (15 - 5 / l0); // 9/10
    double ratio = (1 - l1 / l0) / 27;
    const double l2 = (5 - 7 * l1 - 35 * ratio) / (7 - 35 * l1 / 3 - 35 * ratio / l0); // 9/70
    ratio *= (1 - l2 / l0) / 3;
    const double l3 = (7 - 9 * (l2 + l1) + 63 * l2 * l1 / 5 - 63 * ratio) /
                      (9 - 63 * (l2 + l1) / 5 + 21 * l2 * l1 - 63 * ratio / l0);
    return {l0, l1, l2, l3};
}

} // namespace

SymmetricRule coarse_rule_of_one_dimension() {
    return {1, 11, {{}, {0.466372926024552848}, {0.825842930408165586}, {probe_place}}};
}

SymmetricRule fine_rule_of_one_dimension() {
    return {1,
            19,
            {{},
             {0.466372926024552848},
             {0.825842930408165586},
             {probe_place},
             {0.242876211049077481},
             {0.662510520380892081},
             {0.941666396127996058}}};
}

SymmetricRule two_dimensional_rule() {
    return {2,
            13,
            {{},
             {0.2517129343453109},
             {0.7013933644534266},
             {0.9590960631619962},
             {0.9956010478552127},
             {0.5},
             diagonal(2, 0.1594544658297559),
             diagonal(2, 0.3808991135940188),
             diagonal(2, 0.6582769255267192),
             diagonal(2, 0.8761473165029315),
             diagonal(2, 0.9982431840531980),
             {0.9790222658168462, 0.6492284325645389},
             {0.8727421201131239, 0.3582614645881228},
             {0.5666666666666666, 0.2077777777777778}}};
}

SymmetricRule three_dimensional_rule() {
    return {3,
            11,
            {{},
             {0.19},
             {0.5},
             {0.75},
             {0.8},
             {0.995},
             diagonal(2, 0.99873449983514),
             diagonal(2, 0.7793703685672423),
             diagonal(3, 0.9999698993088767),
             diagonal(3, 0.7902637224771788),
             diagonal(3, 0.4403396687650737),
             {0.9549373822794593, 0.4378478459006862, 0.4378478459006862},
             {0.9661093133630748, 0.9661093133630748, 0.4577105877763134}}};
}

SymmetricRule genz_malik_7(int dimensions) {
    const GenzMalikSquares s = genz_malik_squares();
    const double l1 = std::sqrt(s.l1), l2 = std::sqrt(s.l2);
    return {dimensions, 7, {{}, {l2}, {l1}, {l1, l1}, diagonal(dimensions, std::sqrt(s.l0))}, probe_place};
}

SymmetricRule genz_malik_9(int dimensions) {
    const GenzMalikSquares s = genz_malik_squares();
    const double l1 = std::sqrt(s.l1), l2 = std::sqrt(s.l2), l3 = std::sqrt(s.l3);
    return {dimensions,
            9,
            {{},
             {l2},
             {l1},
             {l3},
             {0.25},
             {l1, l1},
             {l1, l2},
             diagonal(3, l1),
             diagonal(dimensions, std::sqrt(s.l0))},
            probe_place};
}

} // namespace montelux
