// Numbers from text: decimal digits to float, double and integer, without regard to the locale.
#pragma once

#include <cstdint>

namespace montelux {

enum class NumberStatus : std::uint8_t { ok, malformed, out_of_range };

// Where the number ends (at the start if there is none).
struct NumberResult {
    const char* end = nullptr;
    NumberStatus status = NumberStatus::malformed;
};

// Reads one number from the start of [begin, end). A leading '+' is allowed; "inf", "nan" and hexadecimal are
// not. Floating-point results are correctly rounded; underflow gives 0.
NumberResult parse_number(const char* begin, const char* end, float& value);
NumberResult parse_number(const char* begin, const char* end, double& value);
NumberResult parse_number(const char* begin, const char* end, std::int32_t& value);

} // namespace montelux
