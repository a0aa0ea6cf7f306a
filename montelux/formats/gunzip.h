// gzip files in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace montelux {

// All members of a gzip file (RFC 1952), one behind the other. Throws Error, with `name` in front, when the
// data is damaged, ends early, or would give more than `max_bytes`, or more than 16 MiB and 128 times its
// size: text and meshes shrink to a fifth or a tenth, and what shrinks further was made to fill a reader's
// memory (deflate itself ends at about 1032:1).
std::vector<std::uint8_t> gunzip(std::span<const std::uint8_t> bytes, std::string_view name,
                                 std::size_t max_bytes);

} // namespace montelux
