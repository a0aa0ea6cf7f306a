// gzip files in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace montelux {

// All members of a gzip file (RFC 1952), concatenated. Throws Error, prefixed with `name`, when the data is
// damaged, ends early, or unpacks to more than `max_bytes` or to more than both 16 MiB and 128 times its
// size. Text and meshes shrink to a fifth or a tenth; higher ratios indicate a decompression bomb (deflate
// reaches about 1032:1).
std::vector<std::uint8_t> gunzip(std::span<const std::uint8_t> bytes, std::string_view name,
                                 std::size_t max_bytes);

} // namespace montelux
