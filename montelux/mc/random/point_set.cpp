#include "montelux/mc/random/point_set.h"

#include <array>
#include <string>

#include "montelux/mc/math/error.h"
#include "montelux/mc/random/equidistant.h"
#include "montelux/mc/random/golden_ratio.h"
#include "montelux/mc/random/hash.h"
#include "montelux/mc/random/owen.h"
#include "montelux/mc/random/philox.h"
#include "montelux/mc/random/prime_base.h"
#include "montelux/mc/random/sobol.h"
#include "montelux/mc/random/uniform_bits.h"
#include "montelux/mc/random/van_der_corput.h"
#include "montelux/mc/random/weyl.h"

namespace montelux {

namespace {

constexpr std::array<std::string_view, 6> kind_names = {"independent", "halton",       "hammersley",
                                                        "sobol",       "golden_ratio", "weyl"};
constexpr std::array<std::string_view, 4> randomisation_names = {"none", "shift", "digit_permutation",
                                                                 "scramble"};

template <typename Enum, std::size_t N>
std::optional<Enum> find_name(const std::array<std::string_view, N>& names, std::string_view name) {
    for (std::size_t i = 0; i < N; ++i)
        if (names[i] == name) return static_cast<Enum>(i);
    return std::nullopt;
}

bool exists(PointSetKind kind, Randomisation randomisation) {
    const bool digits = kind == PointSetKind::halton || kind == PointSetKind::hammersley;
    switch (randomisation) {
    case Randomisation::digit_permutation:
        return digits;
    case Randomisation::scramble:
        return digits || kind == PointSetKind::sobol;
    default:
        return true;
    }
}

double wrapped_sum(double u, double shift) {
    const double sum = u + shift;
    return sum < 1 ? sum : sum - 1;
}

} // namespace

std::string_view to_string(PointSetKind kind) { return kind_names[static_cast<std::size_t>(kind)]; }
std::string_view to_string(Randomisation r) { return randomisation_names[static_cast<std::size_t>(r)]; }
std::optional<PointSetKind> point_set_kind(std::string_view name) {
    return find_name<PointSetKind>(kind_names, name);
}
std::optional<Randomisation> randomisation(std::string_view name) {
    return find_name<Randomisation>(randomisation_names, name);
}

PointSet::PointSet(const Settings& settings) : settings_(settings) {
    const int most = settings.kind == PointSetKind::hammersley ? prime_count + 1 : prime_count;
    if (settings.dimensions < 1 || settings.dimensions > most)
        throw Error("PointSet", std::to_string(settings.dimensions) + " dimensions of " +
                                    std::string(to_string(settings.kind)) + "; expected 1 to " +
                                    std::to_string(most));
    if (settings.count == 0) throw Error("PointSet", "0 points; expected at least 1");
    if (!exists(settings.kind, settings.randomisation))
        throw Error("PointSet", "randomisation '" + std::string(to_string(settings.randomisation)) + "' of " +
                                    std::string(to_string(settings.kind)) + "; expected 'none' or 'shift'" +
                                    (settings.kind == PointSetKind::sobol ? " or 'scramble'" : ""));
    const long double ratio = generalised_golden_ratio(settings.dimensions);
    for (int d = 0; d < settings.dimensions; ++d) {
        keys_.push_back(hash_key(settings.seed, d));
        if (settings.kind == PointSetKind::golden_ratio) steps_.push_back(golden_ratio_step(d, ratio));
        if (settings.kind == PointSetKind::weyl) steps_.push_back(weyl_step(d));
    }
}

double PointSet::operator()(std::uint32_t index, int dimension) const {
    const double u = unshifted(index, dimension);
    const bool shifted = settings_.randomisation == Randomisation::shift ||
                         settings_.randomisation == Randomisation::digit_permutation;
    return shifted ? wrapped_sum(u, unit_double(mix64(keys_[dimension] + golden_gamma))) : u;
}

double PointSet::unshifted(std::uint32_t index, int dimension) const {
    const std::uint64_t key = keys_[dimension];
    const bool scrambled = settings_.randomisation == Randomisation::scramble;
    switch (settings_.kind) {
    case PointSetKind::independent: {
        const auto block = philox4x32<10>(
            {index, static_cast<std::uint32_t>(dimension), 0, 0},
            {static_cast<std::uint32_t>(settings_.seed), static_cast<std::uint32_t>(settings_.seed >> 32)});
        return unit_double(std::uint64_t{block[0]} << 32 | block[1]);
    }
    case PointSetKind::halton:
        return halton(index, dimension, key);
    case PointSetKind::hammersley:
        if (dimension > 0) return halton(index, dimension - 1, key);
        return scrambled ? turned_equidistant(index, settings_.count, key)
                         : equidistant(index, settings_.count);
    case PointSetKind::sobol: {
        const std::uint32_t x = sobol_coordinate(index, sobol_columns(dimension));
        return unit_double(scrambled ? owen_scramble(x, static_cast<std::uint32_t>(key)) : x);
    }
    case PointSetKind::golden_ratio:
        return golden_ratio_coordinate(index, steps_[dimension]);
    default:
        return weyl_coordinate(index, steps_[dimension]);
    }
}

double PointSet::halton(std::uint32_t index, int base, std::uint64_t key) const {
    const PrimeBase& b = prime_bases[base];
    switch (settings_.randomisation) {
    case Randomisation::scramble:
        return scrambled_radical_inverse(index, b, key, settings_.count);
    case Randomisation::digit_permutation:
        return permuted_radical_inverse(index, b, 1 + bounded(static_cast<std::uint32_t>(key), b.base - 1));
    default:
        return radical_inverse(index, b);
    }
}

} // namespace montelux
