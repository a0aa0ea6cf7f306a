#include "montelux/mc/random/sobol.h"

#include <bit>
#include <string>
#include <vector>

#include "montelux/mc/math/error.h"
#include "montelux/mc/random/owen.h"
#include "montelux/mc/random/sobol_joe_kuo.h"

namespace montelux {

namespace {

constexpr SobolColumns van_der_corput_columns() {
    SobolColumns v{};
    for (int k = 0; k < sobol_bits; ++k) v[k] = 0x80000000u >> k;
    return v;
}

// Bratley, Fox 1988, "Algorithm 659", equation 2: the recurrence that a primitive polynomial of degree s
// defines, on columns shifted to the top of the word.
constexpr SobolColumns grow_columns(std::uint32_t polynomial, const std::uint16_t* initial_numbers) {
    const int degree = std::bit_width(polynomial) - 1;
    SobolColumns v{};
    for (int k = 0; k < degree; ++k) v[k] = std::uint32_t{initial_numbers[k]} << (31 - k);
    for (int k = degree; k < sobol_bits; ++k) {
        v[k] = v[k - degree] ^ (v[k - degree] >> degree);
        for (int j = 1; j < degree; ++j)
            if ((polynomial >> (degree - j)) & 1u) v[k] ^= v[k - j];
    }
    return v;
}

template <typename Visitor>
constexpr void visit_matrices(int dimensions, Visitor visit) {
    visit(0, van_der_corput_columns());
    std::size_t initial = 0;
    for (int d = 1; d < dimensions; ++d) {
        const std::uint32_t polynomial = joe_kuo_polynomials[d - 1];
        visit(d, grow_columns(polynomial, &joe_kuo_initial_numbers[initial]));
        initial += std::bit_width(polynomial) - 1;
    }
}

constexpr SobolNibbles build_nibbles() {
    SobolNibbles tables{};
    visit_matrices(sobol_nibble_dimensions, [&](int d, const SobolColumns& columns) {
        for (std::uint32_t position = 0; position < 8; ++position)
            for (std::uint32_t nibble = 0; nibble < 16; ++nibble)
                tables[d][position][nibble] =
                    reverse_bits(sobol_coordinate(nibble << (4 * position), columns));
    });
    return tables;
}

} // namespace

constinit const SobolNibbles sobol_nibbles = build_nibbles();

const SobolColumns& sobol_columns(int dimension) {
    static const std::vector<SobolColumns> matrices = [] {
        std::vector<SobolColumns> built(sobol_dimensions);
        visit_matrices(sobol_dimensions, [&](int d, const SobolColumns& columns) { built[d] = columns; });
        return built;
    }();
    if (dimension < 0 || dimension >= sobol_dimensions)
        throw Error("sobol_columns", "dimension " + std::to_string(dimension) + "; expected 0 to " +
                                         std::to_string(sobol_dimensions - 1));
    return matrices[dimension];
}

} // namespace montelux
