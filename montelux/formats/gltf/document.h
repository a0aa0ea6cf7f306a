// Document: the arrays of a glTF file, its buffers and the files that it refers to.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "montelux/formats/file_source.h"
#include "montelux/formats/gltf/value.h"

namespace montelux::gltf {

struct Container;

class Document {
  public:
    // All must outlive it.
    Document(const Container& container, std::filesystem::path path, FileSource& source,
             std::vector<std::filesystem::path>* files_read, Diagnostics& diagnostics);

    const Value& root() const { return root_; }
    Diagnostics& diagnostics() const { return root_.diagnostics(); }
    // "" or the elements of the array "nodes", "meshes" ...
    const std::vector<Value>& all(std::string_view array) const;
    // The element that an index refers to. Errors name the index, and how many there are.
    const Value& refer(const Value& index, std::string_view array, std::string_view what) const;

    // The bytes of a buffer, or of a view of it. Valid as long as the document.
    std::span<const std::uint8_t> buffer(const Value& index);
    std::span<const std::uint8_t> view(const Value& index);
    // The bytes of a relative URI or a data URI.
    std::vector<std::uint8_t> read(const Value& uri);

    // Counts memory that the reader is about to use for what the file describes. An Error when it is out of all
    // proportion to the file's bytes: a short file can refer to the same bytes again and again.
    void charge(double bytes, const Value& at);

  private:
    // What "buffer", "byteOffset" and "byteLength" of an object say.
    std::span<const std::uint8_t> part_of_buffer(const Value& part);

    Value root_;
    const Container& container_;
    std::filesystem::path path_;
    FileSource& source_;
    std::vector<std::filesystem::path>* files_read_;
    mutable std::map<std::string, std::vector<Value>, std::less<>> arrays_;
    std::map<std::uint64_t, std::vector<std::uint8_t>> buffers_;
    std::map<std::uint64_t, std::vector<std::uint8_t>> decoded_; // buffer views that are compressed
    double bytes_read_ = 0, charged_ = 0;
};

} // namespace montelux::gltf
