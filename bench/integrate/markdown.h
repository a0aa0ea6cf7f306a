// Tables in Markdown with columns of even width.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <ostream>
#include <string>
#include <vector>

namespace montelux::bench {

class MarkdownTable {
  public:
    explicit MarkdownTable(std::vector<std::string> header) { add(std::move(header)); }

    void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }

    friend std::ostream& operator<<(std::ostream& out, const MarkdownTable& table) {
        std::vector<std::size_t> width(table.rows_.front().size(), 3);
        for (const auto& row : table.rows_)
            for (std::size_t j = 0; j < row.size() && j < width.size(); ++j)
                width[j] = std::max(width[j], row[j].size());
        auto print = [&](const std::vector<std::string>& row) {
            out << "|";
            for (std::size_t j = 0; j < width.size(); ++j) {
                const std::string text = j < row.size() ? row[j] : "";
                out << " " << text << std::string(width[j] - text.size(), ' ') << " |";
            }
            out << "\n";
        };
        print(table.rows_.front());
        out << "|";
        for (std::size_t w : width) out << std::string(w + 2, '-') << "|";
        out << "\n";
        for (std::size_t i = 1; i < table.rows_.size(); ++i) print(table.rows_[i]);
        return out;
    }

  private:
    std::vector<std::vector<std::string>> rows_;
};

inline std::string formatted(const char* format, double value) {
    char text[40];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

// 84, 8.2k, 27k, 1.3M
inline std::string short_count(double n) {
    if (n < 1000) return formatted("%.0f", n);
    if (n < 9950) return formatted("%.1fk", n / 1e3);
    if (n < 999500) return formatted("%.0fk", n / 1e3);
    return formatted(n < 9.95e6 ? "%.1fM" : "%.0fM", n / 1e6);
}

// 1.2e-4
inline std::string short_error(double x) {
    std::string text = formatted("%.1e", x);
    const std::size_t e = text.find('e');
    if (e != std::string::npos && e + 2 < text.size() && text[e + 2] == '0') text.erase(e + 2, 1);
    return text;
}

} // namespace montelux::bench
