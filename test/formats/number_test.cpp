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
    expect_float("00000000000000000000000000000001.50", 1.5f);
    expect_float("3e0005", 300000);
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
    for (const char* ends_early : {"1e", "1e+", "1ex"}) {
        text = ends_early;
        EXPECT_EQ(parse(text, f).end, text.data() + 1);
        EXPECT_EQ(f, 1);
    }
    text = "3.7";
    std::int32_t i;
    EXPECT_EQ(parse(text, i).end, text.data() + 1);
}

// Midway between two floats, and so close to it that a double is midway.
TEST(Number, TwoRoundingsAreOne) {
    for (const char* text :
         {"16777217", "16777217.0", "16777217.000001", "16777217.00000001", "16777216.99999999", "16777219",
          "16777219.00000001", "16777218.99999999", "1677721700000001e-8", "1677721699999999e-8",
          "0.100000001490116", "1.00000005960464478", "1.00000017881393433"})
        expect_float(text, std::strtof(text, nullptr));
    std::mt19937_64 random(11);
    char text[64];
    for (int n = 0; n < 100000; ++n) { // 16 digits of midways
        const auto bits = static_cast<std::uint32_t>(random() % (30u << 23)) + (115u << 23);
        const auto x = static_cast<double>(std::bit_cast<float>(bits)),
                   y = static_cast<double>(std::bit_cast<float>(bits + 1));
        std::snprintf(text, sizeof text, "%.16g", (x + y) / 2);
        expect_float(text, std::strtof(text, nullptr));
    }
}

TEST(Number, Integers) {
    std::mt19937_64 random(3);
    for (int n = 0; n < 100000; ++n) {
        const auto expected =
            static_cast<std::int32_t>(static_cast<std::uint32_t>(random()) >> random() % 32);
        std::string text = std::to_string(expected);
        if (n % 3 == 0) text.insert(expected < 0 ? 1 : 0, std::string(random() % 25, '0'));
        if (n % 2 == 0) text += std::string(random() % 10, ' ');
        std::int32_t value = 0;
        const NumberResult r = parse(text, value);
        ASSERT_EQ(r.status, NumberStatus::ok) << text;
        ASSERT_EQ(value, expected) << text;
        ASSERT_EQ(r.end, text.data() + std::min(text.find(' '), text.size())) << text;
    }
    for (const char* text :
         {"2147483648", "-2147483649", "00000000000000002147483648", "99999999999", "18446744073709551617"}) {
        std::int32_t i;
        EXPECT_EQ(parse(std::string(text), i).status, NumberStatus::out_of_range) << text;
    }
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
