// Denoised pictures of the commands render and denoise: made and told about.
#pragma once

#include <optional>
#include <string>

#include "montelux/denoise/denoise_image.h"

namespace montelux::app {

struct DenoiseOutcome {
    std::string note;    // what is told of each picture that is written, beginning with ", "; may be empty
    std::string failure; // why there is no denoised picture though there should be one
};

// Adds the denoised layers to a rendered picture. Nothing is done without a denoiser, nor when the render was
// stopped, for then the picture must be on the disk soon. A failure is told rather than thrown: hours of
// rendering are not to be lost by it.
DenoiseOutcome denoise_render(const std::optional<Denoiser>& denoiser, Image& image, bool stopped,
                              bool quiet);

// "denoised by ... (...)"; warns of pixels that were replaced unless `quiet`.
std::string describe(const Denoiser& denoiser, const DenoiseReport& report, bool quiet);

} // namespace montelux::app
