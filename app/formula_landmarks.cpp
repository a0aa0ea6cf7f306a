#include "app/formula_landmarks.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <optional>

namespace montelux::app {
namespace {

constexpr std::size_t most_roots = 8;        // of a variable
constexpr std::size_t most_of_operand = 256; // characters

struct Token {
    enum class Kind { number, variable, symbol };
    Kind kind = Kind::symbol;
    double number = 0;
    std::size_t variable = 0;
    char symbol = ' '; // 'f' for the name of a function
};

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

// Length of a name and of the bracket behind it, or of either alone; 0 where there is neither.
std::size_t operand_length(std::string_view text) {
    const std::size_t name = name_length(text);
    int open = 0;
    for (std::size_t i = name; i < std::min(text.size(), most_of_operand); ++i) {
        if (text[i] == '(') ++open;
        if (text[i] == ')') --open;
        if (open == 0) return text[i] == ')' ? i + 1 : name;
    }
    return name;
}

std::vector<Token> tokens_of(std::string_view text, const std::vector<std::string>& variables,
                             const std::function<double(std::string_view)>& value_of) {
    std::vector<Token> tokens;
    for (std::size_t i = 0; i < text.size();) {
        Token token;
        std::size_t length = 1;
        if (is_digit(text[i]) || text[i] == '.') {
            const auto [stop, error] =
                std::from_chars(text.data() + i, text.data() + text.size(), token.number);
            if (error == std::errc()) {
                token.kind = Token::Kind::number;
                length = static_cast<std::size_t>(stop - (text.data() + i));
            }
        } else if (const std::size_t operand = operand_length(text.substr(i)); operand > 0) {
            const std::size_t name = name_length(text.substr(i));
            const auto variable = std::ranges::find(variables, text.substr(i, name));
            token.symbol = name > 0 ? 'f' : '(';
            length = std::max<std::size_t>(1, name);
            if (variable != variables.end()) {
                token.kind = Token::Kind::variable;
                token.variable = static_cast<std::size_t>(variable - variables.begin());
            } else if (token.number = value_of(text.substr(i, operand)); std::isfinite(token.number)) {
                token.kind = Token::Kind::number;
                length = operand;
            }
        } else {
            token.symbol = text[i];
        }
        if (text[i] != ' ') tokens.push_back(token);
        i += length;
    }
    return tokens;
}

// One formula.
class Reader {
  public:
    explicit Reader(std::vector<Token> tokens) : tokens_(std::move(tokens)) {}

    // The numbers, and the products and quotients of neighbouring ones.
    void add_numbers(const std::function<void(double)>& add) const {
        for (std::size_t i = 0; i < tokens_.size();) {
            if (is_number(i) && !is_symbol(i - 1, '^'))
                product(i, add);
            else
                ++i;
        }
    }

    // Roots of sums and comparisons of a number and a multiple of a variable.
    void add_roots(const std::function<void(std::size_t, double)>& add) const {
        for (std::size_t i = 0; i < tokens_.size(); ++i) {
            if (i > 0 && !begins_term(i - 1)) continue;
            std::size_t next = i;
            const std::optional<Term> a = term(next);
            if (!a || next + 1 >= tokens_.size()) continue;
            const bool sum = is_symbol(next, '+'), compares = is_symbol(next, '<') || is_symbol(next, '>');
            if (!sum && !compares && !is_symbol(next, '-')) continue;
            ++next;
            if (compares && is_symbol(next, '=')) ++next;
            double sign = sum ? 1 : -1;
            if (compares && is_symbol(next, '-')) {
                sign = 1;
                ++next;
            }
            const std::optional<Term> b = term(next);
            if (!b || a->of_variable == b->of_variable) continue;
            if (is_symbol(i - 1, '-')) sign = -sign;
            const Term& constant = a->of_variable ? *b : *a;
            const Term& multiple = a->of_variable ? *a : *b;
            add(multiple.variable, -sign * constant.factor / multiple.factor);
        }
    }

  private:
    struct Term {
        double factor = 1;
        bool of_variable = false;
        std::size_t variable = 0;
    };

    bool is_number(std::size_t i) const {
        return i < tokens_.size() && tokens_[i].kind == Token::Kind::number;
    }
    bool is_variable(std::size_t i) const {
        return i < tokens_.size() && tokens_[i].kind == Token::Kind::variable;
    }
    // False beyond either end.
    bool is_symbol(std::size_t i, char c) const {
        return i < tokens_.size() && tokens_[i].kind == Token::Kind::symbol && tokens_[i].symbol == c;
    }
    bool begins_term(std::size_t i) const {
        return tokens_[i].kind == Token::Kind::symbol &&
               std::string_view("(,+-<>=?:&|").find(tokens_[i].symbol) != std::string_view::npos;
    }

    // Product of the numbers from `i` on, which moves behind them.
    double product(std::size_t& i, const std::function<void(double)>& add) const {
        double value = tokens_[i++].number;
        if (add) add(value);
        while ((is_symbol(i, '*') || is_symbol(i, '/')) && is_number(i + 1) && !is_symbol(i + 2, '^')) {
            value = tokens_[i].symbol == '*' ? value * tokens_[i + 1].number : value / tokens_[i + 1].number;
            if (add) add(value);
            i += 2;
        }
        return value;
    }

    // A number, a variable, or a multiple of one; nothing where more follows than a sum can hold.
    std::optional<Term> term(std::size_t& i) const {
        Term term;
        if (is_number(i)) {
            term.factor = product(i, {});
            if (is_symbol(i, '*') && is_variable(i + 1)) ++i;
        }
        if (is_variable(i)) {
            term.of_variable = true;
            term.variable = tokens_[i++].variable;
            if ((is_symbol(i, '*') || is_symbol(i, '/')) && is_number(i + 1)) {
                const double value = tokens_[i + 1].number;
                term.factor *= is_symbol(i, '/') ? 1 / value : value;
                i += 2;
            }
        } else if (i == 0 || !is_number(i - 1)) {
            return std::nullopt;
        }
        for (char c : {'*', '/', '^', '('})
            if (is_symbol(i, c)) return std::nullopt;
        return term;
    }

    std::vector<Token> tokens_;
};

} // namespace

std::size_t name_length(std::string_view text) {
    std::size_t length = 0;
    while (length < text.size() && (is_letter(text[length]) || (length > 0 && is_digit(text[length]))))
        ++length;
    return length;
}

std::vector<std::vector<double>> formula_landmarks(const std::vector<std::string>& texts,
                                                   const std::vector<std::string>& variables,
                                                   const std::function<double(std::string_view)>& value_of) {
    std::vector<std::vector<double>> points, roots(variables.size());
    auto add_point = [&](std::vector<double> x) {
        const bool finite = std::ranges::all_of(x, [](double v) { return std::isfinite(v); });
        if (finite && std::ranges::find(points, x) == points.end()) points.push_back(std::move(x));
    };
    std::vector<Reader> readers;
    for (const std::string& text : texts) readers.emplace_back(tokens_of(text, variables, value_of));
    for (const Reader& reader : readers)
        reader.add_roots([&](std::size_t d, double root) {
            if (roots[d].size() < most_roots) roots[d].push_back(root);
        });
    std::size_t most = 0;
    for (const auto& of_variable : roots) most = std::max(most, of_variable.size());
    for (std::size_t i = 0; i < most; ++i) {
        std::vector<double> x;
        for (const auto& of_variable : roots) x.push_back(i < of_variable.size() ? of_variable[i] : 0);
        add_point(std::move(x));
    }
    for (const Reader& reader : readers)
        reader.add_numbers([&](double value) {
            for (double v : {value, -value}) add_point(std::vector<double>(variables.size(), v));
        });
    return points;
}

} // namespace montelux::app
