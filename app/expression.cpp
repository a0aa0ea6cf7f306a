#include "app/expression.h"

#include "app/formula_landmarks.h"
#include "app/random_rounding.h"
#include "app/usage_error.h"
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <muParser.h>
#include <mutex>
#include <numbers>
#include <optional>
#include <string_view>
#include <type_traits>
#include <utility>

#include "montelux/mc/math/nearest_name.h"
#include "montelux/mc/random/hash.h"

namespace montelux::app {
namespace {

constexpr std::array<std::pair<const char*, double>, 4> mathematical_constants{
    {{"pi", std::numbers::pi},
     {"e", std::numbers::e},
     {"inf", std::numeric_limits<double>::infinity()},
     {"nan", std::numeric_limits<double>::quiet_NaN()}}};

// Functions that round, and those that muParser lacks. Its own asinh, acosh and atanh lose digits by cancellation.
template <typename Define>
void define_functions(const Define& define) {
    define("sin", [](double x) { return std::sin(x); });
    define("cos", [](double x) { return std::cos(x); });
    define("tan", [](double x) { return std::tan(x); });
    define("asin", [](double x) { return std::asin(x); });
    define("acos", [](double x) { return std::acos(x); });
    define("atan", [](double x) { return std::atan(x); });
    define("atan2", [](double y, double x) { return std::atan2(y, x); });
    define("sinh", [](double x) { return std::sinh(x); });
    define("cosh", [](double x) { return std::cosh(x); });
    define("tanh", [](double x) { return std::tanh(x); });
    define("asinh", [](double x) { return std::asinh(x); });
    define("acosh", [](double x) { return std::acosh(x); });
    define("atanh", [](double x) { return std::atanh(x); });
    define("exp", [](double x) { return std::exp(x); });
    define("expm1", [](double x) { return std::expm1(x); });
    define("log", [](double x) { return std::log(x); });
    define("ln", [](double x) { return std::log(x); });
    define("log2", [](double x) { return std::log2(x); });
    define("log10", [](double x) { return std::log10(x); });
    define("log1p", [](double x) { return std::log1p(x); });
    define("sqrt", [](double x) { return std::sqrt(x); });
    define("cbrt", [](double x) { return std::cbrt(x); });
    define("pow", [](double x, double y) { return std::pow(x, y); });
    define("hypot", [](double x, double y) { return std::hypot(x, y); });
    define("erf", [](double x) { return std::erf(x); });
    define("erfc", [](double x) { return std::erfc(x); });
    define("gamma", [](double x) { return std::tgamma(x); });
    define("lgamma", [](double x) { return std::lgamma(x); });
}

// Functions that are exact, or round by operators alone.
template <typename Define>
void define_exact_functions(const Define& define) {
    define("floor", [](double x) { return std::floor(x); });
    define("ceil", [](double x) { return std::ceil(x); });
}

double mod(double x, double y) { return x - y * std::floor(x / y); }
// What roundings of x leave of it: all values where neighbours of x lie further apart than y.
double rounded_mod(double x, double y) {
    return std::abs(x / y) < 0x1p53 ? mod(x, y) : y * RandomRounding::fraction();
}

// Function value with a random last digit, since libraries round to nearest in any mode. A whole result of whole arguments
// stays exact, except limits such as tanh(20) = 1. Negative zeros, which rounding down creates, become positive.
template <typename F, typename... X>
double rounded(X... x) {
    double y = 0;
    bool exact = false;
    {
        const NearestRounding nearest;
        const auto is_whole = [](double v) { return v == std::rint(v) && std::abs(v) < 0x1p53; };
        y = F{}((x == 0 ? 0.0 : x)...);
        exact = (is_whole(x) && ...) && is_whole(y) && (std::abs(y) > 1 || ((std::abs(x) <= 2) && ...));
    }
    RandomRounding::turn();
    return exact ? y : RandomRounding::moved(y);
}

// Identity in formulas with random roundings; chooses the direction of the next operations.
constexpr const char* turning = "_turn_";
constexpr std::size_t longest_text = 20'000; // that muParser reads
double turn(double x) {
    RandomRounding::turn();
    return x;
}

// Formula text with each variable wrapped in a call of that function.
std::string with_turns(const std::string& text, const std::vector<std::string>& variables) {
    std::string all;
    for (std::size_t i = 0; i < text.size();) {
        std::size_t length = name_length(std::string_view(text).substr(i));
        const std::string name = text.substr(i, length);
        if (length == 0) { // a number, with its exponent, or a symbol
            double number = 0;
            const auto [stop, error] = std::from_chars(text.data() + i, text.data() + text.size(), number);
            length = error == std::errc() && text[i] != '-'
                         ? static_cast<std::size_t>(stop - (text.data() + i))
                         : 1;
            all += text.substr(i, length);
        } else if (std::ranges::find(variables, name) != variables.end()) {
            all += turning + ("(" + name + ")");
        } else {
            all += name;
        }
        i += length;
    }
    return all;
}

enum class Rounding { nearest, random, opposite };

// A parser with the functions, the given constants, and those others whose names the user does not want for variables.
mu::Parser make_parser(const std::vector<std::string>& variables, const NamedConstants& given = {},
                       Rounding rounding = Rounding::nearest) {
    mu::Parser parser;
    parser.ClearConst();
    // Of all parsers, and not guarded: threads make parsers at the same time.
    static const bool once = (parser.ResetLocale(), true);
    static_cast<void>(once);
    const auto define = [&](const char* name, auto function) { parser.DefineFun(name, +function); };
    const auto define_rounded = [&]<typename F>(const char* name, F) {
        if constexpr (std::is_invocable_v<F, double>)
            parser.DefineFun(name, &rounded<F, double>);
        else
            parser.DefineFun(name, &rounded<F, double, double>);
    };
    define_exact_functions(define);
    if (rounding == Rounding::nearest) {
        define_functions(define);
        define("mod", &mod);
    } else {
        define_functions(define_rounded);
        define("mod", &rounded_mod);
        parser.DefineFun(turning, &turn);
    }
    for (const auto& [name, value] : mathematical_constants)
        if (std::find(variables.begin(), variables.end(), name) == variables.end())
            parser.DefineConst(name, value);
    for (const NamedConstant& c : given) parser.DefineConst(c.name, c.value);
    return parser;
}

// The constants with random roundings in their formulas.
NamedConstants with_random_roundings(const NamedConstants& given, Rounding rounding) {
    NamedConstants all;
    for (const NamedConstant& c : given) {
        mu::Parser parser = make_parser({}, all, rounding);
        const RandomRounding rounds(hash_key(all.size()), rounding == Rounding::opposite);
        parser.SetExpr(c.text);
        all.push_back({c.name, parser.Eval(), c.text});
    }
    return all;
}

std::string name_at(const std::string& text, std::size_t at) {
    return at < text.size() ? text.substr(at, name_length(std::string_view(text).substr(at))) : std::string();
}

[[noreturn]] void refuse(const std::string& option, const std::string& text, std::size_t at,
                         const std::string& what) {
    std::string message = "at character " + std::to_string(at + 1) + ": " + what;
    const bool one_line = std::all_of(text.begin(), text.end(), [](char c) { return c >= ' '; });
    if (one_line && text.size() <= 400) message += "\n    " + text + "\n    " + std::string(at, ' ') + "^";
    throw UsageError(option.empty() ? "formula" : option, message);
}

// `word`: the text is this name behind a minus sign, which an option of another program would be.
std::string unknown_name(const std::string& name, bool called, bool word, const mu::Parser& parser,
                         const std::vector<std::string>& variables, const std::string& option) {
    if (const auto function = parser.GetFunDef().find(name);
        !called && function != parser.GetFunDef().end()) {
        const char* const arguments = function->second.GetArgc() == 2 ? "(x, y)" : "(x)";
        return "the function '" + name + "' takes its arguments in brackets: " + name + arguments;
    }
    std::vector<std::string> known;
    if (!called) {
        known = variables;
        for (const auto& [constant_name, value] : parser.GetConst())
            if (!std::isnan(value)) known.push_back(constant_name); // not worth suggesting
    }
    for (const auto& [function_name, callback] : parser.GetFunDef()) known.push_back(function_name);
    const std::vector<std::string_view> views(known.begin(), known.end());
    std::string what = "there is no " + std::string(called ? "function" : "variable") + " '" + name + "'";
    if (word) what += ", and no option '-" + name + "'";
    if (name.size() > 1) what += did_you_mean(name, views); // every short name is near to a letter
    if (called) return what + "; expected one of " + formula_functions();
    if (variables.empty()) return what + "; a number is expected here, without variables";
    if (variables.size() <= 12) {
        what += variables.size() == 1 ? "; the variable is " : "; the variables are ";
        for (std::size_t i = 0; i < variables.size(); ++i) what += (i ? ", " : "") + variables[i];
    }
    return option.empty()
               ? what + " (--over " + name + "=LOWER:UPPER adds one, --let " + name + "=VALUE a constant)"
               : what;
}

// What is wrong, in words, from muParser's code.
[[noreturn]] void explain(const mu::ParserError& error, const std::string& text, const std::string& option,
                          const mu::Parser& parser, const std::vector<std::string>& variables) {
    auto at = static_cast<std::size_t>(std::max(0, static_cast<int>(error.GetPos())));
    at = std::min(at, text.size());
    const std::string& token = error.GetToken();
    switch (error.GetCode()) {
    case mu::ecUNASSIGNABLE_TOKEN: {
        const std::string name = name_at(text, at);
        if (name.empty()) refuse(option, text, at, "this cannot be read");
        const std::size_t next = text.find_first_not_of(' ', at + name.size());
        const bool called = next != std::string::npos && text[next] == '(';
        refuse(option, text, at, unknown_name(name, called, text == "-" + name, parser, variables, option));
    }
    case mu::ecUNEXPECTED_EOF:
        refuse(option, text, text.size(), "the formula ends too early");
    case mu::ecMISSING_PARENS:
        refuse(option, text, text.size(), "a closing bracket is missing");
    case mu::ecUNEXPECTED_PARENS:
        refuse(option, text, at > 0 && text.substr(at - 1, 1) == token ? at - 1 : at,
               "the bracket '" + token + "' is not expected here");
    case mu::ecEMPTY_EXPRESSION:
        refuse(option, text, 0, "the formula is empty");
    case mu::ecTOO_MANY_PARAMS:
        refuse(option, text, at > 0 ? at - 1 : 0, "the function '" + token + "' gets too many arguments");
    case mu::ecTOO_FEW_PARAMS:
        refuse(option, text, at > 0 ? at - 1 : 0, "the function '" + token + "' gets too few arguments");
    case mu::ecUNEXPECTED_VAL:
    case mu::ecUNEXPECTED_VAR:
    case mu::ecUNEXPECTED_FUN:
        refuse(option, text, at,
               "an operator is expected before '" + token + "' (products need a '*', as in 3*x)");
    case mu::ecUNEXPECTED_OPERATOR:
        refuse(option, text, at, "the operator '" + token + "' is not expected here");
    default:
        refuse(option, text, at, error.GetMsg());
    }
}

// Nothing is assigned, no formula is a list and no comparisons are chained; muParser would take them all.
void check_form(const std::string& text, const std::string& option) {
    std::vector<char> compared{0}; // since the last && or the like: in the text, and in each open bracket
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i], after = i + 1 < text.size() ? text[i + 1] : ' ';
        const bool two = after == '=';
        if (c == '(') compared.push_back(0);
        if (c == ')' && compared.size() > 1) compared.pop_back();
        if (c == '&' || c == '|' || c == '?' || c == ':' || c == ',') compared.back() = 0;
        if (c == '<' || c == '>' || (two && (c == '=' || c == '!'))) {
            if (compared.back())
                refuse(option, text, i, "comparisons are not chained; write 0<x && x<1 for 0<x<1");
            compared.back() = 1;
            if (two) ++i;
            continue;
        }
        if (c == '*' && after == '*')
            refuse(option, text, i, "'**' is not expected here; powers are written x^2");
        if (c == '=') refuse(option, text, i, "'=' is not expected here; '==' compares");
        if (c == ',' && compared.size() == 1)
            refuse(option, text, i, "',' is not expected here; each component is an argument of its own");
        if (c == '"') refuse(option, text, i, "texts are not expected in a formula");
    }
}

} // namespace

struct Formulas::Pool {
    // Parsers whose variables are this object's.
    struct Lease {
        std::vector<double> values;
        std::vector<mu::Parser> parsers;
    };

    std::vector<std::string> texts, variables;
    NamedConstants given;
    std::string option;
    Rounding rounding = Rounding::nearest;
    std::mutex mutex;
    std::vector<std::unique_ptr<Lease>> free;

    std::unique_ptr<Lease> make() const {
        auto lease = std::make_unique<Lease>();
        lease->values.resize(variables.size());
        for (const std::string& text : texts) {
            mu::Parser parser = make_parser(variables, given, rounding);
            std::optional<RandomRounding> of_constants;
            if (rounding != Rounding::nearest) of_constants.emplace(0, rounding == Rounding::opposite);
            try {
                for (std::size_t d = 0; d < variables.size(); ++d)
                    parser.DefineVar(variables[d], &lease->values[d]);
                const std::string turned = with_turns(text, variables);
                // muParser refuses longer texts; then one direction serves all operations between two functions.
                const bool turns = rounding != Rounding::nearest && turned.size() < longest_text;
                parser.SetExpr(turns ? turned : text);
                parser.Eval();
            } catch (const mu::ParserError& error) {
                explain(error, text, option, parser, variables);
            }
            lease->parsers.push_back(std::move(parser));
        }
        return lease;
    }
    std::unique_ptr<Lease> take() {
        {
            const std::lock_guard lock(mutex);
            if (!free.empty()) {
                auto lease = std::move(free.back());
                free.pop_back();
                return lease;
            }
        }
        return make();
    }
    void give_back(std::unique_ptr<Lease> lease) {
        const std::lock_guard lock(mutex);
        free.push_back(std::move(lease));
    }
};

Formulas::Formulas(const std::vector<std::string>& texts, const std::vector<std::string>& variables,
                   const std::string& option, const NamedConstants& given)
    : pool_(std::make_shared<Pool>()) {
    for (const std::string& text : texts) check_form(text, option);
    pool_->texts = texts;
    pool_->variables = variables;
    pool_->given = given;
    pool_->option = option;
    pool_->give_back(pool_->make());
}

int Formulas::count() const { return static_cast<int>(pool_->texts.size()); }
const std::vector<std::string>& Formulas::texts() const { return pool_->texts; }

std::vector<std::vector<double>> Formulas::landmarks() const {
    mu::Parser parser = make_parser({}, pool_->given);
    return formula_landmarks(pool_->texts, pool_->variables, [&parser](std::string_view text) {
        try {
            parser.SetExpr(std::string(text));
            return parser.Eval();
        } catch (const mu::ParserError&) {
            return std::numeric_limits<double>::quiet_NaN();
        }
    });
}

std::vector<Integrand::BatchFunction> Formulas::guides() const {
    std::vector<Integrand::BatchFunction> all;
    for (const std::string& text : formula_guides(pool_->texts, pool_->variables)) try {
            all.emplace_back(Formulas({text}, pool_->variables, "", pool_->given));
        } catch (const UsageError&) { // a part that is no formula by itself
            continue;
        }
    return all;
}

Integrand::BatchFunction Formulas::rounding() const {
    std::vector<std::shared_ptr<Pool>> pools;
    for (const Rounding rounding : {Rounding::random, Rounding::opposite}) {
        auto pool = std::make_shared<Pool>();
        pool->texts = pool_->texts;
        pool->variables = pool_->variables;
        pool->given = with_random_roundings(pool_->given, rounding);
        pool->rounding = rounding;
        pools.push_back(std::move(pool));
    }
    return [pools](const PointBatch& x, ValueBatch y) {
        for (std::size_t p = 0; p < pools.size(); ++p) {
            auto lease = pools[p]->take();
            for (std::size_t i = 0; i < x.count(); ++i) {
                x.gather(i, lease->values.data());
                for (double& coordinate : lease->values) {
                    const RandomRounding rounding(hash_key(i, &coordinate - lease->values.data()), p == 1);
                    coordinate = RandomRounding::moved(coordinate);
                }
                for (std::size_t c = 0; c < lease->parsers.size(); ++c) {
                    const RandomRounding rounding(i, p == 1);
                    y(i, static_cast<int>(2 * c + p)) = lease->parsers[c].Eval();
                }
            }
            pools[p]->give_back(std::move(lease));
        }
    };
}

void Formulas::operator()(const PointBatch& x, ValueBatch y) const {
    auto lease = pool_->take();
    for (std::size_t i = 0; i < x.count(); ++i) {
        x.gather(i, lease->values.data());
        for (std::size_t c = 0; c < lease->parsers.size(); ++c)
            y(i, static_cast<int>(c)) = lease->parsers[c].Eval();
    }
    pool_->give_back(std::move(lease));
}

double Formulas::operator()(double x) const {
    auto lease = pool_->take();
    lease->values.at(0) = x;
    const double y = lease->parsers.front().Eval();
    pool_->give_back(std::move(lease));
    return y;
}

double constant(const std::string& text, const std::string& option, const NamedConstants& given) {
    check_form(text, option);
    mu::Parser parser = make_parser({}, given);
    try {
        parser.SetExpr(text);
        return parser.Eval();
    } catch (const mu::ParserError& error) {
        explain(error, text, option, parser, {});
    }
}

void check_variable_name(const std::string& name, const std::string& option) {
    if (name.empty() || name_at(name, 0) != name)
        throw UsageError(option, "'" + name +
                                     "' is not a name of a variable; expected letters, digits and '_', the "
                                     "first no digit");
    const mu::Parser parser = make_parser({});
    if (parser.GetFunDef().contains(name))
        throw UsageError(option, "'" + name + "' is a function; a variable needs another name");
}

std::string formula_functions() {
    const mu::Parser parser = make_parser({});
    std::string list;
    for (const auto& [name, callback] : parser.GetFunDef()) list += (list.empty() ? "" : ", ") + name;
    return list;
}

} // namespace montelux::app
