// gzip files in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace montelux {

// All members of a gzip file (RFC 1952), one behind the other. Throws Error, with `name` in front, when the
// data is damaged, ends early, or would give more than `max_bytes`.
std::vector<std::uint8_t> gunzip(std::span<const std::uint8_t> bytes, std::string_view name,
                                 std::size_t max_bytes);

} // namespace montelux
