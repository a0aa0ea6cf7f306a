#include "app/render/memory_text.h"

#include <cstdio>
#include <sys/resource.h>

namespace montelux::app {
namespace {

constexpr double mib = 1 << 20;

std::string memory_line(std::string_view kind, std::size_t bytes, const std::string& rest) {
    char text[160];
    std::snprintf(text, sizeof text, "%-20.*s %10.2f MiB%s%s\n", static_cast<int>(kind.size()), kind.data(),
                  static_cast<double>(bytes) / mib, rest.empty() ? "" : "  ", rest.c_str());
    return text;
}

} // namespace

std::string memory_text(std::span<const MemoryUse> table, std::size_t peak) {
    std::string text;
    std::size_t sum = 0;
    for (const MemoryUse& use : table) {
        std::string rest = std::to_string(use.count) + " " + std::string(use.unit);
        const double each = static_cast<double>(use.bytes) / static_cast<double>(use.count);
        if (use.in_file > 0) {
            char number[60];
            std::snprintf(number, sizeof number, ", %.2f MiB in a temporary file",
                          static_cast<double>(use.in_file) / mib);
            rest += number;
        } else if (use.count > 1 && each < 10000) { // of larger ones few are alike
            char number[40];
            std::snprintf(number, sizeof number, each < 100 ? ", %.3g bytes each" : ", %.0f bytes each",
                          each);
            rest += number;
        }
        text += memory_line(use.kind, use.bytes, rest);
        sum += use.bytes;
    }
    text += memory_line("sum", sum, "");
    text += memory_line("peak of the process", peak, "");
    return text;
}

std::size_t peak_memory() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

} // namespace montelux::app
