// Fixtures of the glTF tests: models from texts and arrays, what they load as, and the error of a broken one.
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "montelux/formats/gltf/load_gltf.h"
#include "montelux/mc/math/error.h"

namespace montelux::test {

// Files in memory: a scene that has none but these.
class MemoryFiles final : public FileSource {
  public:
    std::map<std::string, std::vector<std::uint8_t>> files;

    bool exists(const std::filesystem::path& path) override { return files.contains(path.string()); }
    std::vector<std::uint8_t> read(const std::filesystem::path& path, std::size_t) override {
        return files.at(path.string());
    }
};

inline std::string base64(const std::vector<std::uint8_t>& bytes) {
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (i + k < bytes.size() ? bytes[i + k] : 0u);
        for (std::size_t k = 0; k < 4; ++k)
            text += k <= bytes.size() - i ? digits[group >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

template <typename T>
int component_type() {
    if (std::is_same_v<T, std::int8_t>) return 5120;
    if (std::is_same_v<T, std::uint8_t>) return 5121;
    if (std::is_same_v<T, std::int16_t>) return 5122;
    if (std::is_same_v<T, std::uint16_t>) return 5123;
    if (std::is_same_v<T, std::uint32_t>) return 5125;
    return 5126;
}

inline std::size_t components_of(std::string_view type) {
    if (type == "SCALAR") return 1;
    if (type == "MAT4") return 16;
    return static_cast<std::size_t>(type.back() - '0');
}

// The buffer, views and accessors of a model under construction.
struct Model {
    std::vector<std::uint8_t> bytes;
    std::string views, accessors;
    int count = 0;

    // The number of the new accessor, which is that of its view, too. `extra`: ', "normalized": true'.
    template <typename T>
    int add(const std::vector<T>& values, std::string_view type, const std::string& extra = "") {
        bytes.resize((bytes.size() + 3) / 4 * 4);
        const std::size_t offset = bytes.size(), size = values.size() * sizeof(T);
        bytes.resize(offset + size);
        std::memcpy(bytes.data() + offset, values.data(), size);
        const std::string comma = count == 0 ? "" : ", ";
        views += comma + R"({"buffer": 0, "byteOffset": )" + std::to_string(offset) + R"(, "byteLength": )" +
                 std::to_string(size) + "}";
        accessors += comma + R"({"bufferView": )" + std::to_string(count) + R"(, "componentType": )" +
                     std::to_string(component_type<T>()) + R"(, "count": )" +
                     std::to_string(values.size() / components_of(type)) + R"(, "type": ")" +
                     std::string(type) + "\"" + extra + "}";
        return count++;
    }
    // The triangle (0 0 0), (1 0 0), (0 1 0).
    int add_triangle() { return add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3"); }

    // `members`: of the root, after these.
    std::string text(const std::string& members) const {
        return R"({"asset": {"version": "2.0"}, "buffers": [{"byteLength": )" + std::to_string(bytes.size()) +
               R"(, "uri": "data:application/octet-stream;base64,)" + base64(bytes) +
               R"("}], "bufferViews": [)" + views + R"(], "accessors": [)" + accessors + "], " + members +
               "}";
    }
};

// A mesh of one primitive at one node; `primitive`: its members.
inline std::string one_mesh(const std::string& primitive) {
    return R"("meshes": [{"primitives": [{)" + primitive + R"(}]}], "nodes": [{"mesh": 0}])";
}

inline SceneDescription load_model(std::string_view text, Warnings* warnings = nullptr,
                                   const LoadOptions& options = {}, FileSource* files = nullptr) {
    MemoryFiles none;
    Warnings ignored;
    return load_gltf({text.begin(), text.end()}, "folder/model.gltf", warnings ? *warnings : ignored,
                     files ? *files : none, options);
}

// The message without the name of the file; empty if there is none.
inline std::string model_error(std::string_view text, const LoadOptions& options = {},
                               FileSource* files = nullptr) {
    try {
        load_model(text, nullptr, options, files);
    } catch (const Error& e) {
        const std::string what = e.what(), name = "folder/model.gltf: ";
        return what.starts_with(name) ? what.substr(name.size()) : what;
    }
    return {};
}

} // namespace montelux::test
