// FileKind: what a file is, by its content; chooses the reader, and names files of the wrong kind.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace montelux {

struct FileKind {
    std::string name; // "a PNG picture"; empty for text of an unknown kind
    std::string hint; // what to do with such a file; often empty
    bool is_gltf = false;
};

// Recognised by the first bytes; JSON files by all of them.
FileKind file_kind(std::span<const std::uint8_t> bytes);

} // namespace montelux
