#include "app/picture_notices.h"

#include "app/progress_line.h"
#include <cstdio>

namespace montelux::app {
namespace {

unsigned long long number(std::uint64_t n) { return n; }

} // namespace

void print_clamped(double samples, double lost, double left) {
    if (!(samples > 0)) return;
    std::fprintf(
        stderr,
        "montelux: warning: %.0f samples were clamped, which took %s of the light away; the errors do not "
        "know of that\n",
        samples, percent_text(lost / (lost + left)).c_str());
}

void print_outliers(const OutlierReport& o) {
    constexpr double few = 0.01;
    if (o.share_of_half > 0 && o.share_of_half < few)
        std::printf("half of the squared error sits in %llu pixels (%s of all)\n", number(o.pixels_of_half),
                    percent_text(o.share_of_half).c_str());
    if (o.heavy_tailed > 0)
        std::printf(
            "%llu pixels owe most of their error to one bright sample and carry %s of the squared error: "
            "their errors are rough (layers outlier and doubt)\n",
            number(o.heavy_tailed), percent_text(o.heavy_error_share).c_str());
    if (static_cast<double>(o.outshone) > few * static_cast<double>(o.pixels))
        std::printf(
            "%llu pixels lie beside pixels of far larger variance: where that is no edge, they have missed "
            "bright paths so far and are too sure (layer doubt)\n",
            number(o.outshone));
    if (o.unknown > 0)
        std::printf(
            "%llu pixels have fewer than 16 units (samples, or replicates of a quasi-random sampler): "
            "too few to tell whether their errors are rough (layers units and doubt)\n",
            number(o.unknown));
}

} // namespace montelux::app
