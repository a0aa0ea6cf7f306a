#include "app/denoised_output.h"

#include <cstdio>

namespace montelux::app {

std::string describe(const Denoiser& denoiser, const DenoiseReport& report, bool quiet) {
    if (!quiet && report.not_finite > 0)
        std::fprintf(
            stderr,
            "montelux: warning: %llu pixels have a colour, albedo or normal that is not a number or "
            "infinite; for the denoiser such a colour is the mean of its neighbours, the others are 0\n",
            static_cast<unsigned long long>(report.not_finite));
    if (!quiet && report.negative > 0)
        std::fprintf(stderr,
                     "montelux: warning: %llu pixels have a colour below 0; for the denoiser it is 0\n",
                     static_cast<unsigned long long>(report.negative));
    return "denoised by " + denoiser.name() +
           (report.guides.empty() ? " without albedo and normal" : " with " + report.guides) +
           " (the error bars are those of the picture before denoising)";
}

} // namespace montelux::app
