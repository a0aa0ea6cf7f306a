#include "montelux/formats/pbrt/parameter.h"

#include <algorithm>
#include <array>
#include <utility>

#include "montelux/formats/number.h"
#include "montelux/formats/pbrt/coverage.h"
#include "montelux/mc/math/nearest_name.h"

namespace montelux::pbrt {
namespace {

constexpr std::array<std::string_view, 13> type_names = {
    "float", "integer", "point2",  "vector2", "point3",   "vector3",  "normal",
    "bool",  "string",  "texture", "rgb",     "spectrum", "blackbody"};

enum class ValueKind : std::uint8_t { number, integer, boolean, string, number_or_string };

ValueKind kind_of(ParameterType type) {
    switch (type) {
    case ParameterType::integer:
        return ValueKind::integer;
    case ParameterType::boolean:
        return ValueKind::boolean;
    case ParameterType::string:
    case ParameterType::texture:
        return ValueKind::string;
    case ParameterType::spectrum:
        return ValueKind::number_or_string;
    default:
        return ValueKind::number;
    }
}

ParameterType parse_type(std::string_view name, Location at, const Diagnostics& diagnostics) {
    auto found = std::find(type_names.begin(), type_names.end(), name);
    if (found != type_names.end()) return static_cast<ParameterType>(found - type_names.begin());
    constexpr std::array<std::array<std::string_view, 2>, 5> old = {{{"point", "point3"},
                                                                     {"vector", "vector3"},
                                                                     {"color", "rgb"},
                                                                     {"xyz", "rgb"},
                                                                     {"normal3", "normal"}}};
    for (auto [then, now] : old)
        if (name == then)
            diagnostics.error(at, "parameter type " + in_quotes(name) + " is not of pbrt-v4; expected '" +
                                      std::string(now) + "'" + std::string(how_to_upgrade));
    diagnostics.error(at, "unknown parameter type " + in_quotes(name) + did_you_mean(name, type_names));
}

template <typename T>
void add_number(const Token& token, std::vector<T>& out, const Parameter& p, const Diagnostics& diagnostics) {
    T value;
    const char* end = token.text.data() + token.text.size();
    NumberResult result{};
    if (token.kind == Token::Kind::word) result = parse_number(token.text.data(), end, value);
    constexpr bool integer = std::is_integral_v<T>;
    if (token.kind == Token::Kind::word && result.end == end) {
        if (result.status == NumberStatus::ok) {
            out.push_back(value);
            return;
        }
        if (result.status == NumberStatus::out_of_range)
            diagnostics.error(token.at, in_quotes(token.text) + " is too large for " +
                                            (integer ? "a 32-bit integer" : "a floating-point number"));
    }
    diagnostics.error(token.at, "parameter " + in_quotes(p.name) + ": expected " +
                                    (integer ? "an integer" : "a number") + ", read " + describe(token));
}

void add_value(const Token& token, Parameter& p, Diagnostics& diagnostics) {
    switch (kind_of(p.type)) {
    case ValueKind::number_or_string:
        if (token.kind == Token::Kind::string) {
            p.strings.emplace_back(token.text);
            return;
        }
        [[fallthrough]];
    case ValueKind::number:
        return add_number(token, p.numbers, p, diagnostics);
    case ValueKind::integer:
        return add_number(token, p.integers, p, diagnostics);
    case ValueKind::boolean:
        // pbrt-v3 puts "true" in quotes; still accepted.
        if (token.text != "true" && token.text != "false")
            diagnostics.error(token.at, "parameter " + in_quotes(p.name) + ": expected true or false, read " +
                                            describe(token));
        p.integers.push_back(token.text == "true");
        return;
    case ValueKind::string:
        if (token.kind != Token::Kind::string)
            diagnostics.error(token.at, "parameter " + in_quotes(p.name) +
                                            ": expected a quoted string, read " + describe(token));
        p.strings.emplace_back(token.text);
    }
}

void read_bracketed(Tokenizer& tokens, Parameter& p, Location open, Diagnostics& diagnostics) {
    ValueKind kind = kind_of(p.type);
    for (;;) {
        if (kind == ValueKind::number) tokens.read_numbers(p.numbers);
        if (kind == ValueKind::integer) tokens.read_numbers(p.integers);
        Token token = tokens.next();
        if (token.kind == Token::Kind::close) break;
        if (token.kind == Token::Kind::end)
            diagnostics.error(open, "the '[' of parameter " + in_quotes(p.name) + " has no ']'");
        if (token.kind == Token::Kind::open)
            diagnostics.error(token.at, "'[' inside the values of parameter " + in_quotes(p.name));
        add_value(token, p, diagnostics);
    }
    if (!p.numbers.empty() && !p.strings.empty())
        diagnostics.error(p.at, "parameter " + in_quotes(p.name) + " mixes numbers and strings");
}

} // namespace

std::string_view name_of(ParameterType type) { return type_names[static_cast<std::size_t>(type)]; }

const Parameter* ParameterList::find(std::string_view name) const {
    for (auto p = own_.rbegin(); p != own_.rend(); ++p)
        if (p->name == name) return &*p;
    if (!defaults_) return nullptr;
    for (auto p = defaults_->rbegin(); p != defaults_->rend(); ++p)
        if ((*p)->name == name) return p->get();
    return nullptr;
}

const Parameter* ParameterList::find_default(std::string_view name,
                                             std::span<const ParameterType> types) const {
    if (!defaults_) return nullptr;
    for (auto p = defaults_->rbegin(); p != defaults_->rend(); ++p)
        if ((*p)->name == name && std::find(types.begin(), types.end(), (*p)->type) != types.end())
            return p->get();
    return nullptr;
}

std::vector<Parameter> read_parameters(Tokenizer& tokens, const RgbColorSpace& color_space,
                                       Diagnostics& diagnostics) {
    std::vector<Parameter> list;
    while (tokens.peek().kind == Token::Kind::string) {
        Token declaration = tokens.next();
        Parameter p;
        p.at = declaration.at;
        p.color_space = &color_space;
        constexpr std::string_view blank = " \t";
        std::string_view text = declaration.text;
        std::size_t type_begin = std::min(text.find_first_not_of(blank), text.size());
        std::size_t type_end = std::min(text.find_first_of(blank, type_begin), text.size());
        std::size_t name_begin = std::min(text.find_first_not_of(blank, type_end), text.size());
        std::size_t name_end = std::min(text.find_first_of(blank, name_begin), text.size());
        bool trailing = text.find_first_not_of(blank, name_end) != std::string_view::npos;
        if (name_begin == text.size() || trailing)
            diagnostics.error(p.at, "expected a parameter as \"type name\", read " + describe(declaration));
        p.type = parse_type(text.substr(type_begin, type_end - type_begin), p.at, diagnostics);
        p.name = text.substr(name_begin, name_end - name_begin);

        Token first = tokens.next();
        if (first.kind == Token::Kind::open)
            read_bracketed(tokens, p, first.at, diagnostics);
        else if (first.kind == Token::Kind::end || first.kind == Token::Kind::close)
            diagnostics.error(first.at, "parameter " + in_quotes(p.name) + ": expected a value, read " +
                                            describe(first));
        else
            add_value(first, p, diagnostics);
        for (const Parameter& other : list)
            if (other.name == p.name && other.type == p.type)
                diagnostics.warn(p.at,
                                 "parameter " + in_quotes(p.name) + " is given twice; the last one counts");
        list.push_back(std::move(p));
        if (list.size() > 10000) diagnostics.error(list.back().at, "more than 10000 parameters");
    }
    return list;
}

} // namespace montelux::pbrt
