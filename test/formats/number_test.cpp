#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <gtest/gtest.h>
#include <random>
#include <string>

#include "montelux/formats/number.h"

namespace montelux {
namespace {

template <typename T>
NumberResult parse(const std::string& text, T& value) {
    return parse_number(text.data(), text.data() + text.size(), value);
}

void expect_float(const std::string& text, float expected) {
    float value = 12345;
    NumberResult r = parse(text, value);
    EXPECT_EQ(r.status, NumberStatus::ok) << text;
    EXPECT_EQ(r.end, text.data() + text.size()) << text;
    EXPECT_EQ(std::bit_cast<std::uint32_t>(value), std::bit_cast<std::uint32_t>(expected))
        << text << " gives " << value;
}

TEST(Number, FormsOfFloats) {
    expect_float("0", 0);
    expect_float("-0", -0.0f);
    expect_float("+1.5", 1.5f);
    expect_float(".25", 0.25f);
    expect_float("-.25", -0.25f);
    expect_float("5.", 5);
    expect_float("1e3", 1000);
    expect_float("1.E+2", 100);
    expect_float("4.37114e-8", 4.37114e-8f);
    expect_float("16777217", 16777216);
    expect_float("123456789012345678901234567890", 123456789012345678901234567890.0f);
    expect_float("0.000000000000000000000000000000000000000000000000000001", 0);
    expect_float("1e-60", 0);
    expect_float("-1e-4000", -0.0f);
    expect_float("1e-99999999999", 0);
    expect_float("1e-40", 1e-40f); // subnormal
}

TEST(Number, NotANumber) {
    for (const char* text : {"", "-", "+", ".", "abc", "inf", "nan", "-inf", "+-1", "--1", "e5", "-.e1"}) {
        float f;
        EXPECT_EQ(parse(std::string(text), f).status, NumberStatus::malformed) << text;
    }
    for (const char* text : {"", "-", "x", "+-1", "."}) {
        std::int32_t i;
        EXPECT_EQ(parse(std::string(text), i).status, NumberStatus::malformed) << text;
    }
}

TEST(Number, OutOfRange) {
    float f;
    EXPECT_EQ(parse(std::string("1e39"), f).status, NumberStatus::out_of_range);
    EXPECT_EQ(parse(std::string("-1e99999999999"), f).status, NumberStatus::out_of_range);
    EXPECT_EQ(parse(std::string(400, '9'), f).status, NumberStatus::out_of_range);
    std::int32_t i;
    EXPECT_EQ(parse(std::string("2147483648"), i).status, NumberStatus::out_of_range);
    EXPECT_EQ(parse(std::string("-2147483648"), i).status, NumberStatus::ok);
    EXPECT_EQ(i, std::numeric_limits<std::int32_t>::min());
}

TEST(Number, StopsBehindTheNumber) {
    std::string text = "1.5x";
    float f;
    EXPECT_EQ(parse(text, f).end, text.data() + 3);
    text = "3.7";
    std::int32_t i;
    EXPECT_EQ(parse(text, i).end, text.data() + 1);
}

// Against the C library, which rounds correctly, on short, long and random numbers.
TEST(Number, RoundsCorrectly) {
    std::mt19937_64 random(7);
    char text[64];
    for (int n = 0; n < 300000; ++n) {
        double magnitude = std::pow(10.0, static_cast<double>(random() % 20) - 10);
        double x = (static_cast<double>(random() % 2000001) - 1000000) / 1000000 * magnitude;
        int digits = static_cast<int>(random() % 12) + 1;
        switch (random() % 3) {
        case 0:
            std::snprintf(text, sizeof text, "%.*f", digits, x);
            break;
        case 1:
            std::snprintf(text, sizeof text, "%.*g", digits, x);
            break;
        default:
            std::snprintf(text, sizeof text, "%.*e", digits, x);
        }
        expect_float(text, std::strtof(text, nullptr));
        double d;
        ASSERT_EQ(parse(std::string(text), d).status, NumberStatus::ok);
        ASSERT_EQ(d, std::strtod(text, nullptr)) << text;
    }
}

} // namespace
} // namespace montelux
