// A bounded walk over the bytes of a file with a textual header (PFM, PNM, HDR).
#pragma once

#include <charconv>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace montelux {

class TextCursor {
  public:
    explicit TextCursor(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

    std::size_t position() const { return at_; }
    std::size_t remaining() const { return bytes_.size() - at_; }
    std::span<const std::uint8_t> rest() const { return bytes_.subspan(at_); }
    // -1 at the end.
    int next() { return at_ < bytes_.size() ? bytes_[at_++] : -1; }
    int peek() const { return at_ < bytes_.size() ? bytes_[at_] : -1; }

    static bool is_space(int c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

    // Passes over white space and, from '#' to the end of a line, comments.
    void skip_space_and_comments() {
        while (is_space(peek()) || peek() == '#')
            if (next() == '#')
                while (peek() != '\n' && peek() != -1) next();
    }
    // The bytes up to the next white space, at most 64.
    std::string word() {
        std::string w;
        while (peek() != -1 && !is_space(peek()) && w.size() < 64) w.push_back(static_cast<char>(next()));
        return w;
    }
    // A line without its end; empty if it is longer than `limit` or the file has ended.
    std::optional<std::string> line(std::size_t limit) {
        std::string l;
        while (peek() != '\n') {
            if (peek() == -1 || l.size() == limit) return std::nullopt;
            l.push_back(static_cast<char>(next()));
        }
        next();
        if (!l.empty() && l.back() == '\r') l.pop_back();
        return l;
    }

  private:
    std::span<const std::uint8_t> bytes_;
    std::size_t at_ = 0;
};

// The whole word as a number, or empty.
template <typename T>
std::optional<T> parse_number(std::string_view word) {
    T v{};
    auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), v);
    if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
    return v;
}

} // namespace montelux
