#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <gtest/gtest.h>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "montelux/mc/device/device_function.h"
#include "montelux/mc/device/formula_source.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

const std::vector<std::string> x_and_y{"x", "y"};

// The values of formulas at a point.
std::vector<double> values(const std::vector<std::string>& formulas, double x, double y) {
    const std::pair<std::string, double> given[] = {{"s", 0.1}, {"large", 1e300}, {"zero", -0.0}};
    const DeviceFunction f(Device::open("emulated"), formula_source(formulas, x_and_y, given), 2);
    const double point[2] = {x, y};
    std::vector<double> result(formulas.size());
    f.at(point, 1, 1, result.data(), 1);
    return result;
}

TEST(FormulaSource, MeansWhatTheProgramMeans) {
    if (std::system("${CXX:-c++} --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "no C++ compiler";
    const double x = 0.7, y = -1.3;
    const std::vector<std::pair<std::string, double>> cases{
        {"x + y * 2", x + y * 2},
        {"x - y - 1", x - y - 1},
        {"x / y / 2", x / y / 2},
        {"-x^2", -(x * x)},
        {"2^-1*3", 1.5},
        {"2^3^2", 512},
        {"2^-x^2", std::pow(2, -(x * x))},
        {"y^3 + y^4", y * y * y + y * y * y * y},
        {"x^2.5", std::pow(x, 2.5)},
        {"- - x", x},
        {"+x", x},
        {"(x < 1) + (x <= 0.7) + (y > 0) + (x >= 1) + (1 == 1) + (1 != 1)", 3},
        {"x > 0 && y < 0 || 0", 1},
        {"0.5 && 2", 1},
        {"x > 1 ? 1 : y > 0 ? 2 : 3", 3},
        {"pi + e + s", std::numbers::pi + std::numbers::e + 0.1},
        {"1/large*1e300 + 1.5e-3 + .5", 1 + 1.5e-3 + 0.5},
        {"exp(-inf)", 0},
        {"sin(x)*cos(x)+tan(x)", std::sin(x) * std::cos(x) + std::tan(x)},
        {"asin(x)+acos(x)+atan(x)+atan2(x,y)", std::asin(x) + std::acos(x) + std::atan(x) + std::atan2(x, y)},
        {"sinh(x)+cosh(x)+tanh(x)+asinh(x)+acosh(2)+atanh(x)",
         std::sinh(x) + std::cosh(x) + std::tanh(x) + std::asinh(x) + std::acosh(2) + std::atanh(x)},
        {"log(x)+ln(x)+log2(x)+log10(x)", 2 * std::log(x) + std::log2(x) + std::log10(x)},
        {"sqrt(x)+abs(y)+sign(y)+rint(2.5)+exp(x)", std::sqrt(x) + 1.3 - 1 + 3 + std::exp(x)},
        {"erf(x)+erfc(x)+gamma(x)+lgamma(x)", 1 + std::tgamma(x) + std::lgamma(x)},
        {"expm1(x)+log1p(x)+cbrt(y)", std::expm1(x) + std::log1p(x) + std::cbrt(y)},
        {"floor(y)+ceil(y)+pow(x,y)+hypot(x,y)+mod(y,1)",
         -2 - 1 + std::pow(x, y) + std::hypot(x, y) + (y - std::floor(y))},
        {"min(x,y,1)+max(x,y)+sum(1,2,3)+avg(1,2)", y + x + 6 + 1.5},
        {"min(x)", x},
        {"x - 2 + y - (3 - 1) / 4 * 2", x - 2 + y - 1},
        {"x*2/y*3", x * 2 / y * 3},
        {"-zero", 0},
    };
    std::vector<std::string> formulas;
    for (const auto& [text, value] : cases) formulas.push_back(text);
    const std::vector<double> found = values(formulas, x, y);
    for (std::size_t i = 0; i < cases.size(); ++i)
        EXPECT_NEAR(found[i], cases[i].second, 1e-14 * (1 + std::abs(cases[i].second))) << cases[i].first;
    EXPECT_TRUE(std::isnan(values({"nan"}, x, y)[0]));
}

TEST(FormulaSource, LongChainsDoNotNest) {
    std::string formula = "x";
    for (int i = 0; i < 300; ++i) formula += i % 2 == 0 ? " + x*y/2" : " - 1";
    const std::string text = formula_source(std::vector{formula}, x_and_y).text;
    int depth = 0, deepest = 0;
    for (const char c : text) {
        depth += c == '(' ? 1 : c == ')' ? -1 : 0;
        deepest = std::max(deepest, depth);
    }
    EXPECT_LT(deepest, 10);
}

TEST(FormulaSource, SaysWhatCannotBeRead) {
    const auto expect_refused = [](const std::string& formula, const std::string& what) {
        try {
            formula_source(std::vector{formula}, x_and_y);
            ADD_FAILURE() << formula;
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
        }
    };
    expect_refused("x + z", "at character 5: there is no variable 'z'");
    expect_refused("x +", "the formula ends too early");
    expect_refused("", "the formula ends too early");
    expect_refused("(x", "')' is expected here");
    expect_refused("x)", "at character 2: an operator or the end");
    expect_refused("2 x", "an operator or the end");
    expect_refused("sin x", "'(' is expected here");
    expect_refused("atan2(x)", "takes 2 arguments, not 1");
    expect_refused("x ? 1", "':' is expected here");
    expect_refused("1e999", "does not fit");
    expect_refused("x; system(1)", "an operator or the end");
    expect_refused("x\\\n", "an operator or the end");
    expect_refused(std::string(5000, '('), "nested too deeply");
    expect_refused(std::string(5000, '-') + "x", "nested too deeply");
}

} // namespace
} // namespace montelux
