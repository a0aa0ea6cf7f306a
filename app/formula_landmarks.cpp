#include "app/formula_landmarks.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <optional>
#include <utility>

namespace montelux::app {
namespace {

constexpr std::size_t most_roots = 8;   // of the forms of one bracket
constexpr std::size_t most_forms = 128; // of a formula: a look takes few points, roots cost their square
constexpr std::size_t most_guides = 12;
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

// Form factor x + constant.
struct LinearForm {
    std::vector<double> factor;
    double constant = 0;
    std::size_t group = 0; // forms of one bracket, such as those of (x-1)^2+(y-2)^2
};

// The point closest to the origin where independent forms are zero, as many of them in turn as there can be.
class CommonRoot {
  public:
    explicit CommonRoot(std::size_t variables) : point_(variables, 0.0) {}

    // Returns false, without effect, where the form depends on earlier ones (by Gram and Schmidt's orthogonalisation).
    bool add(const LinearForm& form) {
        constexpr double dependent = 1e-9;
        std::vector<double> row(form.factor);
        for (const std::vector<double>& other : rows_) {
            const double along = std::inner_product(row.begin(), row.end(), other.begin(), 0.0);
            for (std::size_t d = 0; d < row.size(); ++d) row[d] -= along * other[d];
        }
        const double length = norm(row);
        if (!(length > dependent * norm(form.factor))) return false;
        const double value =
            std::inner_product(form.factor.begin(), form.factor.end(), point_.begin(), form.constant);
        for (std::size_t d = 0; d < row.size(); ++d) {
            row[d] /= length;
            point_[d] -= value / length * row[d];
        }
        rows_.push_back(std::move(row));
        return true;
    }
    const std::vector<double>& point() const { return point_; }

  private:
    static double norm(const std::vector<double>& v) {
        return std::sqrt(std::inner_product(v.begin(), v.end(), v.begin(), 0.0));
    }
    std::vector<double> point_;
    std::vector<std::vector<double>> rows_; // orthonormal
};

// Common roots of the first independent forms, of the first of those that are left, and so on.
void add_roots(std::vector<LinearForm> forms, const std::function<void(std::vector<double>)>& add_point) {
    for (std::size_t i = 0; i < most_roots && !forms.empty(); ++i) {
        CommonRoot root(forms.front().factor.size());
        std::erase_if(forms, [&](const LinearForm& form) { return root.add(form); });
        add_point(root.point());
    }
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

    // Linear forms: sums of numbers and multiples of variables, and differences of two that are compared.
    void add_forms(std::size_t variables, std::vector<LinearForm>& forms) const {
        std::vector<std::size_t> open; // brackets
        for (std::size_t i = 0; i < tokens_.size() && forms.size() < most_forms;) {
            const std::size_t begin = i;
            LinearForm form{std::vector<double>(variables, 0.0)};
            if ((i == 0 || begins_term(i - 1) || is_sign(i)) && add_sum(i, 1, form)) {
                if (const std::size_t before = i; skip_comparison(i) && !add_sum(i, -1, form)) i = before;
                // The bracket around the one in which the form stands.
                if (open.size() > 1) form.group = open[open.size() - 2] + 1;
                if (std::ranges::any_of(form.factor, [](double v) { return v != 0; }))
                    forms.push_back(std::move(form));
                continue;
            }
            i = begin;
            if (is_symbol(i, '(')) open.push_back(i);
            if (is_symbol(i, ')') && !open.empty()) open.pop_back();
            ++i;
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
    bool is_sign(std::size_t i) const { return is_symbol(i, '+') || is_symbol(i, '-'); }
    // Moves behind <, >, <= and the like.
    bool skip_comparison(std::size_t& i) const {
        const std::size_t begin = i;
        while (is_symbol(i, '<') || is_symbol(i, '>') || is_symbol(i, '=')) ++i;
        return i > begin;
    }
    // Adds the linear terms from `i` on, and moves behind them; false where there is none.
    bool add_sum(std::size_t& i, double sign, LinearForm& form) const {
        bool any = false;
        for (std::size_t next = i; next < tokens_.size(); any = true, i = next) {
            double factor = sign;
            if (is_sign(next))
                factor = is_symbol(next++, '-') ? -sign : sign;
            else if (any)
                break;
            const std::optional<Term> t = term(next);
            if (!t) break;
            (t->of_variable ? form.factor[t->variable] : form.constant) += factor * t->factor;
        }
        return any;
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

// Whether a variable stands in a text, and something else beside it.
bool is_guide(std::string_view text, const std::vector<std::string>& variables) {
    bool found = false;
    for (std::size_t i = 0; i < text.size();) {
        const std::size_t length = name_length(text.substr(i));
        found =
            found || (length > 0 && std::ranges::find(variables, text.substr(i, length)) != variables.end());
        i += std::max<std::size_t>(1, length);
    }
    return found && std::ranges::find(variables, text) == variables.end();
}

// The parts of what stands in one bracket, without the brackets inside of it: between commas, && and the like.
class Parts {
  public:
    explicit Parts(std::size_t begin) : begin_(begin) {}

    // Reads the character at `i`; `end`: of the text or the bracket.
    void read(std::string_view text, std::size_t i, bool end, const std::function<void(std::string)>& add) {
        const char c = end ? ',' : text[i];
        if (c == '<' || c == '>' || c == '=' || c == '!') {
            if (!compared_) left_ = text.substr(begin_, i - begin_);
            compared_ = true;
            begin_ = i + 1;
        }
        if (c != ',' && c != '?' && c != ':' && c != '&' && c != '|') return;
        const std::string part(text.substr(begin_, i - begin_));
        add(compared_ ? "(" + std::string(left_) + ")-(" + part + ")" : part);
        compared_ = false;
        begin_ = i + 1;
    }
    bool compared() const { return compared_; }

  private:
    std::size_t begin_;
    std::string_view left_;
    bool compared_ = false;
};

} // namespace

std::vector<std::string> formula_guides(const std::vector<std::string>& texts,
                                        const std::vector<std::string>& variables) {
    std::vector<std::string> guides;
    for (const std::string& text : texts) {
        std::vector<Parts> open{Parts(0)};
        for (std::size_t i = 0; i <= text.size(); ++i) {
            const bool end = i == text.size() || text[i] == ')';
            const bool whole = open.size() == 1 && !open.back().compared();
            open.back().read(text, i, end, [&](const std::string& part) {
                if (!whole && is_guide(part, variables) && std::ranges::find(guides, part) == guides.end())
                    guides.push_back(part);
            });
            if (end && open.size() > 1) open.pop_back();
            if (i < text.size() && text[i] == '(') open.emplace_back(i + 1);
        }
    }
    std::ranges::stable_sort(guides, std::greater{}, &std::string::size);
    if (guides.size() > most_guides) guides.resize(most_guides);
    return guides;
}

std::size_t name_length(std::string_view text) {
    std::size_t length = 0;
    while (length < text.size() && (is_letter(text[length]) || (length > 0 && is_digit(text[length]))))
        ++length;
    return length;
}

std::vector<std::vector<double>> formula_landmarks(const std::vector<std::string>& texts,
                                                   const std::vector<std::string>& variables,
                                                   const std::function<double(std::string_view)>& value_of) {
    std::vector<std::vector<double>> points;
    auto add_point = [&](std::vector<double> x) {
        const bool finite = std::ranges::all_of(x, [](double v) { return std::isfinite(v); });
        const bool origin = std::ranges::all_of(x, [](double v) { return v == 0; });
        if (finite && !origin && std::ranges::find(points, x) == points.end()) points.push_back(std::move(x));
    };
    std::vector<Reader> readers;
    readers.reserve(texts.size());
    for (const std::string& text : texts) readers.emplace_back(tokens_of(text, variables, value_of));
    std::vector<LinearForm> all;
    for (const Reader& reader : readers) {
        std::vector<LinearForm> forms;
        reader.add_forms(variables.size(), forms);
        while (!forms.empty()) {
            const std::size_t group = forms.front().group;
            std::vector<LinearForm> of_group;
            std::ranges::copy_if(forms, std::back_inserter(of_group),
                                 [&](const LinearForm& form) { return form.group == group; });
            std::erase_if(forms, [&](const LinearForm& form) { return form.group == group; });
            std::ranges::copy(of_group, std::back_inserter(all));
            add_roots(std::move(of_group), add_point);
        }
    }
    add_roots(all, add_point);
    for (const LinearForm& form : all) add_roots({form}, add_point);
    for (const LinearForm& form : all)
        if (form.constant == 0 && std::ranges::count(form.factor, 0.0) + 1 < std::ssize(form.factor))
            add_point(form.factor);
    for (const Reader& reader : readers)
        reader.add_numbers([&](double value) {
            for (double v : {value, -value}) add_point(std::vector<double>(variables.size(), v));
        });
    return points;
}

} // namespace montelux::app
