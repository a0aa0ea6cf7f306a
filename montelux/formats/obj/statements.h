// Statements of OBJ and MTL files: lines of words, and the numbers in them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "montelux/mc/math/error.h"

namespace montelux::obj {

inline bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

// The rest of a statement, word by word.
class Words {
  public:
    Words(std::string_view text, std::string_view file, std::size_t line)
        : p_(text.data()), end_(text.data() + text.size()), file_(file), line_(line) {}

    // Empty at the end of the statement.
    std::string_view next() {
        skip_spaces();
        const char* begin = p_;
        while (p_ != end_ && !is_space(*p_)) ++p_;
        return {begin, static_cast<std::size_t>(p_ - begin)};
    }
    bool at_end() {
        skip_spaces();
        return p_ == end_;
    }
    // All that is left, without spaces around it: names may contain spaces.
    std::string_view rest() {
        skip_spaces();
        std::string_view text(p_, static_cast<std::size_t>(end_ - p_));
        while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
        p_ = end_;
        return text;
    }
    // The next word as a number, which `what` describes in messages. Throws Error.
    float number(std::string_view what);
    // The same, if the next word is a number; it is left where it is otherwise.
    std::optional<float> find_number();

    std::string where() const { return std::string(file_) + ":" + std::to_string(line_); }
    [[noreturn]] void error(std::string_view sentence) const { throw Error(where(), sentence); }

    // For readers of corners, which need every nanosecond.
    const char*& position() { return p_; }
    const char* end() const { return end_; }

  private:
    void skip_spaces() {
        while (p_ != end_ && is_space(*p_)) ++p_;
    }

    const char *p_, *end_;
    std::string_view file_;
    std::size_t line_;
};

// The statements of a file, without comments and empty lines. A backslash at the end of a line joins the next one.
class Statements {
  public:
    Statements(std::string_view text, std::string_view file)
        : p_(text.data()), end_(text.data() + text.size()), file_(file) {
        if (text.starts_with("\xef\xbb\xbf")) p_ += 3; // byte order mark
    }

    // False at the end of the file. `keyword` and `words` are valid until the next call.
    bool next();
    std::string_view keyword() const { return keyword_; }
    Words& words() { return words_; }
    std::size_t line() const { return line_; } // of the keyword, from 1

  private:
    std::string_view take_line();

    const char *p_, *end_;
    std::string_view file_;
    std::size_t line_ = 0, lines_ = 0;
    std::string joined_;
    std::string_view keyword_;
    Words words_{{}, {}, 0};
};

} // namespace montelux::obj
