// DracoMesh: the triangles of a primitive that is compressed by KHR_draco_mesh_compression.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "montelux/formats/gltf/accessor.h"
#include "montelux/formats/gltf/value.h"
#include "montelux/scene/index.h"

namespace montelux::gltf {

// Whether Montelux was built with libdraco.
bool reads_draco();

class DracoMesh {
  public:
    // `compressed`: a mesh of the bitstream 2.2. Errors: damaged data, another number of vertices or triangles than
    // expected (the library reserves memory for them), and a Montelux without the library.
    DracoMesh(std::span<const std::uint8_t> compressed, std::size_t vertices, std::size_t triangles,
              const Value& at);
    ~DracoMesh();
    DracoMesh(DracoMesh&&) noexcept;

    // Three per triangle.
    std::vector<Index> indices() const;
    // The values of an attribute as the accessor declares them, one element after the other. Errors: no such attribute,
    // other numbers of components, values that the accessor's type does not hold.
    std::vector<std::uint8_t> attribute(std::uint64_t id, const Accessor& as, const Value& at) const;

  private:
    struct Decoded;
    std::unique_ptr<Decoded> decoded_;
};

} // namespace montelux::gltf
