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

NearestRounding::NearestRounding() : before_(std::fegetround()) { std::fesetround(FE_TONEAREST); }
NearestRounding::~NearestRounding() { std::fesetround(before_); }

} // namespace montelux::app
