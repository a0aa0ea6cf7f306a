#include "app/progress_line.h"

#include "app/joined.h"
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <sys/ioctl.h>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace montelux::app {
namespace {

template <typename... Args>
std::string text(const char* format, Args... args) {
    char buffer[128];
    std::snprintf(buffer, sizeof buffer, format, args...);
    return buffer;
}

// Between two lines where there is no terminal, and between two pictures of the line on one, in seconds.
constexpr double line_interval = 10, picture_interval = 0.1;

} // namespace

ProgressLine::ProgressLine(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0) {}

bool ProgressLine::due(double seconds) {
    if (quiet_ || seconds - last_ < (terminal_ ? picture_interval : line_interval)) return false;
    last_ = seconds;
    return true;
}

void ProgressLine::show(const char* what, const std::string& line) {
    if (quiet_) return;
    if (!terminal_) {
        std::fprintf(stderr, "%s: %s\n", what, line.c_str());
        return;
    }
    // The last column stays free: some terminals wrap when it is written.
    const auto columns = static_cast<std::size_t>(terminal_columns() - 1);
    std::fprintf(stderr, "\r%s\033[K", line.substr(0, columns).c_str());
    std::fflush(stderr);
    drawn_ = true;
}

void ProgressLine::finish() {
    if (drawn_) std::fputc('\n', stderr);
    drawn_ = false;
}

int terminal_columns() {
    constexpr int usual = 80, least = 10;
    winsize size{};
    if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0)
        return std::max<int>(size.ws_col, least);
    if (const char* columns = std::getenv("COLUMNS")) {
        const std::string_view digits = columns;
        int n = 0;
        if (std::from_chars(digits.data(), digits.data() + digits.size(), n).ec == std::errc() && n > 0)
            return std::max(n, least);
    }
    return usual;
}

std::string joined_to_fit(std::vector<LinePart> parts, std::size_t columns) {
    const auto line = [&] {
        std::vector<std::string_view> texts;
        texts.reserve(parts.size());
        for (const LinePart& part : parts) texts.push_back(part.text);
        return joined(texts);
    };
    while (parts.size() > 1 && line().size() > columns)
        parts.erase(std::ranges::max_element(parts, {}, &LinePart::rank));
    return line();
}

std::string progress_bar(double share, std::size_t columns) {
    constexpr std::size_t longest = 28, shortest = 8, around = 3;
    if (columns < shortest + around) return "";
    const std::size_t width = std::min(longest, columns - around);
    const auto full = static_cast<std::size_t>(std::clamp(share, 0.0, 1.0) * static_cast<double>(width));
    return "[" + std::string(full, '#') + std::string(width - full, '.') + "] ";
}

std::string duration_text(double seconds) {
    if (!std::isfinite(seconds)) return "?";
    if (seconds < 60) return text("%.1f s", seconds);
    const long long s = std::llround(seconds);
    if (s < 3600) return text("%lld:%02lld", s / 60, s % 60);
    return text("%lld:%02lld:%02lld", s / 3600, s / 60 % 60, s % 60);
}

std::string percent_text(double fraction) {
    return std::isfinite(fraction) ? text("%.3g %%", 100 * fraction) : "?";
}

std::string count_text(double count) {
    if (!std::isfinite(count)) return "?";
    for (auto [scale, unit] : {std::pair(1e9, "G"), std::pair(1e6, "M"), std::pair(1e3, "k")})
        if (count >= scale) return text("%.3g %s", count / scale, unit);
    return text("%.3g ", count);
}

} // namespace montelux::app
