// Random parameters of the integrals of the bank.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "montelux/mc/integrate/domain.h"
#include "montelux/mc/random/hash.h"
#include "montelux/mc/random/philox_stream.h"

namespace montelux::bench {

// Philox numbers keyed by the name of a family and a seed.
class Draws {
  public:
    Draws(std::string_view family, std::uint64_t seed) : numbers_(key(family, seed)) {}

    // In the open interval.
    double uniform() { return numbers_.next_double() + 0x1p-54; }
    double uniform(double a, double b) { return a + (b - a) * uniform(); }
    double log_uniform(double a, double b) { return a * std::exp(uniform() * std::log(b / a)); }
    // a, ..., b.
    int integer(int a, int b) { return a + static_cast<int>((b - a + 1) * uniform()); }
    bool chance(double p) { return uniform() < p; }
    std::vector<double> uniforms(int n, double a, double b) {
        std::vector<double> values(static_cast<std::size_t>(n));
        for (double& value : values) value = uniform(a, b);
        return values;
    }

  private:
    static std::uint64_t key(std::string_view family, std::uint64_t seed) {
        std::uint64_t hash = seed;
        for (char c : family) hash = hash_key(hash, static_cast<std::uint64_t>(c));
        return hash;
    }

    PhiloxStream numbers_;
};

inline std::vector<Range> box(int dimensions, double lower, double upper) {
    return std::vector<Range>(static_cast<std::size_t>(dimensions), Range{lower, upper});
}

// words("n = ", 3, ", w = ", 0.02)
template <typename... Parts>
std::string words(const Parts&... parts) {
    std::ostringstream text;
    text.precision(4);
    (text << ... << parts);
    return text.str();
}

} // namespace montelux::bench
