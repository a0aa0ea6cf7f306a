#include "montelux/formats/gltf/document.h"

#include "montelux/formats/gltf/container.h"
#include "montelux/formats/gltf/meshopt.h"
#include "montelux/formats/gltf/uri.h"
#include "montelux/mc/math/error.h"

namespace montelux::gltf {
namespace {

constexpr std::size_t most_file_bytes = std::size_t{16} << 30;

// Memory per byte of the file, and for any file.
constexpr double most_growth = 64, always_allowed = 64 << 20;

} // namespace

Document::Document(const Container& container, std::filesystem::path path, FileSource& source,
                   std::vector<std::filesystem::path>* files_read, Diagnostics& diagnostics)
    : root_(*container.json, "", diagnostics), container_(container), path_(std::move(path)), source_(source),
      files_read_(files_read), bytes_read_(static_cast<double>(container.bytes.size())) {}

const std::vector<Value>& Document::all(std::string_view array) const {
    const auto known = arrays_.find(array);
    if (known != arrays_.end()) return known->second;
    return arrays_.emplace(array, root_.elements(array)).first->second;
}

const Value& Document::refer(const Value& index, std::string_view array, std::string_view what) const {
    const std::vector<Value>& elements = all(array);
    const std::uint64_t i = index.whole();
    if (i >= elements.size())
        index.error(std::string(what) + " " + std::to_string(i) + " does not exist (there are " +
                    std::to_string(elements.size()) + ")");
    return elements[i];
}

std::span<const std::uint8_t> Document::buffer(const Value& index) {
    const Value& buffer = refer(index, "buffers", "buffer");
    const std::uint64_t i = index.whole(), length = buffer.required("byteLength").whole();
    std::span<const std::uint8_t> bytes;
    if (const std::optional<Value> uri = buffer.find("uri")) {
        auto known = buffers_.find(i);
        if (known == buffers_.end()) known = buffers_.emplace(i, read(*uri)).first;
        bytes = known->second;
    } else {
        if (i != 0 || !container_.chunk) buffer.error("has no 'uri', and there is no binary chunk for it");
        bytes = *container_.chunk;
    }
    if (bytes.size() < length)
        buffer.error("has " + std::to_string(bytes.size()) + " bytes; its byteLength is " +
                     std::to_string(length));
    return bytes.first(length);
}

std::span<const std::uint8_t> Document::view(const Value& index) {
    const Value& view = refer(index, "bufferViews", "buffer view");
    if (view.extension("KHR_meshopt_compression"))
        view.error("is compressed by KHR_meshopt_compression, which is not read");
    if (const std::optional<Value> compressed = view.extension("EXT_meshopt_compression")) {
        const std::uint64_t i = index.whole();
        auto known = decoded_.find(i);
        if (known == decoded_.end()) {
            const MeshoptView meshopt = meshopt_view(*compressed, view.required("byteLength").whole());
            charge(static_cast<double>(meshopt.bytes()), view);
            known =
                decoded_.emplace(i, decode_meshopt(meshopt, part_of_buffer(*compressed), *compressed)).first;
        }
        return known->second;
    }
    return part_of_buffer(view);
}

std::span<const std::uint8_t> Document::part_of_buffer(const Value& part) {
    const std::span<const std::uint8_t> bytes = buffer(part.required("buffer"));
    const std::uint64_t offset = part.whole("byteOffset", 0), length = part.required("byteLength").whole();
    if (offset > bytes.size() || length > bytes.size() - offset)
        part.error("bytes " + std::to_string(offset) + " to " + std::to_string(offset + length) +
                   " are not within its buffer of " + std::to_string(bytes.size()) + " bytes");
    return bytes.subspan(offset, length);
}

std::vector<std::uint8_t> Document::read(const Value& uri) {
    try {
        const std::string& text = uri.text();
        if (is_data_uri(text)) return decode_data_uri(text);
        const std::filesystem::path file = path_.parent_path() / file_of_uri(text);
        if (!source_.exists(file)) throw Error("there is no file '" + file.string() + "'");
        if (files_read_ != nullptr) files_read_->push_back(file);
        std::vector<std::uint8_t> bytes = source_.read(file, most_file_bytes);
        bytes_read_ += static_cast<double>(bytes.size());
        return bytes;
    } catch (const LocatedError&) {
        throw;
    } catch (const Error& e) {
        uri.error(e.what());
    }
}

void Document::charge(double bytes, const Value& at) {
    charged_ += bytes;
    if (charged_ > always_allowed + most_growth * bytes_read_)
        at.error("with it, the file describes more than " + shown_number(most_growth) +
                 " times the bytes that it has: it refers to the same data again and again");
}

} // namespace montelux::gltf
