// Tokenizer: text of a pbrt scene file to words, quoted strings, brackets and numbers.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "montelux/formats/pbrt/diagnostics.h"

namespace montelux::pbrt {

struct Token {
    enum class Kind : std::uint8_t { end, word, string, open, close };
    Kind kind = Kind::end;
    std::string_view text; // a string's content without the quotes and with its escapes resolved
    Location at;
};

// How a token is named in a message.
std::string describe(const Token& token);

// Skips comments (# to the end of the line) and white space. Tokens are views into `text` and into the
// tokenizer: both must outlive them.
class Tokenizer {
  public:
    Tokenizer(std::string_view text, std::uint32_t file, const Diagnostics& diagnostics);

    // Errors: a string that does not end on its line, an unknown escape, a NUL byte.
    Token next();
    const Token& peek();

    // Appends the numbers up to the first token that is no number; returns their count. An error if that
    // token is a word, or if a number is out of the type's range.
    std::size_t read_numbers(std::vector<float>& out);
    std::size_t read_numbers(std::vector<double>& out);
    std::size_t read_numbers(std::vector<std::int32_t>& out);

  private:
    template <typename T>
    std::size_t read_all(std::vector<T>& out);
    template <typename T>
    void reserve_like(std::vector<T>& out, std::size_t count, std::size_t bytes) const;
    void skip_space();
    Token scan();
    Token scan_string(Location at);
    Location here() const { return {file_, line_, static_cast<std::uint32_t>(position_ - line_start_) + 1}; }

    const Diagnostics& diagnostics_;
    const char* position_;
    const char* end_;
    const char* line_start_;
    std::uint32_t file_, line_ = 1;
    std::optional<Token> peeked_;
    std::deque<std::string> unescaped_; // strings that had escapes
};

} // namespace montelux::pbrt
