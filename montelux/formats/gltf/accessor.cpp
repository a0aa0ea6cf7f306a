#include "montelux/formats/gltf/accessor.h"

#include <algorithm>

namespace montelux::gltf {
namespace {

struct ElementType {
    std::string_view name;
    std::size_t columns, rows;
};
constexpr auto element_types = std::to_array<ElementType>({{"SCALAR", 1, 1},
                                                           {"VEC2", 1, 2},
                                                           {"VEC3", 1, 3},
                                                           {"VEC4", 1, 4},
                                                           {"MAT2", 2, 2},
                                                           {"MAT3", 3, 3},
                                                           {"MAT4", 4, 4}});

Accessor::Component component_of(const Value& value) {
    const std::uint64_t code = value.whole();
    for (const std::uint64_t known : {5120, 5121, 5122, 5123, 5125, 5126})
        if (code == known) return static_cast<Accessor::Component>(code);
    value.error("component type " + std::to_string(code) +
                " is unknown; expected 5120, 5121, 5122, 5123, 5125 or 5126");
}

std::uint64_t number_of_elements(const Value& count) {
    const std::uint64_t n = count.whole();
    if (n < 1) count.error("0 is below 1");
    if (n > no_index) count.error("more than 2^32 elements");
    return n;
}

// Bytes from the first to behind the last element must be there.
void check_extent(const Value& at, std::size_t count, std::size_t stride, std::size_t element_bytes,
                  std::size_t offset, std::size_t available) {
    const std::uint64_t needed = offset + (count - 1) * stride + element_bytes; // all below 2^55
    if (needed > available)
        at.error(std::to_string(count) + " elements need " + std::to_string(needed) +
                 " bytes of the buffer view, which has " + std::to_string(available));
}

Accessor::Sparse open_sparse(Document& document, const Value& sparse, const Accessor& a) {
    Accessor::Sparse s;
    s.count = number_of_elements(sparse.required("count"));
    if (s.count > a.count) sparse.error("has more elements than its accessor");
    const Value indices = sparse.required("indices"), values = sparse.required("values");
    s.index_type = component_of(indices.required("componentType"));
    if (s.index_type != Accessor::Component::u8 && s.index_type != Accessor::Component::u16 &&
        s.index_type != Accessor::Component::u32)
        indices.error("indices are not unsigned integers");
    const auto bytes = [&](const Value& part, std::size_t element_bytes) {
        const std::span<const std::uint8_t> view = document.view(part.required("bufferView"));
        const std::size_t offset = part.whole("byteOffset", 0);
        check_extent(part, s.count, element_bytes, element_bytes, offset, view.size());
        return view.subspan(offset);
    };
    s.indices = bytes(indices, bytes_of(s.index_type));
    s.values = bytes(values, a.element_bytes);
    return s;
}

} // namespace

std::size_t bytes_of(Accessor::Component component) {
    std::size_t size = 0;
    visit_component(component, [&]<typename T>(std::type_identity<T>) { size = sizeof(T); });
    return size;
}

Accessor open_accessor(Document& document, const Value& index,
                       std::initializer_list<std::string_view> types) {
    const Value& source = document.refer(index, "accessors", "accessor");
    Accessor a{.bytes = {}, .type = {}, .source = source};
    a.component = component_of(source.required("componentType"));
    a.normalized = source.boolean("normalized", false);
    a.count = number_of_elements(source.required("count"));
    const Value type = source.required("type");
    const auto* known = std::ranges::find(element_types, std::string_view(type.text()), &ElementType::name);
    if (known == element_types.end())
        type.error("unknown type " + in_quotes(type.text()) +
                   "; expected SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3 or MAT4");
    a.type = known->name;
    if (std::ranges::find(types, a.type) == types.end()) {
        std::string expected;
        for (const std::string_view t : types) expected += (expected.empty() ? "" : " or ") + std::string(t);
        index.error("accessor " + std::to_string(index.whole()) + " is of type " + std::string(a.type) +
                    "; expected " + expected);
    }
    const std::size_t size = bytes_of(a.component);
    a.components = known->columns * known->rows;
    // The columns of a matrix begin at multiples of four bytes.
    const std::size_t column = known->columns == 1 ? known->rows * size : (known->rows * size + 3) / 4 * 4;
    for (std::size_t c = 0; c < a.components; ++c)
        a.offsets[c] = c / known->rows * column + c % known->rows * size;
    a.element_bytes = known->columns * column;
    a.stride = a.element_bytes;
    if (const std::optional<Value> view = source.find("bufferView")) {
        const Value& declared = document.refer(*view, "bufferViews", "buffer view");
        if (const std::optional<Value> stride = declared.find("byteStride")) {
            a.stride = stride->whole();
            if (a.stride < a.element_bytes || a.stride > 252)
                stride->error("a stride of " + std::to_string(a.stride) + " bytes; expected " +
                              std::to_string(a.element_bytes) + " to 252");
        }
        const std::span<const std::uint8_t> bytes = document.view(*view);
        const std::size_t offset = source.whole("byteOffset", 0);
        check_extent(source, a.count, a.stride, a.element_bytes, offset, bytes.size());
        a.bytes = bytes.subspan(offset);
    }
    if (const std::optional<Value> sparse = source.find("sparse"))
        a.sparse = open_sparse(document, *sparse, a);
    return a;
}

std::vector<std::size_t> sparse_indices(const Accessor& a) {
    std::vector<std::size_t> result(a.sparse->count);
    visit_component(a.sparse->index_type, [&]<typename T>(std::type_identity<T>) {
        for (std::size_t i = 0; i < result.size(); ++i) {
            T value;
            std::memcpy(&value, a.sparse->indices.data() + i * sizeof value, sizeof value);
            result[i] = static_cast<std::size_t>(value);
            if (result[i] >= a.count)
                a.source.error("sparse index " + std::to_string(result[i]) + " is not below the count of " +
                               std::to_string(a.count));
        }
    });
    return result;
}

std::vector<Vec3f> read_vec3(Document& document, const Accessor& a, std::span<const Index> chosen) {
    return read_elements<3>(
        document, a, [](const std::array<float, 3>& v) { return Vec3f(v[0], v[1], v[2]); }, chosen);
}

std::vector<float> read_scalars(Document& document, const Accessor& a) {
    return read_elements<1>(document, a, [](const std::array<float, 1>& v) { return v[0]; });
}

std::vector<Index> read_indices(Document& document, const Accessor& a) {
    using Component = Accessor::Component;
    if (a.component != Component::u8 && a.component != Component::u16 && a.component != Component::u32)
        a.source.error("indices are not unsigned integers");
    document.charge(static_cast<double>(a.count) * sizeof(Index), a.source);
    std::vector<Index> result(a.count);
    visit_component(a.component, [&]<typename T>(std::type_identity<T>) {
        const auto read = [&](const std::uint8_t* from, Index& to) {
            T value;
            std::memcpy(&value, from, sizeof value);
            to = static_cast<Index>(value);
        };
        if (!a.bytes.empty())
            for (std::size_t i = 0; i < a.count; ++i) read(a.bytes.data() + i * a.stride, result[i]);
        if (!a.sparse) return;
        const std::vector<std::size_t> indices = sparse_indices(a);
        for (std::size_t i = 0; i < indices.size(); ++i)
            read(a.sparse->values.data() + i * a.element_bytes, result[indices[i]]);
    });
    return result;
}

} // namespace montelux::gltf
