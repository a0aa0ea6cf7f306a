// What a file looks like, by its content: for messages about files that are not what was expected.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace montelux {

struct FileKind {
    std::string name; // "a PNG picture"; empty for text of no kind that is known
    std::string hint; // what to do with such a file instead; often empty
};

// By the first bytes of a file, and of JSON files by all of them.
FileKind file_kind(std::span<const std::uint8_t> bytes);

} // namespace montelux
