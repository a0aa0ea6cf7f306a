#include "montelux/formats/gltf/meshopt.h"

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#ifdef MONTELUX_MESHOPT
#include <meshoptimizer.h>
#endif

#include "montelux/mc/math/nearest_name.h"

namespace montelux::gltf {
namespace {

constexpr auto modes = std::to_array<std::string_view>({"ATTRIBUTES", "TRIANGLES", "INDICES"});
constexpr auto filters = std::to_array<std::string_view>({"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"});

// The place of a name in a list.
template <typename Names>
std::size_t place_in(const Names& names, const Value& at, const std::string& name) {
    for (std::size_t i = 0; i < names.size(); ++i)
        if (names[i] == name) return i;
    at.error("unknown name " + in_quotes(name) + did_you_mean(name, names));
}

} // namespace

MeshoptView meshopt_view(const Value& e, std::uint64_t view_bytes) {
    MeshoptView v;
    v.count = e.required("count").whole();
    v.stride = e.required("byteStride").whole();
    v.mode = static_cast<MeshoptView::Mode>(place_in(modes, e, e.required("mode").text()));
    v.filter = static_cast<MeshoptView::Filter>(place_in(filters, e, e.text("filter", "NONE")));
    const bool attributes = v.mode == MeshoptView::Mode::attributes;
    if (attributes ? v.stride == 0 || v.stride % 4 != 0 || v.stride > 256 : v.stride != 2 && v.stride != 4)
        e.required("byteStride")
            .error("a stride of " + std::to_string(v.stride) + " bytes; expected " +
                   (attributes ? "a multiple of 4 up to 256" : "2 or 4"));
    if (v.mode == MeshoptView::Mode::triangles && v.count % 3 != 0)
        e.required("count").error(std::to_string(v.count) + " is no multiple of 3");
    using Filter = MeshoptView::Filter;
    if (v.filter != Filter::none &&
        (!attributes || (v.filter == Filter::octahedral && v.stride != 4 && v.stride != 8) ||
         (v.filter == Filter::quaternion && v.stride != 8)))
        e.required("filter").error("the filter " + e.text("filter", "") + " is not for such elements");
    if (v.count == 0 || v.count > view_bytes || v.bytes() != view_bytes)
        e.required("count").error(std::to_string(v.count) + " elements of " + std::to_string(v.stride) +
                                  " bytes; the buffer view has " + std::to_string(view_bytes) + " bytes");
    return v;
}

#ifdef MONTELUX_MESHOPT

bool reads_meshopt() { return true; }

// The library checks all that it reads, but for what indices refer to.
std::vector<std::uint8_t> decode_meshopt(const MeshoptView& v, std::span<const std::uint8_t> compressed,
                                         const Value& at) {
    std::vector<std::uint8_t> bytes(v.bytes());
    int failure = 0;
    switch (v.mode) {
    case MeshoptView::Mode::attributes:
        failure =
            meshopt_decodeVertexBuffer(bytes.data(), v.count, v.stride, compressed.data(), compressed.size());
        break;
    case MeshoptView::Mode::triangles:
        failure =
            meshopt_decodeIndexBuffer(bytes.data(), v.count, v.stride, compressed.data(), compressed.size());
        break;
    case MeshoptView::Mode::indices:
        failure = meshopt_decodeIndexSequence(bytes.data(), v.count, v.stride, compressed.data(),
                                              compressed.size());
        break;
    }
    if (failure != 0) at.error("the compressed data are damaged");
    switch (v.filter) {
    case MeshoptView::Filter::none:
        break;
    case MeshoptView::Filter::octahedral:
        meshopt_decodeFilterOct(bytes.data(), v.count, v.stride);
        break;
    case MeshoptView::Filter::quaternion:
        meshopt_decodeFilterQuat(bytes.data(), v.count, v.stride);
        break;
    case MeshoptView::Filter::exponential:
        meshopt_decodeFilterExp(bytes.data(), v.count, v.stride);
        break;
    }
    return bytes;
}

#else

bool reads_meshopt() { return false; }

std::vector<std::uint8_t> decode_meshopt(const MeshoptView&, std::span<const std::uint8_t>, const Value& at) {
    at.error("is not read: Montelux was built without libmeshoptimizer");
}

#endif

} // namespace montelux::gltf
