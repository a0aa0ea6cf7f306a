#include "app/progress.h"

#include <cmath>
#include <cstdio>
#include <string>
#include <unistd.h>

namespace montelux::app {

namespace {

template <typename... Args>
std::string text(const char* format, Args... args) {
    char buffer[128];
    std::snprintf(buffer, sizeof buffer, format, args...);
    return buffer;
}

// Between two plain lines, and between two pictures of the bar, in seconds.
constexpr double line_interval = 10, bar_interval = 0.1;

} // namespace

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

ProgressPrinter::ProgressPrinter(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0) {}

void ProgressPrinter::update(const RenderProgress& p) {
    if (quiet_ || p.samples_total == 0) return;
    double fraction = static_cast<double>(p.samples_done) / static_cast<double>(p.samples_total);
    bool end = p.samples_done == p.samples_total;
    double interval = terminal_ ? bar_interval : line_interval;
    if (!end && p.seconds - last_update_seconds_ < interval) return;
    last_update_seconds_ = p.seconds;
    double rate = p.seconds > 0 ? static_cast<double>(p.samples_done) / p.seconds : 0;
    std::string numbers =
        text("%3.0f %%", std::floor(100 * fraction)) + "  " + duration_text(p.seconds) + " elapsed";
    if (!end && fraction > 0) numbers += ", " + duration_text(p.seconds * (1 / fraction - 1)) + " left";
    numbers += ", " + count_text(rate) + "samples/s";
    if (p.error) numbers += ", error " + percent_text(p.error->relative);
    if (!terminal_) {
        std::fprintf(stderr, "rendering: %s\n", numbers.c_str());
        return;
    }
    constexpr int width = 28;
    int full = static_cast<int>(fraction * width);
    std::string bar = std::string(static_cast<std::size_t>(full), '#') +
                      std::string(static_cast<std::size_t>(width - full), '.');
    std::fprintf(stderr, "\r[%s] %s\033[K", bar.c_str(), numbers.c_str());
    std::fflush(stderr);
    drawn_ = true;
}

void ProgressPrinter::finish() {
    if (drawn_) std::fputc('\n', stderr);
    drawn_ = false;
}

} // namespace montelux::app
