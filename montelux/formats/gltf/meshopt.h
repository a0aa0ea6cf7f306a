// decode_meshopt: buffer views that are compressed by EXT_meshopt_compression.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "montelux/formats/gltf/value.h"

namespace montelux::gltf {

// Whether Montelux was built with libmeshoptimizer.
bool reads_meshopt();

// What an `EXT_meshopt_compression` object says of a view's bytes.
struct MeshoptView {
    std::size_t count = 0, stride = 0; // elements and bytes of each
    enum class Mode { attributes, triangles, indices } mode = Mode::attributes;
    enum class Filter { none, octahedral, quaternion, exponential } filter = Filter::none;

    std::size_t bytes() const { return count * stride; }
};
// Errors: what the extension's specification does not allow, or another size than `view_bytes`.
MeshoptView meshopt_view(const Value& extension, std::uint64_t view_bytes);

// The view's bytes. Errors: damaged data, and a Montelux without the library.
std::vector<std::uint8_t> decode_meshopt(const MeshoptView& view, std::span<const std::uint8_t> compressed,
                                         const Value& at);

} // namespace montelux::gltf
