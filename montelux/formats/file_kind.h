// FileKind: what a file is, by its content: the format of a scene, or a name for messages about files of other kinds.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace montelux {

// Scenes that can be read. Text of an unknown kind counts as pbrt's, whose reader says what it does not understand.
enum class SceneFormat : std::uint8_t { none, pbrt, gltf, mitsuba, obj, ply, stl };

struct FileKind {
    SceneFormat format = SceneFormat::none;
    std::string name{}; // "a PNG picture"; of format none
    std::string hint{}; // what to do with such a file; often empty
};

// Recognised by the first bytes; JSON files by all of them, binary STL files by their size.
FileKind file_kind(std::span<const std::uint8_t> bytes);

} // namespace montelux
