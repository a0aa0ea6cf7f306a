#include "app/picture_notices.h"

#include "app/progress_line.h"
#include <cstdio>

namespace montelux::app {
namespace {

unsigned long long number(std::uint64_t n) { return n; }

} // namespace

std::string visible_text(const std::optional<double>& share) {
    if (!share) return "";
    return ", visible in " + (*share > 0 ? percent_text(*share) : "none") + " of the pixels";
}

void print_clamped(double samples, double lost, double left) {
    if (!(samples > 0)) return;
    std::fprintf(
        stderr,
        "montelux: warning: %.0f samples were clamped, which removed %s of the light; the errors do not "
        "include this bias\n",
        samples, percent_text(lost / (lost + left)).c_str());
}

void print_outliers(const OutlierReport& o) {
    constexpr double few = 0.01;
    const auto share = [&](std::uint64_t n) {
        return percent_text(static_cast<double>(n) / static_cast<double>(o.pixels));
    };
    if (o.share_of_half > 0 && o.share_of_half < few)
        std::printf("%llu pixels (%s) carry half of the squared error\n", number(o.pixels_of_half),
                    percent_text(o.share_of_half).c_str());
    if (o.heavy_tailed > 0)
        std::printf(
            "%llu pixels (%s) are fireflies: one sample dominates, so their error bars are unreliable "
            "(layer outlier)\n",
            number(o.heavy_tailed), share(o.heavy_tailed).c_str());
    if (static_cast<double>(o.outshone) > few * static_cast<double>(o.pixels))
        std::printf(
            "%llu pixels (%s) have neighbours of far larger variance: off an edge, their error bars are "
            "too small (layer warning)\n",
            number(o.outshone), share(o.outshone).c_str());
}

} // namespace montelux::app
