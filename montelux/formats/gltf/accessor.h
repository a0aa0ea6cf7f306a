// Accessor: the typed elements of a buffer view, read where they lie.
#pragma once

#include <algorithm>
#include <array>
#include <cstring>
#include <initializer_list>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "montelux/formats/gltf/document.h"
#include "montelux/scene/index.h"

namespace montelux::gltf {

// glTF 2.0 specification, section 3.6.2.
struct Accessor {
    enum class Component : int { i8 = 5120, u8 = 5121, i16 = 5122, u16 = 5123, u32 = 5125, f32 = 5126 };
    struct Sparse {
        std::span<const std::uint8_t> indices, values;
        std::size_t count = 0;
        Component index_type = Component::u8;
    };

    std::span<const std::uint8_t> bytes; // empty: every element is zero
    std::size_t count = 0;               // elements
    std::size_t stride = 0;              // bytes between elements
    Component component = Component::f32;
    bool normalized = false;
    std::string_view type;                 // "VEC3"
    std::array<std::size_t, 16> offsets{}; // of the components, in bytes from the element
    std::size_t components = 1, element_bytes = 0;
    std::optional<Sparse> sparse{};
    Value source; // for messages
};

// The accessor that an index refers to. Checks that all its elements lie in the buffer view. Errors: another type than
// those expected.
Accessor open_accessor(Document& document, const Value& index, std::initializer_list<std::string_view> types);

std::size_t bytes_of(Accessor::Component component);

// The least value for which all integers of the type are at least -1 and at most 1.
template <typename T>
float normalized_value(T value) {
    constexpr auto most = static_cast<float>(std::numeric_limits<T>::max());
    return std::max(static_cast<float>(value) / most, -1.0f);
}

// Calls f(std::type_identity<T>) with the type of a component.
template <typename F>
void visit_component(Accessor::Component component, const F& f) {
    switch (component) {
    case Accessor::Component::i8:
        return f(std::type_identity<std::int8_t>{});
    case Accessor::Component::u8:
        return f(std::type_identity<std::uint8_t>{});
    case Accessor::Component::i16:
        return f(std::type_identity<std::int16_t>{});
    case Accessor::Component::u16:
        return f(std::type_identity<std::uint16_t>{});
    case Accessor::Component::u32:
        return f(std::type_identity<std::uint32_t>{});
    case Accessor::Component::f32:
        return f(std::type_identity<float>{});
    }
}

// Indices of the sparse elements; each is below `count`, or an Error.
std::vector<std::size_t> sparse_indices(const Accessor& a);

// Calls f(i, values) for each element with its first N components as floats, then again for those that are sparse.
// `chosen`, if not empty: for these elements only, in growing order; i counts them. Values that are not finite are an
// Error.
template <std::size_t N, typename F>
void for_each_element(const Accessor& a, std::span<const Index> chosen, const F& f) {
    // `element`: the number of the k-th one in `bytes`; `place`: what f calls it.
    const auto walk = [&](std::span<const std::uint8_t> bytes, std::size_t count, std::size_t stride,
                          const auto& element, const auto& place) {
        visit_component(a.component, [&]<typename T>(std::type_identity<T>) {
            for (std::size_t k = 0; k < count; ++k) {
                const std::uint8_t* from = bytes.data() + element(k) * stride;
                std::array<float, N> values;
                for (std::size_t c = 0; c < N; ++c) {
                    T value;
                    std::memcpy(&value, from + a.offsets[c], sizeof value);
                    if constexpr (std::is_same_v<T, float>) {
                        values[c] = value;
                        if (!(value - value == 0))
                            a.source.error("element " + std::to_string(element(k)) +
                                           " is not a finite number");
                    } else {
                        values[c] = a.normalized ? normalized_value(value) : static_cast<float>(value);
                    }
                }
                f(place(k), values);
            }
        });
    };
    const auto same = [](std::size_t k) { return k; };
    const std::size_t count = chosen.empty() ? a.count : chosen.size();
    if (a.bytes.empty())
        for (std::size_t k = 0; k < count; ++k) f(k, std::array<float, N>{});
    else if (chosen.empty())
        walk(a.bytes, count, a.stride, same, same);
    else
        walk(
            a.bytes, count, a.stride, [&](std::size_t k) { return std::size_t{chosen[k]}; }, same);
    if (!a.sparse) return;
    std::vector<std::size_t> elements = sparse_indices(a), places = elements;
    if (!chosen.empty()) {
        elements.clear();
        places.clear();
        const std::vector<std::size_t> all = sparse_indices(a);
        for (std::size_t k = 0; k < all.size(); ++k) {
            const auto found = std::lower_bound(chosen.begin(), chosen.end(), all[k]);
            if (found == chosen.end() || *found != all[k]) continue;
            elements.push_back(k);
            places.push_back(static_cast<std::size_t>(found - chosen.begin()));
        }
    } else {
        for (std::size_t k = 0; k < elements.size(); ++k) elements[k] = k;
    }
    walk(
        a.sparse->values, elements.size(), a.element_bytes, [&](std::size_t k) { return elements[k]; },
        [&](std::size_t k) { return places[k]; });
}

// All elements, or those that are chosen, as `make(values)` makes them of N floats. Charges the document for them.
template <std::size_t N, typename Make>
auto read_elements(Document& document, const Accessor& a, const Make& make,
                   std::span<const Index> chosen = {}) {
    using Element = std::decay_t<decltype(make(std::array<float, N>{}))>;
    const std::size_t count = chosen.empty() ? a.count : chosen.size();
    document.charge(static_cast<double>(count) * sizeof(Element), a.source);
    std::vector<Element> result;
    result.reserve(count + 1); // as the scene keeps positions, so that it need not copy them
    result.resize(count);
    for_each_element<N>(a, chosen,
                        [&](std::size_t i, const std::array<float, N>& v) { result[i] = make(v); });
    return result;
}
std::vector<Vec3f> read_vec3(Document& document, const Accessor& a, std::span<const Index> chosen = {});
std::vector<float> read_scalars(Document& document, const Accessor& a);
// Scalars of unsigned integers.
std::vector<Index> read_indices(Document& document, const Accessor& a);

} // namespace montelux::gltf
