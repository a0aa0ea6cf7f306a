#include "montelux/formats/number.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstddef>
#include <cstring>
#include <limits>
#include <system_error>

namespace montelux {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

constexpr float float_powers[] = {1e0f, 1e1f, 1e2f, 1e3f, 1e4f, 1e5f, 1e6f, 1e7f, 1e8f, 1e9f, 1e10f};
constexpr double double_powers[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                    1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
constexpr std::uint64_t integer_powers[] = {1, 10, 100, 1000, 10000, 100000, 1000000, 10000000, 100000000};

// Appends the digits from p on to `digits`, which wraps around beyond 19 of them; returns their end. Eight at a time,
// whatever their number: a loop that ends after each run of digits would be mispredicted there.
[[gnu::always_inline]] inline const char* take_digits(const char* p, const char* end, std::uint64_t& digits) {
    constexpr auto each = [](std::uint64_t byte) { return byte * 0x0101010101010101u; };
    if constexpr (std::endian::native == std::endian::little) {
        while (end - p >= 8) {
            std::uint64_t text;
            std::memcpy(&text, p, sizeof text);
            std::uint64_t d = text ^ each('0'); // 0 to 9 in the bytes of digits
            const std::uint64_t others = (((d & each(0x7f)) + each(0x76)) | d) & each(0x80);
            const int run = others == 0 ? 8 : std::countr_zero(others) / 8;
            if (run == 0) return p;
            d <<= 8 * (8 - run);   // the last digit to the highest byte, zeros before the first
            d = 10 * d + (d >> 8); // pairs, in bytes 0, 2, 4 and 6
            constexpr std::uint64_t pairs = 0x000000ff000000ffu;
            constexpr std::uint64_t first_third = 1000000 * (std::uint64_t{1} << 32) + 100,
                                    second_fourth = 10000 * (std::uint64_t{1} << 32) + 1;
            const std::uint64_t value =
                ((d & pairs) * first_third + ((d >> 16) & pairs) * second_fourth) >> 32;
            digits = digits * integer_powers[run] + value;
            p += run;
            if (run < 8) return p;
        }
    }
    while (p != end && is_digit(*p)) digits = 10 * digits + static_cast<std::uint64_t>(*p++ - '0');
    return p;
}

// Clinger 1990, "How to Read Floating Point Numbers Accurately": digits that fit the significand, times or over an
// exact power of ten, need one rounding. For a float a double may stand between, unless it lies midway between two
// floats: only there would a second rounding not know where the exact value is. Null for other numbers.
template <typename T>
const char* parse_short(const char* p, const char* end, T& value) {
    const bool negative = *p == '-';
    p += negative ? 1 : 0;
    std::uint64_t digits = 0;
    const char* first = p;
    p = take_digits(p, end, digits);
    std::ptrdiff_t count = p - first, power = 0;
    if (p != end && *p == '.') {
        const char* point = ++p;
        p = take_digits(p, end, digits);
        power = point - p;
        count += p - point;
    }
    if (count == 0 || count > 19) return nullptr;
    if (p != end && (*p == 'e' || *p == 'E')) {
        ++p;
        const bool below = p != end && *p == '-';
        if (p != end && (*p == '-' || *p == '+')) ++p;
        const char* digit = p;
        int exponent = 0;
        while (p != end && is_digit(*p) && p - digit < 3) exponent = 10 * exponent + (*p++ - '0');
        if (p == digit || (p != end && is_digit(*p))) return nullptr;
        power += below ? -exponent : exponent;
    }
    const std::ptrdiff_t size = power < 0 ? -power : power;
    T v;
    if (sizeof(T) == sizeof(float) && digits <= (1u << 24) && size <= 10) {
        const float power_of_ten = float_powers[size];
        v = power < 0 ? static_cast<float>(digits) / power_of_ten : static_cast<float>(digits) * power_of_ten;
    } else if (digits <= (std::uint64_t{1} << 53) && size <= 22) {
        const double d = power < 0 ? static_cast<double>(digits) / double_powers[size]
                                   : static_cast<double>(digits) * double_powers[size];
        constexpr std::uint64_t below_float = 0x1fffffff, midway = 0x10000000; // bits of the significand
        if (sizeof(T) == sizeof(float) && (std::bit_cast<std::uint64_t>(d) & below_float) == midway)
            return nullptr;
        v = static_cast<T>(d);
    } else {
        return nullptr;
    }
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
    const bool two_signs = p != begin && p != end && *p == '-';
    if (p == end || two_signs) return {begin, NumberStatus::malformed};
    if (const char* stop = parse_short(p, end, value)) return {stop, NumberStatus::ok};
    const char* q = p + (*p == '-' ? 1 : 0);
    if (q == end || !(is_digit(*q) || (*q == '.' && q + 1 != end && is_digit(q[1]))))
        return {begin, NumberStatus::malformed};
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
    const bool negative = p != end && *p == '-';
    if (p != end && (*p == '-' || *p == '+')) ++p;
    std::uint64_t digits = 0;
    const char* stop = take_digits(p, end, digits);
    if (stop == p) return {begin, NumberStatus::malformed};
    while (stop - p > 10 && *p == '0') ++p;
    const std::uint64_t most = std::uint64_t{1} << 31; // 10 digits
    if (stop - p > 10 || digits > (negative ? most : most - 1)) return {stop, NumberStatus::out_of_range};
    value = static_cast<std::int32_t>(negative ? -static_cast<std::int64_t>(digits)
                                               : static_cast<std::int64_t>(digits));
    return {stop, NumberStatus::ok};
}

} // namespace montelux
