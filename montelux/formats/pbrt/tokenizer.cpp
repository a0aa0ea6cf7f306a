#include "montelux/formats/pbrt/tokenizer.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <type_traits>

#include "montelux/formats/number.h"

namespace montelux::pbrt {
namespace {

constexpr std::array<bool, 256> ends = [] {
    std::array<bool, 256> table{};
    for (const char c : {' ', '\n', '\t', '\r', '"', '[', ']', '#', '\0'})
        table[static_cast<unsigned char>(c)] = true;
    return table;
}();
// A list is measured after so many numbers.
constexpr std::size_t counted_numbers = 4096;

bool ends_word(char c) { return ends[static_cast<unsigned char>(c)]; }

} // namespace

std::string describe(const Token& token) {
    switch (token.kind) {
    case Token::Kind::end:
        return "the end of the file";
    case Token::Kind::word:
        return in_quotes(token.text);
    case Token::Kind::string:
        return "the string \"" + printable(token.text) + "\"";
    case Token::Kind::open:
        return "'['";
    case Token::Kind::close:
        break;
    }
    return "']'";
}

Tokenizer::Tokenizer(std::string_view text, std::uint32_t file, const Diagnostics& diagnostics)
    : diagnostics_(diagnostics), position_(text.data()), end_(text.data() + text.size()),
      line_start_(text.data()), file_(file) {
    if (text.starts_with("\xef\xbb\xbf")) { // skip a byte order mark
        position_ += 3;
        line_start_ += 3;
    }
    if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff"))
        diagnostics.error(here(), "the file is in UTF-16; expected ASCII or UTF-8 text");
}

void Tokenizer::skip_space() {
    while (position_ != end_) {
        char c = *position_;
        if (c == '\n') {
            ++line_;
            line_start_ = ++position_;
        } else if (c == ' ' || c == '\t' || c == '\r') {
            ++position_;
        } else if (c == '#') {
            while (position_ != end_ && *position_ != '\n') ++position_;
        } else {
            return;
        }
    }
}

const Token& Tokenizer::peek() {
    if (!peeked_) peeked_ = scan();
    return *peeked_;
}

Token Tokenizer::next() {
    if (!peeked_) return scan();
    Token token = *peeked_;
    peeked_.reset();
    return token;
}

Token Tokenizer::scan() {
    skip_space();
    Location at = here();
    if (position_ == end_) return {Token::Kind::end, {}, at};
    const char* start = position_++;
    switch (*start) {
    case '"':
        return scan_string(at);
    case '[':
        return {Token::Kind::open, {start, 1}, at};
    case ']':
        return {Token::Kind::close, {start, 1}, at};
    case '\0':
        diagnostics_.error(at, "a NUL byte; expected text (is this a binary file?)");
    default:
        break;
    }
    while (position_ != end_ && !ends_word(*position_)) ++position_;
    return {Token::Kind::word, {start, static_cast<std::size_t>(position_ - start)}, at};
}

Token Tokenizer::scan_string(Location at) {
    const char* start = position_;
    bool escapes = false;
    for (;; ++position_) {
        if (position_ == end_ || *position_ == '\n')
            diagnostics_.error(at, "this string has no closing quote on its line");
        if (*position_ == '\0') diagnostics_.error(here(), "a NUL byte in a string");
        if (*position_ == '"') break;
        if (*position_ == '\\') {
            escapes = true;
            if (position_ + 1 != end_ && position_[1] != '\n') ++position_;
        }
    }
    std::string_view text(start, static_cast<std::size_t>(position_ - start));
    ++position_;
    if (!escapes) return {Token::Kind::string, text, at};

    std::string result;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '\\') {
            result += text[i];
            continue;
        }
        constexpr std::string_view letters = "bfnrt\\'\"", meanings = "\b\f\n\r\t\\'\"";
        std::size_t k = i + 1 < text.size() ? letters.find(text[++i]) : std::string_view::npos;
        if (k == std::string_view::npos)
            diagnostics_.error(at, "unknown escape '\\" + printable(text.substr(i, 1)) +
                                       "' in a string; expected one of \\b \\f \\n \\r \\t \\\\ \\' \\\"");
        result += meanings[k];
    }
    return {Token::Kind::string, unescaped_.emplace_back(std::move(result)), at};
}

// Room for the rest of a list, whose numbers are as long as the `count` before, which took `bytes`.
template <typename T>
void Tokenizer::reserve_like(std::vector<T>& out, std::size_t count, std::size_t bytes) const {
    const auto left = static_cast<std::size_t>(end_ - position_);
    const auto* close = static_cast<const char*>(std::memchr(position_, ']', left));
    const std::size_t rest = close != nullptr ? static_cast<std::size_t>(close - position_) : left;
    const double expected =
        1.01 * static_cast<double>(count) * static_cast<double>(rest) / static_cast<double>(bytes);
    out.reserve(
        std::max(out.capacity() + out.capacity() / 2, out.size() + static_cast<std::size_t>(expected) + 1));
}

template <typename T>
std::size_t Tokenizer::read_all(std::vector<T>& out) {
    std::size_t before = out.size();
    if (peeked_) { // rewind to a word or string that was only peeked at
        if (peeked_->kind != Token::Kind::word) return 0;
        position_ = peeked_->text.data();
        peeked_.reset();
    }
    const char* first = position_;
    for (;;) {
        skip_space();
        if (position_ == end_ || *position_ == '"' || *position_ == '[' || *position_ == ']') break;
        T value;
        NumberResult result = parse_number(position_, end_, value);
        bool whole = result.end == end_ || ends_word(*result.end);
        if (result.status == NumberStatus::ok && whole && *position_ != '\0') {
            if (out.size() == out.capacity() && out.size() - before >= counted_numbers)
                reserve_like(out, out.size() - before, static_cast<std::size_t>(position_ - first));
            out.push_back(value);
            position_ = result.end;
            continue;
        }
        Token token = scan();
        constexpr bool integer = std::is_integral_v<T>;
        if (result.status == NumberStatus::out_of_range && whole)
            diagnostics_.error(token.at, in_quotes(token.text) + " is too large for " +
                                             (integer ? "a 32-bit integer" : "a floating-point number"));
        diagnostics_.error(token.at, "expected " + std::string(integer ? "an integer" : "a number") +
                                         ", read " + describe(token));
    }
    return out.size() - before;
}

std::size_t Tokenizer::read_numbers(std::vector<float>& out) { return read_all(out); }
std::size_t Tokenizer::read_numbers(std::vector<double>& out) { return read_all(out); }
std::size_t Tokenizer::read_numbers(std::vector<std::int32_t>& out) { return read_all(out); }

} // namespace montelux::pbrt
