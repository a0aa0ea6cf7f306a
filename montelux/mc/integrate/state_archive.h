// Saved state of estimators: numbers in order, bit by bit.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace montelux {

// Writes numbers as little-endian 64-bit words. Reads must have the order of the writes.
class StateWriter {
  public:
    void put(std::uint64_t x) { words_.push_back(x); }
    void put(double x) { words_.push_back(std::bit_cast<std::uint64_t>(x)); }
    template <std::integral T>
    void put(T x) {
        put(static_cast<std::uint64_t>(x));
    }
    void put(std::string_view text);
    void put(const std::vector<double>& values) { put_all(values); }
    template <typename T>
    void put_all(const std::vector<T>& values) {
        put(static_cast<std::uint64_t>(values.size()));
        for (const T& x : values) put(x);
    }
    std::span<const std::uint64_t> words() const { return words_; }

  private:
    std::vector<std::uint64_t> words_;
};

// Reads what a StateWriter wrote; throws Error at its end.
class StateReader {
  public:
    explicit StateReader(std::vector<std::uint64_t> words) : words_(std::move(words)) {}

    std::uint64_t get_word();
    double get_double() { return std::bit_cast<double>(get_word()); }
    template <std::integral T>
    T get() {
        return static_cast<T>(get_word());
    }
    std::string get_text();
    std::vector<double> get_doubles();
    template <std::integral T>
    std::vector<T> get_all() {
        std::vector<T> values(get_size());
        for (T& x : values) x = get<T>();
        return values;
    }
    bool at_end() const { return next_ == words_.size(); }
    // What has not been read yet.
    std::vector<std::uint64_t> rest() const {
        return {words_.begin() + static_cast<std::ptrdiff_t>(next_), words_.end()};
    }

  private:
    // A length that fits into the rest.
    std::size_t get_size();

    std::vector<std::uint64_t> words_;
    std::size_t next_ = 0;
};

// Writes a generation file (mc/io/generation_file.h): what was saved before is kept as PATH.previous. Throws
// Error.
void write_state(const std::string& path, std::string_view kind, const StateWriter& state);

struct SavedState {
    StateReader reader;
    // If the newest file is missing, of another kind or version, cut short or damaged: why, as a sentence;
    // the reader then reads the previous one. Else empty.
    std::string newest_refused_because;
};
// Throws Error when neither file is whole.
SavedState read_state(const std::string& path, std::string_view kind);

} // namespace montelux
