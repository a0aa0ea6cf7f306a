// Tables of numbers as files: CSV, NumPy's .npy, or the bare numbers.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "montelux/mc/io/file.h"

namespace montelux::app {

enum class TableFormat {
    csv, // a line of column names, then a line a row; every digit of a double
    npy, // NumPy format 1.0: a C-ordered array of little-endian doubles
    bin  // the little-endian doubles, row by row
};
inline constexpr std::string_view table_format_names[] = {"csv", "npy", "bin"};
std::optional<TableFormat> table_format(std::string_view name);

// A table that is written row by row; nothing but the row is kept in memory. A file appears complete, at
// finish(), or not at all. Throws Error when it cannot be written.
class TableWriter {
  public:
    // A path of "" is the standard output.
    TableWriter(const std::string& path, TableFormat format, const std::vector<std::string>& names,
                std::uint64_t rows);

    // As many numbers as there are names.
    void add(std::span<const double> row);
    // After all rows that were announced.
    void finish();

  private:
    void flush();

    TableFormat format_;
    std::optional<AtomicFile> file_;
    std::string buffer_;
};

// Throws the Error that writing to this path would meet for a reason that is known now.
void check_output(const std::string& path);

} // namespace montelux::app
