#include "app/render/advice.h"

#include "app/progress_line.h"
#include <cmath>
#include <cstdio>

namespace montelux::app {
namespace {

std::string whole(double number) {
    char text[32];
    std::snprintf(text, sizeof text, "%.0f", std::ceil(number));
    return text;
}
std::string seconds_option(double seconds) { return "--time " + whole(seconds) + "s"; }

std::string share_option(double share) {
    char text[32];
    std::snprintf(text, sizeof text, "--target-error %.3g%%", 100 * share);
    return text;
}

// An error falls with the root of samples and time: `factor` times of both.
std::string more_text(const PictureOutcome& o, double factor) {
    const double seconds = factor * o.report.seconds, samples = factor * o.error.mean_samples;
    const std::string resume = o.has_checkpoint ? "--resume " : "";
    const double wait = o.has_checkpoint ? seconds - o.report.seconds : seconds;
    switch (o.report.stop) {
    case RenderStop::time:
        return resume + seconds_option(seconds);
    case RenderStop::error:
        return resume + share_option(o.target.error / std::sqrt(factor)) + ", about " + duration_text(wait);
    default:
        return resume + (o.target.error > 0 ? "--max-spp " : "--spp ") + whole(samples) + ", about " +
               duration_text(wait);
    }
}

} // namespace

std::string advice_text(const PictureOutcome& o) {
    if (o.report.cancelled())
        return o.has_checkpoint ? "the same command with --resume continues the render" : "";
    if (o.target.slice.count > 1) return "";         // part of a picture
    if (!std::isfinite(o.error.relative)) return ""; // black, or too few samples
    const bool is_missed = o.target.error > 0 && o.report.stop != RenderStop::error;
    if (!is_missed && !(o.visible && *o.visible > clean_share)) return "";
    const bool to_target = is_missed && o.target.quantile == 0;
    const double factor = to_target ? std::pow(o.error.relative / o.target.error, 2) : 4;
    constexpr double most_factor = 1e9; // beyond it, the error says little
    std::string text;
    if (factor > 1 && factor < most_factor)
        text = (to_target ? "to reach the target: " : "for half the error: ") + more_text(o, factor);
    const auto add = [&](const std::string& more) { text += (text.empty() ? "" : "; ") + more; };
    constexpr double most_of_it = 0.5;
    if (o.outliers.heavy_error_share > most_of_it)
        add("against fireflies, which carry " + percent_text(o.outliers.heavy_error_share) +
            " of the squared error: --clamp VALUE");
    if (o.can_denoise) add("for a smooth picture: --denoise");
    return text;
}

} // namespace montelux::app
