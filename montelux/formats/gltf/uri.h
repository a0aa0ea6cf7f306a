// URIs of glTF files: data that is written in them, and names of files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

namespace montelux::gltf {

inline bool is_data_uri(std::string_view uri) { return uri.starts_with("data:"); }
// The bytes of "data:...;base64,...". Throws Error for other encodings and characters.
std::vector<std::uint8_t> decode_data_uri(std::string_view uri);
// The file that a relative URI names, relative to the folder of the glTF file. Throws Error for names outside the
// folder, other schemes, and broken escapes.
std::filesystem::path file_of_uri(std::string_view uri);

} // namespace montelux::gltf
