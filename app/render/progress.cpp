#include "app/render/progress.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace montelux::app {

void ProgressPrinter::update(const RenderProgress& p) {
    const bool due = line_.due(p.seconds);
    if (!due && !p.ended) return;
    // Rounding, and an estimate that was exceeded, must not look like the end.
    constexpr double almost = 0.99;
    const double share = p.ended ? p.forecast.share : std::min(p.forecast.share, almost);
    char percent[16];
    std::snprintf(percent, sizeof percent, "%3.0f %%  ", std::floor(100 * share));
    enum Rank { left, error, elapsed, rate };
    std::vector<LinePart> parts{{duration_text(p.seconds) + " elapsed", elapsed}};
    if (!p.ended && p.forecast.seconds_left)
        parts.push_back({duration_text(*p.forecast.seconds_left) + " left", left});
    if (p.quantile && std::isfinite(p.quantile->error))
        parts.push_back(
            {percent_text(p.quantile->share) + " within " + percent_text(p.quantile->error), error});
    else if (p.error && std::isfinite(p.error->relative))
        parts.push_back({"error " + percent_text(p.error->relative), error});
    if (p.seconds > 0)
        parts.push_back({count_text(static_cast<double>(p.samples_done) / p.seconds) + "samples/s", rate});
    if (!line_.on_terminal())
        return line_.show(doing_.c_str(), percent + joined_to_fit(std::move(parts), std::string::npos));
    const std::size_t room = static_cast<std::size_t>(terminal_columns() - 1) - std::string(percent).size();
    const std::string numbers = joined_to_fit(std::move(parts), room);
    line_.show(doing_.c_str(),
               progress_bar(share, room - std::min(room, numbers.size())) + percent + numbers);
}

} // namespace montelux::app
