#include "montelux/formats/number.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <system_error>

namespace montelux {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

constexpr float powers_of_ten[] = {1e0f, 1e1f, 1e2f, 1e3f, 1e4f, 1e5f, 1e6f, 1e7f, 1e8f, 1e9f, 1e10f};

// Clinger 1990, "How to Read Floating Point Numbers Accurately": digits that fit the significand, times or
// over an exact power of ten, need one rounding. Covers most coordinates; null elsewhere.
const char* parse_short(const char* p, const char* end, float& value) {
    bool negative = *p == '-';
    if (negative) ++p;
    std::uint32_t digits = 0;
    const char* first = p;
    const char* limit = end - p > 9 ? p + 9 : end; // 8 digits and a point cannot overflow
    int decimals = 0;
    while (p != limit && is_digit(*p)) digits = 10 * digits + static_cast<std::uint32_t>(*p++ - '0');
    bool any = p != first;
    if (p != limit && *p == '.') {
        const char* point = ++p;
        while (p != limit && is_digit(*p)) digits = 10 * digits + static_cast<std::uint32_t>(*p++ - '0');
        decimals = static_cast<int>(p - point);
        any = any || decimals > 0;
    }
    if (!any || digits > (1u << 24)) return nullptr;
    if (p != end && (is_digit(*p) || *p == '.' || *p == 'e' || *p == 'E')) return nullptr;
    float v = static_cast<float>(digits) / powers_of_ten[decimals];
    value = negative ? -v : v;
    return p;
}

// For a number out of range: whether it is too small rather than too large.
bool underflows(const char* p, const char* end) {
    int magnitude = 0; // decimal exponent of the leading digit, roughly
    bool seen_point = false, seen_digit = false;
    for (; p != end && (is_digit(*p) || *p == '.' || *p == '-'); ++p) {
        if (*p == '.') seen_point = true;
        if (!is_digit(*p)) continue;
        if (*p != '0') seen_digit = true;
        if (!seen_point && seen_digit && magnitude < (1 << 30)) ++magnitude;
        if (seen_point && !seen_digit && magnitude > -(1 << 30)) --magnitude;
    }
    if (p == end || (*p != 'e' && *p != 'E')) return magnitude <= 0;
    ++p;
    if (p != end && *p == '+') ++p;
    int exponent = 0;
    if (std::from_chars(p, end, exponent).ec == std::errc::result_out_of_range) return p != end && *p == '-';
    return magnitude + std::clamp(exponent, -(1 << 29), 1 << 29) < 0;
}

template <typename T>
NumberResult parse_float(const char* begin, const char* end, T& value) {
    const char* p = begin;
    if (p != end && *p == '+') ++p;
    const char* q = p;
    if (q != end && *q == '-' && p == begin) ++q;
    if (q == end || !(is_digit(*q) || (*q == '.' && q + 1 != end && is_digit(q[1]))))
        return {begin, NumberStatus::malformed};
    if constexpr (sizeof(T) == sizeof(float))
        if (const char* stop = parse_short(p, end, value)) return {stop, NumberStatus::ok};
    auto [stop, error] = std::from_chars(p, end, value);
    if (error == std::errc()) return {stop, NumberStatus::ok};
    if (error == std::errc::invalid_argument) return {begin, NumberStatus::malformed};
    if (!underflows(p, stop)) return {stop, NumberStatus::out_of_range};
    value = *p == '-' ? -T(0) : T(0);
    return {stop, NumberStatus::ok};
}

} // namespace

NumberResult parse_number(const char* begin, const char* end, float& value) {
    return parse_float(begin, end, value);
}

NumberResult parse_number(const char* begin, const char* end, double& value) {
    return parse_float(begin, end, value);
}

NumberResult parse_number(const char* begin, const char* end, std::int32_t& value) {
    const char* p = begin;
    bool plus = p != end && *p == '+';
    if (plus) ++p;
    if (plus && p != end && *p == '-') return {begin, NumberStatus::malformed};
    auto [stop, error] = std::from_chars(p, end, value);
    if (error == std::errc::invalid_argument) return {begin, NumberStatus::malformed};
    return {stop, error == std::errc() ? NumberStatus::ok : NumberStatus::out_of_range};
}

} // namespace montelux
