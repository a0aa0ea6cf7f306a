#include "app/table_file.h"

#include <bit>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <cstring>

#include "montelux/mc/math/error.h"

namespace montelux::app {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are written as they are in memory");

// RFC 4180: quotes around what holds a comma or a quote.
std::string csv_field(const std::string& text) {
    if (text.find_first_of(",\"\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + "\"";
}

std::string npy_header(std::uint64_t rows, std::size_t columns) {
    std::string text = "{'descr': '<f8', 'fortran_order': False, 'shape': (" + std::to_string(rows) + ", " +
                       std::to_string(columns) + "), }";
    constexpr std::size_t before = 10, alignment = 64; // magic, version and length come before the text
    text.append(alignment - 1 - (before + text.size()) % alignment, ' ');
    text += '\n';
    const auto length = static_cast<std::uint16_t>(text.size());
    std::string header = "\x93NUMPY";
    for (unsigned byte : {1u, 0u, length & 0xffu, static_cast<unsigned>(length) >> 8})
        header += static_cast<char>(static_cast<unsigned char>(byte));
    return header + text;
}

} // namespace

std::optional<TableFormat> table_format(std::string_view name) {
    for (std::size_t i = 0; i < std::size(table_format_names); ++i)
        if (table_format_names[i] == name) return static_cast<TableFormat>(i);
    return std::nullopt;
}

TableWriter::TableWriter(const std::string& path, TableFormat format, const std::vector<std::string>& names,
                         std::uint64_t rows)
    : format_(format) {
    if (!path.empty()) file_.emplace(path);
    if (format == TableFormat::npy) buffer_ = npy_header(rows, names.size());
    if (format != TableFormat::csv) return;
    for (std::size_t d = 0; d < names.size(); ++d) buffer_ += (d ? "," : "") + csv_field(names[d]);
    buffer_ += '\n';
}

void TableWriter::add(std::span<const double> row) {
    if (format_ == TableFormat::csv) {
        for (std::size_t d = 0; d < row.size(); ++d) {
            char number[32];
            const auto end = std::to_chars(number, number + sizeof number, row[d]).ptr;
            buffer_.append(number, end);
            buffer_ += d + 1 < row.size() ? ',' : '\n';
        }
    } else {
        std::vector<char> bytes(row.size_bytes());
        std::memcpy(bytes.data(), row.data(), bytes.size());
        buffer_.append(bytes.begin(), bytes.end());
    }
    if (buffer_.size() >= 1 << 16) flush();
}

void TableWriter::finish() {
    flush();
    if (file_) file_->commit();
}

void TableWriter::flush() {
    if (file_)
        file_->write(buffer_.data(), buffer_.size());
    else if (std::fwrite(buffer_.data(), 1, buffer_.size(), stdout) != buffer_.size())
        throw Error("standard output", "cannot be written");
    buffer_.clear();
}

void check_output(const std::string& path) {
    // Creates and removes the temporary file: permission bits alone do not suffice.
    AtomicFile probe(path);
}

} // namespace montelux::app
