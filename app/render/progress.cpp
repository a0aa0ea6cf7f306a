#include "app/render/progress.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

namespace montelux::app {

void ProgressPrinter::update(const RenderProgress& p) {
    if (p.samples_total == 0) return;
    double fraction = static_cast<double>(p.samples_done) / static_cast<double>(p.samples_total);
    bool end = p.samples_done == p.samples_total;
    const bool open = target_ > 0 && !(p.error && p.error->relative <= target_);
    if (open && static_cast<double>(p.samples_done) < most_samples_) {
        constexpr double almost = 0.99;
        fraction = std::min(fraction, almost);
        end = false;
    }
    if (!line_.due(p.seconds) && !end) return;
    const double rate = p.seconds > 0 ? static_cast<double>(p.samples_done) / p.seconds : 0;
    char percent[16];
    std::snprintf(percent, sizeof percent, "%3.0f %%", std::floor(100 * fraction));
    std::string numbers = std::string(percent) + "  " + duration_text(p.seconds) + " elapsed";
    if (!end && fraction > 0 && p.samples_done < p.samples_total)
        numbers += ", " + duration_text(p.seconds * (1 / fraction - 1)) + " left";
    numbers += ", " + count_text(rate) + "samples/s";
    if (p.error) numbers += ", error " + percent_text(p.error->relative);
    if (line_.on_terminal()) {
        constexpr int width = 28;
        const auto full = static_cast<std::size_t>(fraction * width);
        numbers = "[" + std::string(full, '#') + std::string(width - full, '.') + "] " + numbers;
    }
    line_.show(doing_.c_str(), numbers);
}

} // namespace montelux::app
