#include "montelux/formats/gltf/draco.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#ifdef MONTELUX_DRACO
#include <draco/compression/decode.h>
#include <draco/mesh/mesh.h>
#endif

namespace montelux::gltf {

#ifdef MONTELUX_DRACO

namespace {

// The best that the format does for real meshes is about one bit per vertex.
constexpr std::size_t most_vertices_per_byte = 64, always_allowed_vertices = 1 << 16;

// What the beginning of the data says of sizes. Draco bitstream specification 2.2, sections "Decode" and "Connectivity".
struct DracoSizes {
    std::uint64_t triangles = 0;
    std::optional<std::uint64_t> vertices{}; // known only for meshes without connectivity coding
};

class DracoHeader {
  public:
    DracoHeader(std::span<const std::uint8_t> bytes, const Value& at) : bytes_(bytes), at_(at) {}

    DracoSizes read() {
        for (const char c : std::string_view("DRACO"))
            if (byte() != static_cast<std::uint8_t>(c)) at_.error("the data are not of Draco");
        const int major = byte(), minor = byte();
        if (major != 2 || minor != 2)
            at_.error("a Draco bitstream of version " + std::to_string(major) + "." + std::to_string(minor) +
                      "; expected 2.2");
        if (byte() != 1) at_.error("Draco data of points, not of triangles");
        const bool edgebreaker = byte() == 1;
        byte();
        if ((byte() & 0x80) != 0) at_.error("Draco data with metadata, which are not read");
        DracoSizes sizes;
        if (edgebreaker) {
            byte();   // the kind of traversal
            number(); // vertices, of which seams make more
            sizes.triangles = number();
        } else {
            sizes.triangles = number();
            sizes.vertices = number();
        }
        return sizes;
    }

  private:
    std::uint8_t byte() {
        if (next_ >= bytes_.size()) at_.error("the Draco data end too early");
        return bytes_[next_++];
    }
    // LEB128
    std::uint64_t number() {
        std::uint64_t value = 0;
        for (int shift = 0; shift < 63; shift += 7) {
            const std::uint8_t b = byte();
            value |= std::uint64_t{b & 0x7fu} << shift;
            if ((b & 0x80) == 0) return value;
        }
        at_.error("the Draco data are damaged");
    }

    std::span<const std::uint8_t> bytes_;
    const Value& at_;
    std::size_t next_ = 0;
};

} // namespace

bool reads_draco() { return true; }

struct DracoMesh::Decoded {
    std::unique_ptr<draco::Mesh> mesh;
};

DracoMesh::DracoMesh(std::span<const std::uint8_t> compressed, std::size_t vertices, std::size_t triangles,
                     const Value& at)
    : decoded_(std::make_unique<Decoded>()) {
    const DracoSizes sizes = DracoHeader(compressed, at).read();
    const auto expect = [&](std::uint64_t found, std::size_t expected, const char* what) {
        if (found != expected)
            at.error("the Draco data have " + std::to_string(found) + " " + what + "; the accessors " +
                     std::to_string(expected));
    };
    expect(sizes.triangles, triangles, "triangles");
    if (sizes.vertices) expect(*sizes.vertices, vertices, "vertices");
    if (std::max(vertices, triangles) > always_allowed_vertices + most_vertices_per_byte * compressed.size())
        at.error("the Draco data are too short for so many vertices or triangles");
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(compressed.data()), compressed.size());
    draco::Decoder decoder;
    auto result = decoder.DecodeMeshFromBuffer(&buffer);
    if (!result.ok()) at.error("the Draco data are damaged");
    decoded_->mesh = std::move(result).value();
    expect(decoded_->mesh->num_faces(), triangles, "triangles");
    expect(decoded_->mesh->num_points(), vertices, "vertices");
}

std::vector<Index> DracoMesh::indices() const {
    const draco::Mesh& mesh = *decoded_->mesh;
    std::vector<Index> indices;
    indices.reserve(3 * std::size_t{mesh.num_faces()});
    for (draco::FaceIndex f(0); f < mesh.num_faces(); ++f)
        for (const draco::PointIndex& p : mesh.face(f)) indices.push_back(p.value());
    return indices;
}

std::vector<std::uint8_t> DracoMesh::attribute(std::uint64_t id, const Accessor& as, const Value& at) const {
    const draco::Mesh& mesh = *decoded_->mesh;
    const draco::PointAttribute* const found =
        id <= std::numeric_limits<std::uint32_t>::max()
            ? mesh.GetAttributeByUniqueId(static_cast<std::uint32_t>(id))
            : nullptr;
    if (found == nullptr) at.error("the Draco data have no attribute " + std::to_string(id));
    if (static_cast<std::size_t>(found->num_components()) != as.components)
        at.error("the attribute of the Draco data has " + std::to_string(found->num_components()) +
                 " components; its accessor has " + std::to_string(as.components));
    std::vector<std::uint8_t> bytes(as.count * as.element_bytes);
    visit_component(as.component, [&]<typename T>(std::type_identity<T>) {
        std::array<T, 16> values;
        for (std::size_t i = 0; i < as.count; ++i) {
            const draco::AttributeValueIndex value =
                found->mapped_index(draco::PointIndex(static_cast<std::uint32_t>(i)));
            if (value.value() >= found->size() ||
                !found->ConvertValue<T>(value, static_cast<std::int8_t>(as.components), values.data()))
                at.error("the attribute of the Draco data is damaged, or not what its accessor says");
            std::memcpy(bytes.data() + i * as.element_bytes, values.data(), as.components * sizeof(T));
        }
    });
    return bytes;
}

#else

bool reads_draco() { return false; }

struct DracoMesh::Decoded {};

DracoMesh::DracoMesh(std::span<const std::uint8_t>, std::size_t, std::size_t, const Value& at) {
    at.error("is not read: Montelux was built without libdraco");
}
std::vector<Index> DracoMesh::indices() const { return {}; }
std::vector<std::uint8_t> DracoMesh::attribute(std::uint64_t, const Accessor&, const Value&) const {
    return {};
}

#endif

DracoMesh::~DracoMesh() = default;
DracoMesh::DracoMesh(DracoMesh&&) noexcept = default;

} // namespace montelux::gltf
