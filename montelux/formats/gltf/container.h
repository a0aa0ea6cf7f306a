// Container: a .gltf or .glb file taken apart: its JSON, and the binary chunk behind it.
#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <vector>

#include "montelux/formats/gltf/diagnostics.h"

namespace montelux::gltf {

struct Container {
    std::vector<std::uint8_t> bytes; // of the whole file
    std::shared_ptr<const nlohmann::json> json;
    std::optional<std::span<const std::uint8_t>> chunk{}; // into `bytes`
};

// Errors: no JSON, a broken header, chunks that end beyond the file. glTF 2.0 specification, section 4.4.
Container open_container(std::vector<std::uint8_t> bytes, Diagnostics& diagnostics);

} // namespace montelux::gltf
