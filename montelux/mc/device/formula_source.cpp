#include "montelux/mc/device/formula_source.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <map>
#include <numbers>
#include <string_view>

#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

// What C does not have under one name. Small powers are products, as muParser makes them.
constexpr std::string_view helpers =
    R"(static inline double montelux_sign(double x) { return x < 0 ? -1 : x > 0 ? 1 : 0; }
static inline double montelux_rint(double x) { return floor(x + 0.5); }
static inline double montelux_mod(double x, double y) { return x - y * floor(x / y); }
static inline double montelux_min(double x, double y) { return y < x ? y : x; }
static inline double montelux_max(double x, double y) { return x < y ? y : x; }
static inline double montelux_sum(double x, double y) { return x + y; }
static inline double montelux_power_2(double x) { return x * x; }
static inline double montelux_power_3(double x) { return x * x * x; }
static inline double montelux_power_4(double x) { return x * x * x * x; }
)";

struct KnownFunction {
    std::string_view in_c;
    int arguments; // 0: any number from one on
};
const std::map<std::string_view, KnownFunction> functions{
    {"sin", {"sin", 1}},
    {"cos", {"cos", 1}},
    {"tan", {"tan", 1}},
    {"asin", {"asin", 1}},
    {"acos", {"acos", 1}},
    {"atan", {"atan", 1}},
    {"atan2", {"atan2", 2}},
    {"sinh", {"sinh", 1}},
    {"cosh", {"cosh", 1}},
    {"tanh", {"tanh", 1}},
    {"asinh", {"asinh", 1}},
    {"acosh", {"acosh", 1}},
    {"atanh", {"atanh", 1}},
    {"log2", {"log2", 1}},
    {"log10", {"log10", 1}},
    {"log", {"log", 1}},
    {"ln", {"log", 1}},
    {"exp", {"exp", 1}},
    {"sqrt", {"sqrt", 1}},
    {"abs", {"fabs", 1}},
    {"sign", {"montelux_sign", 1}},
    {"rint", {"montelux_rint", 1}},
    {"erf", {"erf", 1}},
    {"erfc", {"erfc", 1}},
    {"gamma", {"tgamma", 1}},
    {"lgamma", {"lgamma", 1}},
    {"expm1", {"expm1", 1}},
    {"log1p", {"log1p", 1}},
    {"cbrt", {"cbrt", 1}},
    {"floor", {"floor", 1}},
    {"ceil", {"ceil", 1}},
    {"pow", {"pow", 2}},
    {"hypot", {"hypot", 2}},
    {"mod", {"montelux_mod", 2}},
    {"min", {"montelux_min", 0}},
    {"max", {"montelux_max", 0}},
    {"sum", {"montelux_sum", 0}},
    {"avg", {"montelux_sum", 0}},
};

// A number in C, exactly.
std::string literal(double value) {
    if (std::isnan(value)) return "nan(\"\")";
    if (std::isinf(value)) return value > 0 ? "INFINITY" : "(-INFINITY)";
    std::array<char, 40> text{};
    std::snprintf(text.data(), text.size(), std::signbit(value) ? "(%.17e)" : "%.17e", value);
    return text.data();
}

// Recursive descent; each function gives an expression in C that is complete in itself.
class Translator {
  public:
    Translator(const std::string& text, const std::map<std::string, std::string, std::less<>>& names)
        : text_(text), names_(names) {}

    std::string operator()() {
        std::string all = choice();
        if (!at_end()) refuse("an operator or the end of the formula is expected here");
        return all;
    }

  private:
    static constexpr int deepest = 1000; // nested brackets and signs

    [[noreturn]] void refuse(const std::string& what) const {
        throw Error("formula '" + text_ + "'", "at character " + std::to_string(at_ + 1) + ": " + what);
    }
    void skip() {
        while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\n')) ++at_;
    }
    bool at_end() {
        skip();
        return at_ == text_.size();
    }
    bool take(std::string_view symbol) {
        skip();
        if (text_.compare(at_, symbol.size(), symbol) != 0) return false;
        at_ += symbol.size();
        return true;
    }
    void expect(std::string_view symbol) {
        if (!take(symbol)) refuse("'" + std::string(symbol) + "' is expected here");
    }

    std::string choice() {
        if (++depth_ > deepest) refuse("the formula is nested too deeply");
        std::string result = either();
        if (take("?")) {
            const std::string yes = choice();
            expect(":");
            const std::string no = choice();
            result = "(" + result + " != 0 ? " + yes + " : " + no + ")";
        }
        --depth_;
        return result;
    }
    std::string either() {
        std::string result = both();
        while (take("||")) result = "(" + result + " != 0 || " + both() + " != 0 ? 1.0 : 0.0)";
        return result;
    }
    std::string both() {
        std::string result = comparison();
        while (take("&&")) result = "(" + result + " != 0 && " + comparison() + " != 0 ? 1.0 : 0.0)";
        return result;
    }
    std::string comparison() {
        std::string result = sum();
        constexpr std::array<std::string_view, 6> symbols{"<=", ">=", "==", "!=", "<", ">"};
        for (bool more = true; more;) {
            more = false;
            for (const std::string_view symbol : symbols)
                if (take(symbol)) {
                    result = "(" + result + " " + std::string(symbol) + " " + sum() + " ? 1.0 : 0.0)";
                    more = true;
                    break;
                }
        }
        return result;
    }
    // One bracket around a chain of operators, which C takes from the left, too: compilers limit how deeply brackets
    // nest.
    template <typename Operand>
    std::string chain(const Operand& operand, std::string_view one, std::string_view other) {
        std::string result = operand();
        bool several = false;
        for (;; several = true) {
            const bool first = take(one);
            if (!first && !take(other)) return several ? "(" + result + ")" : result;
            result += " ";
            result += first ? one : other;
            result += " ";
            result += operand();
        }
    }
    std::string sum() {
        return chain([this] { return product(); }, "+", "-");
    }
    std::string product() {
        return chain([this] { return signed_power(); }, "*", "/");
    }
    std::string signed_power() {
        if (++depth_ > deepest) refuse("the formula is nested too deeply");
        const bool minus = take("-");
        std::string result = minus || take("+") ? signed_power() : power();
        --depth_;
        return minus ? "(-" + result + ")" : result;
    }
    std::string power() {
        const std::string base = primary();
        if (!take("^")) return base;
        const std::string exponent = signed_power();
        for (int k = 2; k <= 4; ++k)
            if (exponent == literal(k)) return "montelux_power_" + std::to_string(k) + "(" + base + ")";
        return "pow(" + base + ", " + exponent + ")";
    }
    std::string primary() {
        skip();
        if (take("(")) {
            std::string inside = choice();
            expect(")");
            return "(" + inside + ")";
        }
        if (at_ == text_.size()) refuse("the formula ends too early");
        const char c = text_[at_];
        if ((c >= '0' && c <= '9') || c == '.') return number();
        if ((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_') return name();
        refuse("a number, a name or a bracket is expected here");
    }
    std::string number() {
        double value = 0;
        const char *begin = text_.data() + at_, *end = text_.data() + text_.size();
        const auto [stop, error] = std::from_chars(begin, end, value);
        if (error == std::errc::result_out_of_range) refuse("the number does not fit into double precision");
        if (error != std::errc()) refuse("this is not a number");
        at_ += static_cast<std::size_t>(stop - begin);
        return literal(value);
    }
    std::string name() {
        const std::size_t begin = at_;
        while (at_ < text_.size() &&
               (std::isalnum(static_cast<unsigned char>(text_[at_])) != 0 || text_[at_] == '_'))
            ++at_;
        const std::string word = text_.substr(begin, at_ - begin);
        if (const auto function = functions.find(word); function != functions.end())
            return call(word, function->second);
        if (const auto known = names_.find(word); known != names_.end()) return known->second;
        at_ = begin;
        refuse("there is no variable '" + word + "'");
    }
    std::string call(const std::string& word, const KnownFunction& function) {
        expect("(");
        std::vector<std::string> arguments{choice()};
        while (take(",")) arguments.push_back(choice());
        expect(")");
        const int given = static_cast<int>(arguments.size());
        if (function.arguments != 0 && given != function.arguments)
            refuse("the function '" + word + "' takes " + std::to_string(function.arguments) +
                   " arguments, not " + std::to_string(given));
        const std::string in_c(function.in_c);
        if (function.arguments == 1) return in_c + "(" + arguments[0] + ")";
        if (function.arguments == 2) return in_c + "(" + arguments[0] + ", " + arguments[1] + ")";
        std::string result = arguments[0];
        for (std::size_t i = 1; i < arguments.size(); ++i)
            result = in_c + "(" + result + ", " + arguments[i] + ")";
        return word == "avg" ? "(" + result + " / " + literal(given) + ")" : result;
    }

    const std::string& text_;
    const std::map<std::string, std::string, std::less<>>& names_;
    std::size_t at_ = 0;
    int depth_ = 0;
};

} // namespace

FunctionSource formula_source(std::span<const std::string> formulas, std::span<const std::string> variables,
                              std::span<const std::pair<std::string, double>> constants) {
    std::map<std::string, std::string, std::less<>> names{
        {"pi", literal(std::numbers::pi)},
        {"e", literal(std::numbers::e)},
        {"inf", literal(std::numeric_limits<double>::infinity())},
        {"nan", literal(std::numeric_limits<double>::quiet_NaN())}};
    for (std::size_t d = 0; d < variables.size(); ++d) names[variables[d]] = "x[" + std::to_string(d) + "]";
    for (const auto& [name, value] : constants) names[name] = literal(value);
    FunctionSource source;
    source.file = "formula";
    source.text = helpers;
    if (formulas.size() == 1) {
        source.text +=
            "double integrand(int, const double* x) { return " + Translator(formulas[0], names)() + "; }\n";
        return source;
    }
    source.components = static_cast<int>(formulas.size());
    source.text += "void integrand(int, const double* x, int, double* y) {\n";
    for (std::size_t c = 0; c < formulas.size(); ++c)
        source.text += "    y[" + std::to_string(c) + "] = " + Translator(formulas[c], names)() + ";\n";
    source.text += "}\n";
    return source;
}

} // namespace montelux
