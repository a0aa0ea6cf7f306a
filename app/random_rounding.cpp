#include "app/random_rounding.h"

#include <cfenv>
#include <cmath>
#include <limits>

#include "montelux/mc/random/hash.h"

namespace montelux::app {
namespace {

thread_local std::uint64_t state = 0;
thread_local bool is_opposite = false;

bool goes_up() {
    state = mix64(state + golden_gamma);
    return ((state & 1) != 0) != is_opposite;
}

} // namespace

RandomRounding::RandomRounding(std::uint64_t seed, bool opposite) {
    state = hash_key(seed);
    is_opposite = opposite;
    turn();
}

RandomRounding::~RandomRounding() { std::fesetround(FE_TONEAREST); }

void RandomRounding::turn() { std::fesetround(goes_up() ? FE_UPWARD : FE_DOWNWARD); }

double RandomRounding::moved(double value) {
    constexpr double up = std::numeric_limits<double>::infinity();
    if (value == 0 || std::isinf(value)) return value; // underflow and overflow are no loss of digits
    return std::nextafter(value, goes_up() ? up : -up);
}

double RandomRounding::fraction() {
    state = mix64(state + golden_gamma);
    const double u = (static_cast<double>(state >> 12) + 0.5) * 0x1p-52;
    return is_opposite ? 1 - u : u;
}

NearestRounding::NearestRounding() : before_(std::fegetround()) { std::fesetround(FE_TONEAREST); }
NearestRounding::~NearestRounding() { std::fesetround(before_); }

} // namespace montelux::app
