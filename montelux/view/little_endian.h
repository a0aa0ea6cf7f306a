// append: numbers in little-endian order at the end of a message.
#pragma once

#include <bit>
#include <span>
#include <string>
#include <type_traits>

namespace montelux {

template <typename T>
requires std::is_arithmetic_v<T>
void append(std::string& message, T value) {
    static_assert(std::endian::native == std::endian::little);
    message.append(reinterpret_cast<const char*>(&value), sizeof value);
}
template <typename T>
requires std::is_arithmetic_v<T>
void append(std::string& message, std::span<const T> values) {
    static_assert(std::endian::native == std::endian::little);
    message.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
}

} // namespace montelux
