// Trivially copyable values to bytes and back, in the order and layout of this machine.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "montelux/mc/math/error.h"

namespace montelux {

class ByteWriter {
  public:
    template <typename T>
    void put(const T& value) requires std::is_trivially_copyable_v<T> {
        put_all(std::span<const T>(&value, 1));
    }
    template <typename T>
    void put_all(std::span<const T> values) requires std::is_trivially_copyable_v<T> {
        const std::size_t begin = bytes_.size();
        bytes_.resize(begin + values.size_bytes());
        if (!values.empty()) std::memcpy(bytes_.data() + begin, values.data(), values.size_bytes());
    }
    // Its length before it.
    void put_bytes(std::span<const std::uint8_t> bytes) {
        put(static_cast<std::uint64_t>(bytes.size()));
        put_all(bytes);
    }
    void put_text(const std::string& text) {
        put(static_cast<std::uint64_t>(text.size()));
        put_all(std::span<const char>(text));
    }

    void reserve(std::size_t size) { bytes_.reserve(size); }
    std::size_t size() const { return bytes_.size(); }
    std::vector<std::uint8_t> take() { return std::exchange(bytes_, {}); }

  private:
    std::vector<std::uint8_t> bytes_;
};

// Throws Error where the bytes end before the values do.
class ByteReader {
  public:
    // `what` is named in the error.
    explicit ByteReader(std::span<const std::uint8_t> bytes, std::string what = "message")
        : bytes_(bytes), what_(std::move(what)) {}

    template <typename T>
    T get() requires std::is_trivially_copyable_v<T> {
        T value;
        get_all(std::span<T>(&value, 1));
        return value;
    }
    template <typename T>
    void get_all(std::span<T> values) requires std::is_trivially_copyable_v<T> {
        if (bytes_.size() < values.size_bytes()) throw Error(what_, "it ends too early");
        if (!values.empty())
            std::memcpy(static_cast<void*>(values.data()), bytes_.data(), values.size_bytes());
        bytes_ = bytes_.subspan(values.size_bytes());
    }
    std::span<const std::uint8_t> get_bytes() {
        const auto size = get<std::uint64_t>();
        if (size > bytes_.size()) throw Error(what_, "it ends too early");
        const auto bytes = bytes_.first(size);
        bytes_ = bytes_.subspan(size);
        return bytes;
    }
    std::string get_text() {
        const auto bytes = get_bytes();
        return {bytes.begin(), bytes.end()};
    }
    bool at_end() const { return bytes_.empty(); }
    std::size_t remaining() const { return bytes_.size(); }

  private:
    std::span<const std::uint8_t> bytes_;
    std::string what_;
};

} // namespace montelux
