// vector_bytes: the memory that vectors hold, without that of what their elements point to.
#pragma once

#include <cstddef>
#include <vector>

namespace montelux {

template <typename... T>
std::size_t vector_bytes(const std::vector<T>&... vectors) {
    // Elements may be pointers.
    return (std::size_t{0} + ... + (vectors.capacity() * sizeof(T))); // NOLINT(bugprone-sizeof-expression)
}

} // namespace montelux
